#include <limits>

#include "io/npy_testing.hpp"

namespace cmap::testing {
namespace npy_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PointCloudFile read(std::string_view descr, std::string_view shape, std::string_view data,
                    std::string_view fortran = "False") {
  return read_content("a.npy", npy_text(descr, shape, data, fortran));
}
std::string refused(std::string_view descr, std::string_view shape, std::string_view data) {
  return refusal("a.npy", npy_text(descr, shape, data));
}

/// Rows of x y z and these numbers.
template <class T>
std::string rows_with(const std::vector<std::vector<double>>& more) {
  std::vector<T> values;
  for (std::size_t i = 0; i < more.size(); ++i) {
    for (const double value : sample_point(i)) values.push_back(static_cast<T>(value));
    for (const double value : more[i]) values.push_back(static_cast<T>(value));
  }
  return raw(values);
}

TEST(NpyCloud, PointsOfEveryTypeAndShape) {
  const auto file = read("'<f4'", "(12, 3)", point_bytes<float>(12));
  EXPECT_EQ(file.info.format, "NPY <f4");
  EXPECT_EQ(all_notes(file), "");
  expect_samples(file, 12, false);
  expect_samples(read("'<f8'", "(3, 4, 3)", point_bytes<double>(12)), 12, false);
  expect_samples(read("'<f4'", "(1, 2, 2, 3, 3)", point_bytes<float>(12)), 12, false);
  // UTM coordinates keep their millimeters; what is not finite is dropped.
  const auto utm = read("'<f8'", "(2, 3)", raw<double>({636000.001, 849000.002, 3, kNaN, 5, 6}));
  ASSERT_EQ(utm.cloud.size(), 1U);
  EXPECT_LT((point(utm, 0) - Eigen::Vector3d(636000.001, 849000.002, 3)).norm(), 1e-5);
  EXPECT_EQ(utm.info.points, 2U);
  EXPECT_THAT(refused("'<f4'", "(0, 3)", ""), HasSubstr("holds no points"));
}

TEST(NpyCloud, BigEndianHalfAndFortranOrder) {
  // 1, 2 and -0.5 in the bytes of each type
  const Eigen::Vector3d expected(1, 2, -0.5);
  EXPECT_EQ(point(read("'>f4'", "(1, 3)", {"\x3f\x80\0\0\x40\0\0\0\xbf\0\0\0", 12}), 0), expected);
  EXPECT_EQ(point(read("'<f2'", "(1, 3)", {"\0\x3c\0\x40\0\xb8", 6}), 0), expected);
  EXPECT_EQ(point(read("'>f2'", "(1, 3)", {"\x3c\0\x40\0\xb8\0", 6}), 0), expected);
  // all x, then all y, then all z
  const auto fortran = read("'<f8'", "(2, 3)", raw<double>({1, 4, 2, 5, 3, 6}), "True");
  EXPECT_EQ(point(fortran, 0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(point(fortran, 1), Eigen::Vector3d(4, 5, 6));
}

TEST(NpyCloud, IntegersAreReadAndSaid) {
  const auto file = read("'<i4'", "(2, 3)", raw<std::int32_t>({1, -2, 3, 70000, 5, 6}));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(70000, 5, 6));
  EXPECT_THAT(all_notes(file), AllOf(HasSubstr("integers (<i4)"), HasSubstr("scale")));
  EXPECT_THAT(refused("'|u1'", "(2, 3)", "123456"), HasSubstr("values of type |u1: colors or pictures"));
  EXPECT_THAT(refused("'|b1'", "(2, 3)", "123456"), HasSubstr("truth values"));
  EXPECT_THAT(refused("'<c8'", "(1, 3)", std::string(24, 'x')), HasSubstr("values of type '<c8'"));
  EXPECT_THAT(refused("'<f16'", "(1, 3)", std::string(48, 'x')), HasSubstr("values of type '<f16'"));
  EXPECT_THAT(refused("'|O'", "(1, 3)", "x"), HasSubstr("pickled Python objects"));
}

TEST(NpyCloud, TransposedArraysAreReadAndSaid) {
  std::vector<float> planes;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 12; ++i) planes.push_back(static_cast<float>(sample_point(i)[axis]));
  }
  const auto file = read("'<f4'", "(3, 12)", raw(planes));
  expect_samples(file, 12, false);
  EXPECT_THAT(all_notes(file), HasSubstr("3 rows of 12 numbers taken as 12 points (transposed)"));
  planes.insert(planes.end(), 12, 1.0F);  // homogeneous
  expect_samples(read("'<f4'", "(4, 12)", raw(planes)), 12, false);
  // As few as rows have numbers: two readings.
  EXPECT_THAT(refused("'<f4'", "(3, 5)", std::string(60, '\0')),
              HasSubstr("3 points of 5 numbers or 5 points transposed"));
}

