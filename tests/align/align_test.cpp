#include "cmap/align/align.hpp"

#include <nlohmann/json.hpp>

#include "align/align_testing.hpp"
#include "align/towns.hpp"

namespace cmap {
namespace align_test {

using ::testing::HasSubstr;

TEST(Align, EveryMethodFromANearbyStart) {
  const PointCloud target = test::town(40, 60000, 1), source = test::town(40, 60000, 2);
  const Similarity T{1.0, rotation_from({0.002, -0.003, 0.01}), {0.2, -0.3, 0.1}};
  const PointCloud moved = transformed(source, T.inverse().matrix());
  for (const RegistrationMethod* method : registration_methods()) {
    if (!method->needs_initial) continue;
    const Alignment found = align(moved, target, *method);
    // Other samples of the same town, 0.3 m apart.
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), T, moved), 0.1) << method->name;
    EXPECT_EQ(found.method, method->name);
    EXPECT_GT(found.overlap, 0.9);
  }
}

TEST(Align, TheInitialTransformLeadsAcrossAnyDistance) {
  const PointCloud target = test::town(40, 30000, 3);
  std::mt19937_64 random(4);
  const Similarity A = test::random_similarity(random, 1.0, 1.0, 1e6);
  AlignOptions options;
  const Similarity off{1.0, rotation_from({0, 0, 0.005}), {0.1, 0.1, 0}};
  options.T_initial = (off * A.inverse()).matrix();
  const PointCloud moved = transformed(target, A.matrix());
  const Similarity found = similarity_from(align(moved, target, registration_method("gicp"), options).T_dst_src);
  // A copy, but thinned on another lattice.
  EXPECT_LT(test::displacement_m(found, A.inverse(), moved), 0.01);
}

TEST(Align, TheDefaultVoxelIsBlindToStraysAndFollowsTheScale) {
  PointCloud cloud = test::town(50, 40000, 5);
  const double voxel_m = default_align_voxel_m(cloud);
  // A box of about 100 m by 100 m by 20 m over 400, or twice the spacing, which is larger: 1 / (2 sqrt(4 / m^2)) each.
  EXPECT_GT(voxel_m, 0.25);
  EXPECT_LT(voxel_m, 0.8);
  cloud.positions.emplace_back(1e6f, 0.0f, 0.0f);
  EXPECT_NEAR(default_align_voxel_m(cloud), voxel_m, 0.01 * voxel_m);
  const Eigen::Matrix4d doubled = Similarity{2.0, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()}.matrix();
  EXPECT_NEAR(default_align_voxel_m(transformed(cloud, doubled)), 2.0 * voxel_m, 0.02 * voxel_m);
}

TEST(Align, LevelsGoOnToWhatIsToBeMeasured) {
  // Points 2 cm apart in a town of 40 m, whose own voxel is 14 cm: both maps are thinned on lattices of their own.
  const PointCloud target = test::town(20, 400000, 7), source = test::town(20, 400000, 8);
  const Similarity T{1.0, rotation_from({0.002, -0.003, 0.01}), {0.2, -0.3, 0.1}};
  const PointCloud moved = transformed(source, T.inverse().matrix());
  const auto error_m = [&](const Alignment& found) {
    return test::displacement_m(similarity_from(found.T_dst_src), T, moved);
  };
  for (const char* method : {"gicp", "plane", "global"}) {
    AlignOptions options;
    const Alignment coarse = align(moved, target, registration_method(method), options);
    options.finest_m = 0.01;
    const Alignment fine = align(moved, target, registration_method(method), options);
    EXPECT_LT(fine.voxel_m, 0.5 * coarse.voxel_m);
    EXPECT_GT(fine.voxel_m, 0.01) << "not below the points' spacing";
    EXPECT_LT(error_m(fine), 0.1 * *options.finest_m) << method;
    EXPECT_EQ(fine.method, method);
    EXPECT_EQ(fine.judgment.verdict, Verdict::kDetermined);
    EXPECT_EQ(fine.judgment.score, coarse.judgment.score);
    if (method == std::string("gicp")) {
      EXPECT_LT(error_m(fine), 0.5 * error_m(coarse));
    }
    options.finest_m = 1.0;
    EXPECT_EQ(align(moved, target, registration_method(method), options).T_dst_src, coarse.T_dst_src);
  }
}

TEST(Align, SaysWhatIsWrong) {
  const PointCloud cloud = test::town(20, 2000, 6);
  EXPECT_THROW(registration_method("ICP"), UsageError);
  EXPECT_THROW(align({}, cloud, registration_method("icp")), std::invalid_argument);
  AlignOptions options;
  options.voxel_m = -1.0;
  EXPECT_THROW(align(cloud, cloud, registration_method("icp"), options), UsageError);
  options.voxel_m.reset();
  options.finest_m = 0.0;
  EXPECT_THROW(align(cloud, cloud, registration_method("icp"), options), UsageError);
  options.finest_m.reset();
  PointCloud far = cloud;
  far.origin.z() += 1000.0;
  for (const RegistrationMethod* method : registration_methods()) {
    if (!method->needs_initial) continue;
    EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align(far, cloud, *method); }), HasSubstr("no overlap"));
  }
}

TEST(AlignmentJson, HoldsEverything) {
  Alignment alignment;
  alignment.T_dst_src(0, 3) = 7.5;
  alignment.weakest = "scale";
  alignment.warnings = {"w"};
  const auto json = alignment_json(alignment);
  EXPECT_EQ(json["T_dst_src"][0][3], 7.5);
  EXPECT_EQ(json["T_dst_src"].size(), 4u);
  EXPECT_EQ(json["weakest_direction"], "scale");
  EXPECT_EQ(json["warnings"][0], "w");
}

}  // namespace align_test
}  // namespace cmap
