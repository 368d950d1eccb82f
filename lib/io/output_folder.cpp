#include "cmap/io/output_folder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "cmap/core/error.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, std::string_view reason) {
  throw UsageError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

}  // namespace

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw UsageError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

OutputFolder::OutputFolder(fs::path path) {
  path_ = path.has_filename() ? std::move(path) : path.parent_path();  // "name/" is "name"
  fs::path partial = path_;
  partial += ".partial";
  if (fs::exists(fs::symlink_status(path_))) fail(path_, "it is already there");
  std::error_code error;
  const bool made = fs::create_directory(partial, error);
  if (error) fail(path_, error.message());
  if (!made) fail(path_, fmt::format("{} is there: left by a run that was stopped, or still in use", partial.string()));
  partial_ = std::move(partial);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove_all(partial_, ignored);
}

fs::path OutputFolder::subfolder(const fs::path& name) const {
  fs::path folder = partial_ / name;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail(folder, error.message());
  return folder;
}

void OutputFolder::commit() {
  std::error_code error;
  fs::rename(partial_, path_, error);
  if (error) fail(path_, error.message());
  partial_.clear();
}

}  // namespace cmap
