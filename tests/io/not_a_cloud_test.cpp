#include "clouds/not_a_cloud.hpp"

#include <cmath>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace not_a_cloud_test {

using Rows = std::vector<std::vector<double>>;
using ::testing::HasSubstr;

constexpr const char* kMayBePoints = "may be points";

std::string what(const Rows& rows, bool complete = true) { return not_a_cloud(rows, complete).value_or(kMayBePoints); }

// cos and sin of 0.1
const double kCos = std::cos(0.1);
const double kSin = std::sin(0.1);
const Rows kTransform{{kCos, -kSin, 0, 1.5}, {kSin, kCos, 0, -0.25}, {0, 0, 1, 0.125}, {0, 0, 0, 1}};

std::vector<double> joined(const Rows& rows) {
  std::vector<double> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

TEST(NotACloud, Transforms) {
  EXPECT_THAT(what(kTransform), HasSubstr("4x4 matrix"));
  EXPECT_THAT(what({kTransform[0], kTransform[1], kTransform[2]}), HasSubstr("3x4 matrix"));
  EXPECT_THAT(what({joined(kTransform)}), HasSubstr("4x4 matrix"));
  // Its transpose, and one with a scale.
  EXPECT_THAT(what({{kCos, kSin, 0, 0}, {-kSin, kCos, 0, 0}, {0, 0, 1, 0}, {1, 2, 3, 1}}), HasSubstr("4x4 matrix"));
  EXPECT_THAT(what({{2, 0, 0, 5}, {0, 2, 0, 6}, {0, 0, 2, 7}, {0, 0, 0, 1}}), HasSubstr("4x4 matrix"));
}

TEST(NotACloud, ComputedTransformsAreAMillionthOff) {
  Rows rounded = kTransform;
  rounded[3] = {1e-17, -9e-7, 0, 0.9999995};
  EXPECT_THAT(what(rounded), HasSubstr("4x4 matrix"));
  rounded[3][3] = 1.00001;
  EXPECT_EQ(what(rounded), kMayBePoints);
  // Of a mirrored map.
  EXPECT_THAT(what({{-1, 0, 0, 5}, {0, 1, 0, 6}, {0, 0, 1, 7}, {0, 0, 0, 1}}), HasSubstr("4x4 matrix"));
}

TEST(NotACloud, RotationsAndCameras) {
  const Rows rotation{{kCos, -kSin, 0}, {kSin, kCos, 0}, {0, 0, 1}};
  EXPECT_THAT(what(rotation), HasSubstr("3x3 rotation or camera matrix"));
  EXPECT_THAT(what({{700, 0.5, 320}, {0, 710, 240}, {0, 0, 1}}), HasSubstr("3x3 rotation or camera matrix"));
  EXPECT_EQ(what(rotation, false), kMayBePoints) << "more rows follow";
  EXPECT_EQ(what({{700, 0, 320}, {1, 700, 240}, {0, 0, 1}}), kMayBePoints);
  EXPECT_EQ(what({{700, 0, 320}, {0, 700, 240}, {0, 0, 2}}), kMayBePoints);
}

TEST(NotACloud, FourPointsAreNoTransform) {
  EXPECT_EQ(what({{1, 2, 3, 0.5}, {4, 5, 6, 0.5}, {7, 8, 9, 0.5}, {1, 1, 2, 0.5}}), kMayBePoints);
  EXPECT_EQ(what({{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 0}, {1, 1, 2, 1}}), kMayBePoints);
  EXPECT_EQ(what({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0, 0, 1}}), kMayBePoints);
  EXPECT_EQ(what({{1, 2, 3, 7}, {4, 5, 6, 8}, {7, 8, 9, 9}, {0, 0, 0, 1}}), kMayBePoints);
  Rows five = kTransform;
  five.push_back({1, 2, 3, 4});
  EXPECT_EQ(what({five[0], five[1], five[2], five[4]}), kMayBePoints);
}