TEST(NpyCloud, MatricesAndPosesAreNamed) {
  const std::vector<double> quarter_turn{0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1};
  const std::string T = raw(quarter_turn), pose = T.substr(0, 96);
  EXPECT_THAT(refused("'<f8'", "(4, 4)", T), HasSubstr("a 4x4 transform"));
  EXPECT_THAT(refused("'<f8'", "(3, 4)", pose), HasSubstr("a 3x4 pose"));
  EXPECT_THAT(refused("'<f8'", "(2, 4, 4)", T + T), HasSubstr("4x4 transforms"));
  EXPECT_THAT(refused("'<f8'", "(1, 2, 3, 4)", pose + pose), HasSubstr("3x4 pose or projection matrices"));
  EXPECT_THAT(refused("'<f8'", "(3, 3)", raw<double>({0, -1, 0, 1, 0, 0, 0, 0, 1})), HasSubstr("3x3 rotation"));
  EXPECT_THAT(refused("'<f8'", "(3, 3)", raw<double>({500, 0, 320, 0, 500, 240, 0, 0, 1})), HasSubstr("camera matrix"));
  EXPECT_THAT(refused("'<f8'", "(1, 12)", pose), HasSubstr("rows of 12 numbers, as trajectories"));
  EXPECT_THAT(refused("'<f8'", "(1, 16)", T), HasSubstr("rows of 16 numbers, as trajectories"));
  // Three points, and four of x y z and one more, are points.
  EXPECT_EQ(read("'<f4'", "(3, 3)", point_bytes<float>(3)).cloud.size(), 3U);
  EXPECT_EQ(read("'<f8'", "(4, 4)", raw<double>({1, 2, 3, 7, 4, 5, 6, 8, 7, 8, 9, 9, 0, 0, 0, 1})).cloud.size(), 4U);
  EXPECT_EQ(read("'<f4'", "(4, 4)", rows_with<float>({{7}, {8}, {9}, {1}})).cloud.size(), 4U);
  // Triangles: three corners each.
  expect_samples(read("'<f4'", "(4, 3, 3)", point_bytes<float>(12)), 12, false);
}

TEST(NpyCloud, NumbersOfRowsAreNoX) {
  std::vector<double> rows;
  for (int i = 0; i < 10; ++i) {
    const double t = i;
    rows.insert(rows.end(), {t, 0.5 + t, 0.25 * t * t, 1.125 - t, 20 * t, 255 - t, t * t});
  }
  const auto file = read("'<f8'", "(10, 7)", raw(rows));
  EXPECT_EQ(point(file, 3), Eigen::Vector3d(3.5, 2.25, -1.875));
  EXPECT_EQ(std::get<Array<Rgb8>>(file.cloud.colors)[3], (Rgb8{60, 252, 9}));
  EXPECT_THAT(all_notes(file), HasSubstr("column 0 numbers the rows"));
}

