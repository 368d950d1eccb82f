#pragma once

#include <string_view>

// CMAP_EMBED(name, "path") makes cmap::name(), the bytes of a file of the source tree, in the program itself. The
// assembler reads it in no time; the compiler would need seconds for a literal. At global scope of one source.
#define CMAP_EMBED(name, path)                                                                          \
  asm(".section .rodata\ncmap_embedded_" #name "_begin:\n.incbin \"" path "\"\ncmap_embedded_" #name    \
      "_end:\n.text\n");                                                                                \
  extern "C" {                                                                                          \
  extern const char cmap_embedded_##name##_begin[];                                                     \
  extern const char cmap_embedded_##name##_end[];                                                       \
  }                                                                                                     \
  namespace cmap {                                                                                      \
  static std::string_view name() { return {cmap_embedded_##name##_begin, cmap_embedded_##name##_end}; } \
  }
