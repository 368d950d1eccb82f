#include <algorithm>
#include <deque>

#include "clouds/cloud_format.hpp"
#include "clouds/numpy/npz_choice.hpp"
#include "clouds/numpy/npz_colors.hpp"
#include "clouds/point_names.hpp"
#include "clouds/point_schema.hpp"
#include "containers/npy_shape.hpp"

namespace cmap {
namespace {

/// The arrays of a file as they are used.
class NpzCloud {
 public:
  NpzCloud(ByteSource& source, const ArrayStore& store, FileInfo& info)
      : source_(source), store_(store), info_(info), entries_(store.entries()) {}

  PointCloud read() {
    read_points();
    read_colors();
    const Array<std::uint8_t> keep = read_mask();
    note_confidence();
    note_unused_arrays();
    CloudBuilder builder(source_, points_.layout, points_.n);
    append(keep, builder);
    return builder.finish(info_);
  }

 private:
  const NpyArray& read_array(const std::string& name) {
    used_.push_back(name);
    return arrays_.emplace_back(store_.read(name));
  }

  void read_points() {
    const PointArrays chosen = choose_point_arrays(source_, entries_);
    name_ = fmt::format("{}", fmt::join(chosen.names, ", "));
    const std::string plain = plain_name(name_);
    info_.format = plain == "pointcloud"              ? "NPZ VGGT-SLAM point map"
                   : plain.starts_with("worldpoints") ? "NPZ VGGT predictions"
                                                      : "NPZ";
    if (chosen.names.size() > 1) return read_coordinates(chosen.names);
    const NpyArray& array = read_array(name_);
    points_ = points_of(array, info_);
    if (chosen.by_shape && entries_.size() > 1) {
      info_.notes.push_back(fmt::format("the array {} taken as the points, by its shape", name_));
    }
    const auto& shape = array.shape();
    if (!array.header.is_record() && shape.size() >= kBatchDimensions) {
      info_.notes.push_back(fmt::format("{}: the batch dimension of 1 in {} dropped", name_, shape_text(shape)));
    }
  }

  /// Columns of their own, colors among them.
  void read_coordinates(const std::vector<std::string>& axes) {
    const std::uint64_t n = items_of(axes[0]);
    for (const std::string& axis : axes) {
      if (items_of(axis) != n) source_.fail("{} holds {} numbers, but {} {}", axes[0], n, axis, items_of(axis));
    }
    std::vector<NamedColumn> columns;
    for (const NpzEntry& entry : entries_) {
      if (!entry.header || entry.header->is_record() || entry.header->items != n) continue;
      if (entry.header->fields[0].kind != NpyKind::kNumber && entry.header->fields[0].kind != NpyKind::kHalf) continue;
      const NpyArray& array = read_array(entry.name);
      const NpyField& field = array.header.fields[0];
      columns.push_back({entry.name, field, {array.bytes.data(), field.value_bytes, field.scalar}});
    }
    points_ = points_of_columns(source_.name(), columns, n, info_);
  }

  std::uint64_t items_of(const std::string& name) const {
    const auto is_it = [&](const NpzEntry& entry) { return entry.name == name; };
    return std::find_if(entries_.begin(), entries_.end(), is_it)->header->items;
  }

  void read_colors() {
    if (points_.has_color()) return;
    const auto chosen = choose_colors(source_, entries_, name_, points_, info_);
    if (!chosen) return;
    std::vector<const NpyArray*> arrays;
    for (const std::string& name : chosen->names) arrays.push_back(&read_array(name));
    if (arrays.size() == 3) return set_colors(points_, arrays);
    if (chosen->packed) return set_packed_colors(points_, *arrays[0]);
    set_colors(points_, *arrays[0], *match_colors(arrays[0]->shape(), points_.shape));
  }

  /// 0: left out; empty: there is no mask.
  Array<std::uint8_t> read_mask() {
    const auto name = choose_mask(source_, entries_, name_, points_);
    if (!name) return {};
    const Array<float> values = store_.read(*name).to_floats();
    const float highest = *std::max_element(values.begin(), values.end());
    const auto is_truth = [&](float value) { return value == 0.0F || value == highest; };
    if (!std::all_of(values.begin(), values.end(), is_truth)) {
      info_.notes.push_back(fmt::format("{} not applied: its values are more than yes and no", *name));
      return {};
    }
    used_.push_back(*name);
    Array<std::uint8_t> keep(values.size());
    std::transform(values.begin(), values.end(), keep.begin(), [](float value) { return value != 0.0F ? 1 : 0; });
    return keep;
  }

  void append(const Array<std::uint8_t>& keep, CloudBuilder& builder) const {
    if (keep.empty()) return append_points(points_, 0, points_.n, builder);
    for (std::uint64_t first = 0, last = 0; first < points_.n; first = last) {
      while (last < points_.n && keep[last] == keep[first]) ++last;
      if (keep[first] != 0) {
        append_points(points_, first, last, builder);
      } else {
        builder.leave_out("masked", last - first);
      }
    }
  }

  void note_confidence() {
    const bool session = plain_name(name_).starts_with("worldpoints");
    const bool any = std::any_of(entries_.begin(), entries_.end(), [](const NpzEntry& entry) {
      return plain_name(entry.name).find("conf") != std::string::npos;
    });
    if (!session && !any) return;
    info_.notes.push_back(fmt::format("all of {} taken, whatever their confidence{}", name_,
                                      session ? ", in the unit of the session" : ""));
  }

  void note_unused_arrays() {
    std::vector<std::string> unused;
    for (const NpzEntry& entry : entries_) {
      if (std::find(used_.begin(), used_.end(), entry.name) == used_.end()) unused.push_back(entry.name);
    }
    note_unused(unused, "arrays", info_);
  }

  ByteSource& source_;
  const ArrayStore& store_;
  FileInfo& info_;
  std::vector<NpzEntry> entries_;
  std::deque<NpyArray> arrays_;  ///< those that points_ lies in
  std::vector<std::string> used_;
  std::string name_;  ///< of the array of points
  NpyPoints points_;
};

PointCloud read_npz_cloud(ByteSource& source, FileInfo& info) {
  Array<std::byte> bytes(source.size());
  source.read(bytes, "the file");
  const ArrayStore store(source.name(), bytes);
  return NpzCloud(source, store, info).read();
}

}  // namespace

namespace formats {

extern constinit const CloudFormat npz{
    .name = "NPZ",
    .listed = "NPZ",
    .by_content = [](const FileStart& start) { return start.bytes.starts_with("PK\x03\x04"); },
    .read = without_options<read_npz_cloud>};

}  // namespace formats

}  // namespace cmap