TEST(NotACloud, RowsOfPoses) {
  const std::vector<double> kitti{kCos, -kSin, 0, 1.5, kSin, kCos, 0, -0.25, 0, 0, 1, 0.125};
  EXPECT_THAT(what({kitti, kitti}, false), HasSubstr("poses (rows of 12 numbers"));
  EXPECT_THAT(what({kitti}), HasSubstr("poses"));
  EXPECT_THAT(what({joined(kTransform), joined(kTransform)}, false), HasSubstr("rows of 16 numbers"));
  std::vector<double> sheared = kitti;
  sheared[1] = 0.3;
  EXPECT_EQ(what({kitti, sheared}, false), kMayBePoints) << "all rows must fit";
  EXPECT_EQ(what({{1, 2, 3, 0, 0, 1, 255, 0, 7, 0.5, 1, 2}}, false), kMayBePoints);
}

TEST(NotACloud, StackedMatrices) {
  Rows stack = kTransform;
  stack.insert(stack.end(), kTransform.begin(), kTransform.end());
  EXPECT_THAT(what(stack, false), HasSubstr("4x4 matrices"));
  Rows log{{0, 0, 1}};
  log.insert(log.end(), kTransform.begin(), kTransform.end());
  log.push_back({1, 1, 2});
  log.insert(log.end(), kTransform.begin(), kTransform.end());
  EXPECT_THAT(what(log, false), HasSubstr("4x4 matrices"));
  log[5] = {1, 1};
  EXPECT_EQ(what(log, false), kMayBePoints);
}

TEST(NotACloud, TumTrajectories) {
  const double half = std::sqrt(0.5);
  EXPECT_THAT(what({{0.5, 1, 2, 3, 0, 0, 0, 1}, {0.6, 1, 2, 3, 0, 0, half, half}}, false), HasSubstr("TUM"));
  EXPECT_THAT(what({{1.3e9, 1, 2, 3, 0.5, -0.5, 0.5, -0.5}, {1.4e9, 1, 2, 3, 0.5, 0.5, 0.5, 0.5}}, false),
              HasSubstr("TUM"));
  // Times that do not grow; quaternions of another length; normals with a curvature.
  EXPECT_EQ(what({{0.6, 1, 2, 3, 0, 0, 0, 1}, {0.6, 1, 2, 3, 0, 0, half, half}}, false), kMayBePoints);
  EXPECT_EQ(what({{0.5, 1, 2, 3, 0, 0, 0, 1}, {0.6, 1, 2, 3, 0, 0, 0.6, 0.7}}, false), kMayBePoints);
  EXPECT_EQ(what({{0.5, 1, 2, 9, 0, 0, 1, 0.001}, {0.6, 1, 2, 9, 0, 0.6, 0.8, 0.002}}, false), kMayBePoints);
  EXPECT_EQ(what({{0.5, 1, 2, 10, 20, 30, 0, 1}, {0.6, 1, 2, 255, 0, 7, 0, 1}}, false), kMayBePoints);
  EXPECT_EQ(what({{0.5, 1, 2, 3, 0, 0, 0, 1}}), kMayBePoints) << "one row shows too little";
}

TEST(NotACloud, TransposedClouds) {
  const std::vector<double> row(60, 1.5);
  EXPECT_THAT(what({row, row, row}), HasSubstr("3 rows of 60 numbers: a transposed cloud"));
  EXPECT_THAT(what({row, row, row, row, row, row}), HasSubstr("6 rows of 60"));
  EXPECT_EQ(what({row, row, row}, false), kMayBePoints) << "more rows follow";
  EXPECT_THAT(what({row, row}), HasSubstr("2 rows of 60"));
  EXPECT_THAT(what({row}), HasSubstr("1 row of 60"));
  EXPECT_THAT(what(Rows(8, row)), HasSubstr("8 rows of 60 numbers: a transposed cloud, or several things"));
  EXPECT_THAT(what(Rows(6, std::vector<double>(18, 1.5))), HasSubstr("6 rows of 18"));
  EXPECT_THAT(what(Rows(3, std::vector<double>(5, 1.5))), HasSubstr("3 rows of 5"));
  EXPECT_EQ(what(Rows(60, row)), kMayBePoints) << "not fewer rows than columns";
  EXPECT_EQ(what(Rows(8, std::vector<double>(12, 1.5))), kMayBePoints) << "as many columns as points may have";
  EXPECT_EQ(what(Rows(4, std::vector<double>(5, 1.5))), kMayBePoints);
  EXPECT_EQ(what({row, row, std::vector<double>(59, 1.5)}), kMayBePoints);
  const std::vector<double> point(6, 1.5);
  EXPECT_EQ(what({point, point, point}), kMayBePoints);
}

