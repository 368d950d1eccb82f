#!/usr/bin/env bash
# ccache 4.7.5 (Debian's 4.8+really4.7.5-1): in depend mode an object that embeds a file by `.incbin` stays old after the file has changed:
# the compiler's list of dependencies, which that mode trusts, does not name what the assembler reads. Otherwise the new file is seen.
# Pages, shaders and weights inside of programs are made so.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq ccache=4.8+really4.7.5-1 libhiredis0.14=0.14.1-3 > /dev/null 2>&1
for package in ./*.deb; do dpkg-deb --extract "$package" root; done
ccache=$PWD/root/usr/bin/ccache
export LD_LIBRARY_PATH=$PWD/root/usr/lib/x86_64-linux-gnu CCACHE_DIR=$PWD/cache
cat > page.c <<'C'
#include <stdio.h>
#define EMBED(path) __asm__(".section .rodata\npage:\n.incbin \"" path "\"\n.byte 0\n.text\n")
EMBED("page.txt");
extern const char page[];
int main(void) { return puts(page) < 0; }
C

seen_after_change() { # ARGUMENT...: environment of ccache
  rm -rf cache
  for word in old new; do
    printf %s "$word" > page.txt
    env "$@" "$ccache" gcc -MD -MF page.d -c page.c -o page.o
  done
  gcc -no-pie page.o -o page && ./page
}
"$ccache" --version | head -1
plain=$(seen_after_change CCACHE_NODEPEND=1)
depend=$(seen_after_change CCACHE_DEPEND=1)
echo "embedded after the file has changed from old to new: $plain, in depend mode $depend"
[[ $plain == new && $depend == old ]]
