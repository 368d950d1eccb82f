#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <list>
#include <string_view>

namespace cmap {

/// A file that appears under its name only when it is complete, by commit(); before, and if the program is killed, it
/// has no name, or a temporary one where the file system insists on one. "-" is standard output. A closed pipe is no
/// error; every other failure (no folder, no permission, full disk) throws OutputError naming path and reason.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Where a library that writes files only by name may write, in place of write().
  const std::filesystem::path& path_for_writer() const { return temporary_.empty() ? path_ : temporary_; }
  /// Flushes to the system and closes, still not under its name: what can go wrong has, before several files that
  /// belong together appear. Nothing can be written afterwards.
  void finish();
  /// Finishes, unless done, and gives it its name. Not called: nothing is left behind.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
};

/// Files that belong together: all of them appear, or none; signals wait for the last.
class OutputFiles {
 public:
  /// Writes one more to its end, still not under its name. An empty path is a file that was not asked for.
  void add(const std::filesystem::path& path, const std::function<void(OutputFile&)>& write);
  void commit();

 private:
  std::list<OutputFile> files_;
};

/// Throws the OutputError that writing to `path` would end with, where that is known beforehand: a directory that is
/// missing, a protected file. For programs that work long before they write. An empty path is no output.
void require_writable(const std::filesystem::path& path);

}  // namespace cmap
