// Files that people give where rows of poses are meant.

#include <algorithm>
#include <array>

#include "cmap/io/line_reader.hpp"
#include "poses/trajectory_rows.hpp"

namespace cmap {
namespace {

using namespace std::string_view_literals;

struct KnownStart {
  std::string_view bytes, what;
};

constexpr std::array kOtherFormats{
    KnownStart{"\x93NUMPY"sv, "a NumPy array; numpy.savetxt writes its poses as rows of 8 or 12 numbers"},
    KnownStart{"PK\x03\x04"sv, "an archive; rows of poses as text expected"},
    KnownStart{"{"sv, "JSON; rows of poses as text expected (TUM: time x y z qx qy qz qw)"},
    KnownStart{"["sv, "a list in brackets; rows of poses without brackets expected (numpy.savetxt)"},
    KnownStart{"<"sv, "XML; rows of poses as text expected"},
    KnownStart{"ply\n"sv, "a PLY point cloud, no trajectory"},
    KnownStart{"ply\r"sv, "a PLY point cloud, no trajectory"},
    KnownStart{"# .PCD"sv, "a PCD point cloud, no trajectory"},
    KnownStart{"VERSION"sv, "a PCD point cloud, no trajectory"},
    KnownStart{"LASF"sv, "a LAS point cloud, no trajectory"},
    KnownStart{"#ROSBAG"sv, "a ROS bag; its poses as rows of text expected (TUM: time x y z qx qy qz qw)"},
    KnownStart{"\x89MCAP"sv, "an MCAP recording; its poses as rows of text expected (TUM: time x y z qx qy qz qw)"},
    KnownStart{"SQLite format 3"sv, "a database (rosbag2?); its poses as rows of text expected (TUM)"},
    KnownStart{"VERTEX_SE3"sv, "a g2o pose graph, whose vertices have no times; rows of poses expected (TUM)"},
    KnownStart{"%YAML"sv, "YAML; rows of poses as text expected (TUM: time x y z qx qy qz qw)"}};

}  // namespace

void refuse_other_than_poses(ByteSource& source) {
  constexpr std::uint64_t kLookAt = 512;
  const auto bytes = source.peek(std::min(kLookAt, source.size()));
  std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), kLookAt));
  start = without_byte_order_mark(start);
  start.remove_prefix(std::min(start.size(), start.find_first_not_of(" \t\r\n")));
  for (const auto& [known, what] : kOtherFormats) {
    if (start.starts_with(known)) source.fail("is {}", what);
  }
  if (!starts_as_utf16(start) && start.find('\0') != std::string_view::npos)
    source.fail("is no text; rows of poses expected");
}

}  // namespace cmap
