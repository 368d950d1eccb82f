#!/usr/bin/env bash
# g++ 12.2.0 (Debian's 12.2.0-14): an aggregate's base is destroyed twice where the initializer of a member behind it throws.
# `Derived d{{.n = 1}, fails()}` makes the base in place, destroys it when fails() throws, and then once more: a string or vector in it is
# freed twice. With the base named, `Base{.n = 1}`, with the member made beforehand, or without a base, it is destroyed once.
# Structs of results that derive from a smaller struct are made like that; a test that stops the work by an exception finds it.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# Debian's packages of that very version, unpacked beside the system's; the C library's headers are the system's (libc6-dev).
apt-get download -qq g++-12=12.2.0-14+deb12u1 gcc-12=12.2.0-14+deb12u1 cpp-12=12.2.0-14+deb12u1 libgcc-12-dev=12.2.0-14+deb12u1 \
  libstdc++-12-dev=12.2.0-14+deb12u1 > /dev/null 2>&1
for package in ./*.deb; do dpkg-deb --extract "$package" root; done
cat > aggregate.cpp <<'CPP'
#include <cstdio>
#include <stdexcept>

int made = 0, destroyed = 0;
struct Counted {
  Counted() { ++made; }
  Counted(const Counted&) { ++made; }
  ~Counted() { ++destroyed; }
};
struct Base {
  int n = 0;
  Counted counted = {};
};
struct Member {
  int m;
};
struct Derived : Base {
  Member member;
};
struct Flat {
  Counted counted = {};
  Member member;
};
Member fails() { throw std::runtime_error("stopped"); }

template <class Make>
int excess(const char* what, Make make) {
  made = destroyed = 0;
  try {
    make();
  } catch (const std::runtime_error&) {
  }
  std::printf("%s: made %d, destroyed %d\n", what, made, destroyed);
  return destroyed - made;
}

int main() {
  const int braces = excess("base in braces", [] { Derived d{{.n = 1}, fails()}; (void)d; });
  const int named = excess("base named", [] { Derived d{Base{.n = 1}, fails()}; (void)d; });
  const int flat = excess("no base", [] { Flat f{.counted = {}, .member = fails()}; (void)f; });
  return braces == 1 && named == 0 && flat == 0 ? 0 : 1;
}
CPP
compiler=root/usr/bin/x86_64-linux-gnu-g++-12
"$compiler" --version | head -1
for level in -O0 -O2; do
  "$compiler" -std=c++20 $level aggregate.cpp -o aggregate
  ./aggregate
done
