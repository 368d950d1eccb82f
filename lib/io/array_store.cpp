#include "io/array_store.hpp"

namespace cmap {

ArrayStore::ArrayStore(const std::filesystem::path& folder_or_npz) : folder_(folder_or_npz) {
  if (!std::filesystem::is_directory(folder_)) zip_.emplace(folder_);
}

ArrayStore::ArrayStore(std::string name, std::span<const std::byte> npz) { zip_.emplace(std::move(name), npz); }

bool ArrayStore::has(std::string_view name) const {
  const std::string file = fmt::format("{}.npy", name);
  return zip_ ? zip_->find(file) != nullptr : std::filesystem::exists(folder_ / file);
}

NpyArray ArrayStore::read(std::string_view name) const {
  const std::string file = fmt::format("{}.npy", name);
  if (!zip_) {
    ByteSource source(folder_ / file);
    return read_npy(source);
  }
  const ZipMember* member = zip_->find(file);
  if (member == nullptr) throw InputError(fmt::format("{}: the member {} is missing", zip_->name(), file));
  const Array<std::byte> content = zip_->read(*member);
  ByteSource source(fmt::format("{}: {}", zip_->name(), file), content);
  return read_npy(source);
}

std::vector<std::string> ArrayStore::python_members() const {
  constexpr std::size_t kHeaderBytes = 128;  // NumPy's own are no longer
  std::vector<std::string> names;
  if (!zip_) return names;
  for (const ZipMember& member : zip_->members()) {
    if (holds_python_objects(zip_->read_start(member, kHeaderBytes))) names.push_back(member.name);
  }
  return names;
}

void require_shape(const NpyArray& array, const std::vector<std::uint64_t>& shape) {
  bool same = array.shape().size() == shape.size();
  for (std::size_t i = 0; same && i < shape.size(); ++i) same = shape[i] == 0 || shape[i] == array.shape()[i];
  if (!same) array.fail("has the shape {}; {} expected", shape_text(array.shape()), shape_text(shape));
}

}  // namespace cmap
