#pragma once

#include <filesystem>

namespace cmap {

/// Makes a folder, and those above it, unless it is there. Throws UsageError naming it and the reason.
void make_folder(const std::filesystem::path& folder);

/// A folder that appears under its name only when it is complete: filled as `<name>.partial` beside it, renamed by
/// commit(), removed otherwise. Neither may exist before: the one could be somebody's data, the other somebody else's
/// work. Whoever is killed leaves `<name>.partial`. Every failure throws UsageError naming the path and the reason.
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
};

}  // namespace cmap
