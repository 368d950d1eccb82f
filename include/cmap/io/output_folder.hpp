#pragma once

#include <filesystem>
#include <string>

namespace cmap {

/// Makes a folder, and those above it, unless it is there. Throws OutputError naming it and the reason.
void make_folder(const std::filesystem::path& folder);

/// Keeps other programs of ours out of a folder that is there, for as long as it lives; the system lets go of it when
/// a program is killed. Throws OutputError where another one has it. Where the file system knows no locks it holds
/// nothing, and says so.
class FolderLock {
 public:
  FolderLock() = default;
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;

  bool is_held() const { return descriptor_ >= 0; }
  /// Whether the folder that is locked still has this name.
  bool is_of(const std::filesystem::path& folder) const;

 private:
  int descriptor_ = -1;
};

/// A folder that appears under its name only when it is complete: filled as `<name>.partial` beside it, renamed by
/// commit(), removed otherwise, by signals too. The name must be free. Whoever is killed outright leaves a rest to the
/// next run, which replaces it; one that another program is filling, and one that holds anything but such a rest, is
/// refused. Every failure throws OutputError naming the path and the reason.
class OutputFolder {
 public:
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until commit().
  const std::filesystem::path& partial() const { return partial_; }
  /// Makes a folder inside, unless it is there.
  std::filesystem::path subfolder(const std::filesystem::path& name) const;
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_;  ///< empty once renamed
  FolderLock lock_;
};

}  // namespace cmap