TEST(NotACloud, NamesOfPoses) {
  using Names = std::vector<std::string>;
  EXPECT_TRUE(names_poses(Names{"timestamp", "x", "y", "z", "qx", "qy", "qz", "qw"}));
  EXPECT_TRUE(names_poses(Names{"#time [s]", "tx", "ty", "tz", "q_x", "q_y", "q_z", "q_w"}));
  EXPECT_FALSE(names_poses(Names{"x", "y", "z", "qx", "qy", "qz", "qw"})) << "surfels have directions";
  EXPECT_FALSE(names_poses(Names{"time", "x", "y", "z", "r", "g", "b"}));
}

TEST(NotACloud, GivenAsMapsTheyAreRefused) {
  EXPECT_THAT(refusal("T.txt", "0.8 -0.6 0 1.5\n0.6 0.8 0 -0.25\n0 0 1 0.125\n0 0 0 1\n"), HasSubstr("4x4 matrix"));
  EXPECT_THAT(refusal("T.txt", "# mine\n0.8,-0.6,0,1.5\n0.6,0.8,0,-0.25\n0,0,1,0.125\n0,0,0,1"), HasSubstr("4x4"));
  EXPECT_THAT(refusal("poses.txt", "0.8 -0.6 0 1.5 0.6 0.8 0 -0.25 0 0 1 0.125\n"), HasSubstr("poses (rows of 12"));
  EXPECT_THAT(refusal("a.log", "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"), HasSubstr("poses (4x4 matrices"));
  EXPECT_THAT(refusal("a.tum", "# timestamp tx ty tz qx qy qz qw\n1 2 3 4 0 0 0 1\n2 2 3 4 0 0.6 0 0.8\n"),
              HasSubstr("TUM"));
  EXPECT_THAT(refusal("a.csv", "time,x,y,z,qx,qy,qz,qw\n1,2,3,4,0,0,0,1\n"), HasSubstr("TUM"));
  EXPECT_THAT(refusal("a.csv", "1,2,3,4,5,6,7\n1,2,3,4,5,6,7\n1,2,3,4,5,6,7\n"), HasSubstr("3 rows of 7 numbers"));
  EXPECT_THAT(refusal("T.txt", "0.8 -0.6 0\n0.6 0.8 0\n0 0 1\n"), HasSubstr("3x3 rotation"));
  for (const char* printed :
       {"[[0.8, -0.6, 0, 1.5], [0.6, 0.8, 0, -0.25], [0, 0, 1, 0.125], [1e-17, 0, 0, 1]]",
        "[[0.8 -0.6 0. 1.5]\n [0.6 0.8 0. -0.25]\n [0. 0. 1. 0.125]\n [0. 0. 0. 1.]]\n",
        "{\"T\": [[0.8, -0.6, 0, 1.5], [0.6, 0.8, 0, -0.25], [0, 0, 1, 0.125]]}",
        "array([[0.8, -0.6, 0., 1.5],\n [0.6, 0.8, 0., -0.25],\n [0., 0., 1., 0.125],\n [0., 0., 0., 1.]])"}) {
    EXPECT_THAT(refusal("T.txt", printed), HasSubstr("a transform, and no point cloud; --transform takes it"))
        << printed;
  }
  EXPECT_EQ(refusal("a.txt", "1 2 3 0.5\n2 2 3 0.7\n4 1 0 0.2\n0 0 0 1\n"), "") << "four points";
  EXPECT_EQ(refusal("a.csv", "x,y,z,i\n1,2,3,0\n4,5,6,0\n7,8,9,0\n0,0,0,1\n"), "") << "named columns are points";
}

TEST(NotACloud, Nothing) {
  EXPECT_EQ(what({}), kMayBePoints);
  EXPECT_EQ(what({{}}), kMayBePoints);
  EXPECT_EQ(what({{}, {}, {}, {}}), kMayBePoints);
  const double nan = std::nan("");
  EXPECT_EQ(what({{nan, nan, nan, nan}, {nan, nan, nan, nan}, {nan, nan, nan, nan}}), kMayBePoints);
}

}  // namespace not_a_cloud_test
}  // namespace cmap::testing
