#include "clouds/array_store.hpp"

#include "cmap/io/file_place.hpp"

namespace cmap {
namespace {

constexpr std::string_view kSuffix = ".npy";

}  // namespace

ArrayStore::ArrayStore(const std::filesystem::path& folder_or_npz) : folder_(folder_or_npz) {
  if (!is_folder(folder_)) zip_.emplace(folder_);
}

ArrayStore::ArrayStore(std::string name, std::span<const std::byte> npz) { zip_.emplace(std::move(name), npz); }

bool ArrayStore::has(std::string_view name) const {
  const std::string file = fmt::format("{}{}", name, kSuffix);
  return zip_ ? zip_->find(file) != nullptr : is_there(folder_ / file);
}

std::string ArrayStore::name_of(std::string_view name) const {
  const std::string file = fmt::format("{}{}", name, kSuffix);
  return zip_ ? fmt::format("{}: {}", zip_->name(), file) : (folder_ / file).string();
}

NpyArray ArrayStore::read(std::string_view name) const {
  const std::string file = fmt::format("{}{}", name, kSuffix);
  if (!zip_) {
    ByteSource source(folder_ / file);
    return read_npy(source);
  }
  const ZipMember* member = zip_->find(file);
  if (member == nullptr) throw InputError(fmt::format("{}: the member {} is missing", zip_->name(), file));
  const Array<std::byte> content = zip_->read(*member);
  ByteSource source(name_of(name), content);
  NpyArray array = read_npy(source);
  array.label = name;
  return array;
}

std::vector<NpzEntry> ArrayStore::entries() const {
  constexpr std::size_t kMostHeaderBytes = ByteSource::kMaxRecordBytes + 12;
  std::vector<NpzEntry> entries;
  if (!zip_) return entries;
  for (const ZipMember& member : zip_->members()) {
    NpzEntry& entry = entries.emplace_back(NpzEntry{member.name, std::nullopt});
    if (!entry.name.ends_with(kSuffix)) continue;
    entry.name.resize(entry.name.size() - kSuffix.size());
    try {
      const std::string start = zip_->read_start(member, kMostHeaderBytes);
      ByteSource source(member.name, std::as_bytes(std::span(start)));
      entry.header = read_npy_header(source);
    } catch (const InputError&) {
      // whoever reads the array says what is wrong with it
    }
  }
  return entries;
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

void drop_ones(NpyArray& array, std::size_t dimensions) {
  std::vector<std::uint64_t>& shape = array.header.shape;
  if (shape.size() > dimensions && shape.back() == 1) shape.pop_back();
  if (shape.size() != dimensions + 1) return;
  if (shape.front() != 1) {
    array.fail("has the shape {}: a batch of {}; save one of them", shape_text(shape), shape.front());
  }
  shape.erase(shape.begin());
}

}  // namespace cmap
