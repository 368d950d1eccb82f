#include "report/html_page.hpp"

// CMAP_HTML_PAGE is the file's path. The assembler reads it in no time; the compiler would need seconds for a literal.
asm(".section .rodata\n"
    "cmap_html_page_begin:\n"
    ".incbin \"" CMAP_HTML_PAGE
    "\"\n"
    "cmap_html_page_end:\n"
    ".text\n");

extern "C" {
extern const char cmap_html_page_begin[];
extern const char cmap_html_page_end[];
}

namespace cmap {

std::string_view html_page() { return {cmap_html_page_begin, cmap_html_page_end}; }

}  // namespace cmap