TEST(NpyCloud, TrajectoriesAreNamed) {
  const double s = std::sqrt(0.5);
  EXPECT_THAT(refused("'<f8'", "(2, 7)", rows_with<double>({{0, 0, 0, 1}, {0, s, 0, -s}})), HasSubstr("a trajectory"));
  const std::vector<double> tum{10, 1, 2, 3, 0, 0, 0, 1, 11, 2, 2, 3, 0, 0, s, s};
  EXPECT_THAT(refused("'<f8'", "(2, 8)", raw(tum)), HasSubstr("a trajectory"));
  const std::vector<double> straight{10, 1, 2, 3, 0, 0, 0, 1, 11, 2, 2, 3, 0, 0, 0, 1};
  EXPECT_THAT(refused("'<f8'", "(2, 8)", raw(straight)), HasSubstr("a trajectory"));
  // Normals and their curvature are none.
  expect_samples(read("'<f8'", "(2, 7)", rows_with<double>({{0, s, -s, 0.001}, {0.6, -0.8, 0, 0.002}})), 2, false);
}

TEST(NpyCloud, OtherShapesAreRefused) {
  const std::string data(480, '\0');
  EXPECT_THAT(refused("'<f4'", "(120,)", data), HasSubstr("one row of numbers; (N, 3)"));
  EXPECT_THAT(refused("'<f4'", "()", "1234"), HasSubstr("has the shape ()"));
  EXPECT_THAT(refused("'<f4'", "(60, 2)", data), HasSubstr("without a z"));
  EXPECT_THAT(refused("'<f4'", "(12, 10)", data), HasSubstr("has the shape (12, 10), no points"));
  EXPECT_THAT(refused("'<f4'", "(2, 3, 4, 5)", data), HasSubstr("in planes of their own"));
  EXPECT_THAT(refused("'<f4'", "(2, 2, 2, 5, 3)", data), HasSubstr("a batch of 2 scenes"));
  const std::string good = npy_text("'<f4'", "(40, 3)", data);
  EXPECT_THAT(refusal("a.npy", good.substr(0, good.size() - 1)), HasSubstr("truncated"));
  EXPECT_THAT(refusal("a.npy", good + "x"), HasSubstr("1 bytes follow"));
}

TEST(NpyCloud, MoreColumns) {
  EXPECT_THAT(all_notes(read("'<f4'", "(2, 4)", rows_with<float>({{0.5}, {0.25}}))), HasSubstr("column 4"));
  EXPECT_THAT(all_notes(read("'<f4'", "(2, 5)", rows_with<float>({{0.5, 1}, {0.25, 2}}))), HasSubstr("columns 4"));
  std::vector<std::vector<double>> colors, normals, zeros, alpha;
  for (std::size_t i = 0; i < 6; ++i) {
    const Rgb8 c = sample_color(i);
    colors.push_back({1.0 * c[0], 1.0 * c[1], 1.0 * c[2]});
    alpha.push_back({1.0 * c[0], 1.0 * c[1], 1.0 * c[2], 255});
    normals.push_back({i % 2 == 0 ? 0.6 : -0.6, 0, 0.8});
    zeros.push_back({0, 0, 0});
  }
  expect_samples(read("'<f8'", "(6, 6)", rows_with<double>(colors)), 6, true);
  expect_samples(read("'<f4'", "(6, 7)", rows_with<float>(alpha)), 6, true);
  const auto with_normals = read("'<f4'", "(6, 6)", rows_with<float>(normals));
  expect_samples(with_normals, 6, false);
  EXPECT_THAT(all_notes(with_normals), HasSubstr("normal"));
  expect_samples(read("'<f4'", "(6, 6)", rows_with<float>(zeros)), 6, false);
  for (const bool colors_first : {false, true}) {
    std::vector<std::vector<double>> both;
    for (std::size_t i = 0; i < 6; ++i) {
      both.push_back(colors_first ? colors[i] : normals[i]);
      both.back().insert(both.back().end(), colors_first ? normals[i].begin() : colors[i].begin(),
                         colors_first ? normals[i].end() : colors[i].end());
    }
    expect_samples(read("'<f4'", "(6, 9)", rows_with<float>(both)), 6, true);
  }
}

/// x y z and r g b as records of their own types, one after the other.
template <class T, class C>
std::string records(std::size_t n, std::string_view between = "", std::string_view after = "") {
  const std::string points = point_bytes<T>(n), colors = color_bytes<C>(n);
  std::string bytes;
  for (std::size_t i = 0; i < n; ++i) {
    bytes += points.substr(3 * sizeof(T) * i, 3 * sizeof(T));
    bytes += between;
    bytes += colors.substr(3 * sizeof(C) * i, 3 * sizeof(C));
    bytes += after;
  }
  return bytes;
}

