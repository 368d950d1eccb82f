#pragma once

#include <string>

#include "cmap/core/simd.hpp"

// A feature that needs heavy libraries is a shared library of its own, loaded when it is asked for, so that programs
// start without. It exports one symbol, cmap_module, which gives the module's table: a struct of function pointers,
// declared where both sides see it, with its name `kModule` and a number `kTable` that grows with every change of it.

namespace cmap {

struct ExecutionState;

/// What the program hands to the module, which has a copy of this library: whom to ask how it runs, and the SIMD level.
struct ModuleHost {
  ExecutionState*& (*execution)();
  SimdLevel simd;
};

/// Has this shape in every version, as it tells them apart.
struct ModuleAnswer {
  const char* build;  ///< what the module is of: "cmap 0.2.0, figure table 1"
  const void* table;  ///< null unless that is what was asked for
};

/// What a table is of, in this build.
std::string module_build(const char* module, int table);

void take_over(const ModuleHost& host);

/// The body of a module's cmap_module.
template <class Table>
ModuleAnswer answer_of_module(const Table& table, const char* build, const ModuleHost* host) {
  static const std::string own = module_build(Table::kModule, Table::kTable);
  if (own != build) return {own.c_str(), nullptr};
  take_over(*host);
  return {own.c_str(), &table};
}

const void* load_table(const std::string& file, const std::string& build, const std::string& missing);

/// The table of a module, for good: VTK's libraries do not survive that they are unloaded. A file without a folder is
/// found by the program's run path. Throws UnsupportedError that begins with `missing` where this build has no such
/// file, and one that names the file, what it is and what is needed where it belongs to another build, or is no module.
template <class Table>
const Table& load_module(const std::string& file, const std::string& missing) {
  return *static_cast<const Table*>(load_table(file, module_build(Table::kModule, Table::kTable), missing));
}

}  // namespace cmap

extern "C" cmap::ModuleAnswer cmap_module(const char* build, const cmap::ModuleHost* host);
