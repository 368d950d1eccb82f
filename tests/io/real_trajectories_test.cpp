#include "cmap/core/error.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "io/real_data.hpp"

namespace cmap::testing {
namespace real_trajectories_test {

TEST_F(RealData, KittiPosesArePairedByRow) {
  const auto [estimate, truth] = read_trajectory_pair(folder_ / "kitti_trajectories/kiss_icp_07.txt",
                                                      folder_ / "kitti_trajectories/truth_07.txt", std::nullopt);
  EXPECT_EQ(estimate.poses.size(), 1101U);
  EXPECT_EQ(truth.poses.size(), 1101U);
  double length_m = 0.0;
  for (std::size_t i = 1; i < 1101; ++i) length_m += (truth.poses[i].position - truth.poses[i - 1].position).norm();
  EXPECT_NEAR(length_m, 695.0, 0.5);
  EXPECT_EQ(read_trajectory(folder_ / "kitti_trajectories/steam_icp_07.txt").poses.size(), 1101U);
}

TEST_F(RealData, TumPosesOfOtherProjects) {
  const std::pair<const char*, std::size_t> kFiles[] = {
      {"balm_hall/poses.tum", 177},
      {"fastlivo2_ntu_viral/nya_01_gt.txt", 7675},
      {"fastlivo2_ntu_viral/nya_01_prism.txt", 3945},
  };
  for (const auto& [name, n] : kFiles) EXPECT_EQ(read_trajectory(folder_ / name).rows, n) << name;
}

TEST_F(RealData, OtherTablesAreRefused) {
  for (const char* name : {"fastlivo2_ntu_viral/mat_out.txt", "fastlivo2_ntu_viral/imu.txt",
                           "fastlivo2_ntu_viral/colmap_images_other_sequence.txt", "balm_hall/loops_measured.csv"}) {
    EXPECT_THROW(read_trajectory(folder_ / name), InputError) << name;
  }
}

}  // namespace real_trajectories_test
}  // namespace cmap::testing