TEST(NpyCloud, RecordsByTheirNames) {
  const auto file =
      read("[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('red', '|u1'), ('green', '|u1'), ('blue', '|u1')]", "(5,)",
           records<float, U8>(5));
  EXPECT_EQ(file.info.format, "NPY records");
  expect_samples(file, 5, true);
  expect_samples(read("[('X', '<f8'), ('Y', '<f8'), ('Z', '<f8'), ('label', '<i4'), ('R', '<i8'), ('G', '<i8'), ('B', "
                      "'<i8')]",
                      "(5,)", records<double, std::int64_t>(5, "abcd")),
                 5, true);
  expect_samples(
      read("[('xyz', '<f4', (3,)), ('rgb', '|u1', (3,)), ('', '|V1')]", "(5,)", records<float, U8>(5, "", "p")), 5,
      true);
  expect_samples(read("[('position', [('x', '<f4'), ('y', '<f4'), ('z', '<f4')]), ('name', '|S2'), ('color', '<f4', "
                      "(3,))]",
                      "(5, 1)", records<float, float>(5, "ab")),
                 5, true);
  // Packed as PCL does: blue in the lowest byte.
  const auto packed = read("[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('rgb', '<f4')]", "(1,)",
                           raw<float>({0, 0.5, 0}) + std::string("\xff\x28\xc8\x00", 4));
  EXPECT_EQ(std::get<Array<Rgb8>>(packed.cloud.colors)[0], (Rgb8{200, 40, 255}));
}

/// A normal's x, y and z do not get in the way of the position's.
TEST(NpyCloud, RecordsWithinRecords) {
  const std::string descr =
      "[('normal', [('x', '<f4'), ('y', '<f4'), ('z', '<f4')]), ('position', [('x', '<f4'), ('y', '<f4'), ('z', "
      "'<f4')])]";
  const auto file = read(descr, "(1,)", raw<float>({0, 0, 1, 5, 6, 7}));
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(5, 6, 7));
}

TEST(NpyCloud, RecordsOfBothByteOrders) {
  Bytes bytes({}, true);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d p = sample_point(i);
    bytes.put(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    const Rgb8 c = sample_color(i);
    for (const U8 value : c) bytes.put(static_cast<U16>(257 * value));
  }
  const std::string descr =
      "[('x', '>f4'), ('y', '>f4'), ('z', '>f4'), ('red', '>u2'), ('green', '>u2'), ('blue', '>u2')]";
  expect_samples(read(descr, "(4,)", bytes.str()), 4, true);
  EXPECT_THAT(refused(descr, "(5,)", bytes.str()), HasSubstr("truncated"));
  EXPECT_THAT(refused(descr, "(3,)", bytes.str()), HasSubstr("18 bytes follow"));
}

/// What laspy holds in memory: integers whose scale stands in the file's header.
TEST(NpyCloud, RawIntegersOfLasAreRefused) {
  const auto refusal_of = [](std::string_view x, std::string_view y, std::string_view z, std::string_view more) {
    return refused(fmt::format("[('{}', '<i4'), ('{}', '<i4'), ('{}', '<i4'), ('{}', '<u2')]", x, y, z, more), "(2,)",
                   std::string(28, '\1'));
  };
  EXPECT_THAT(refusal_of("X", "Y", "Z", "intensity"),
              AllOf(HasSubstr("integers (<i4)"), HasSubstr("scale and offset")));
  EXPECT_THAT(refusal_of("X", "Y", "Z", "other"), HasSubstr("scale and offset"));
  EXPECT_THAT(refusal_of("x", "y", "z", "gps_time"), HasSubstr("scale and offset"));
  EXPECT_EQ(refusal_of("x", "y", "z", "label"), "");
  EXPECT_THAT(refusal_of("x", "y", "w", "label"), HasSubstr("no field 'z'"));
}

}  // namespace npy_reader_test
}  // namespace cmap::testing
