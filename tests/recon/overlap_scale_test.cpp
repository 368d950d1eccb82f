#include "cmap/recon/overlap_scale.hpp"

#include "recon/recon_testing.hpp"

namespace cmap {
namespace overlap_scale_test {

struct Frame {
  std::vector<float> depth_before, confidence_before, depth_after, confidence_after;
  SharedFrame shared() const { return {depth_before, confidence_before, depth_after, confidence_after}; }
};

/// Depths of one scene in two units; the less confident half is wrong.
Frame frame_of(std::mt19937_64& random, std::size_t n, double ratio, double noise) {
  Frame frame;
  for (std::size_t i = 0; i < n; ++i) {
    const double depth = test::uniform_in(random, 1.0, 50.0);
    const bool good = i % 2 == 0;
    const double error = good ? std::exp(noise * test::normal(random)) : 3.0;
    frame.depth_before.push_back(static_cast<float>(depth * ratio * error));
    frame.depth_after.push_back(static_cast<float>(depth));
    frame.confidence_before.push_back(good ? 5.0f : 1.5f);
    frame.confidence_after.push_back(good ? 7.0f : 6.0f);
  }
  return frame;
}

TEST(OverlapScale, MedianOfTheConfidentPixels) {
  std::mt19937_64 random(1);
  const Frame a = frame_of(random, 5000, 1.7, 0.01), b = frame_of(random, 5000, 1.7, 0.01);
  const std::vector<SharedFrame> frames{a.shared(), b.shared()};
  const auto found = scale_ratio_of_depths(frames);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->n, 5000u);
  // The median of 5000 normals of 1 %: 0.01 * 1.25 / sqrt(5000) = 0.00018; four times that.
  EXPECT_NEAR(found->ratio, 1.7, 1.7 * 0.0008);
  EXPECT_NEAR(found->sigma_log, 0.01, 0.0008);
}

TEST(OverlapScale, LeavesOutWhatIsNoDepth) {
  std::mt19937_64 random(2);
  Frame frame = frame_of(random, 1000, 0.5, 0.0);
  for (std::size_t i = 0; i < 1000; i += 4) {
    frame.depth_before[i] = i % 8 == 0 ? 0.0f : NAN;
    frame.depth_after[i] = i % 8 == 0 ? 1.0f : INFINITY;
  }
  const std::vector<SharedFrame> frames{frame.shared()};
  const auto found = scale_ratio_of_depths(frames);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->n, 250u);
  EXPECT_NEAR(found->ratio, 0.5, 1e-6);
}

TEST(OverlapScale, NoneWithoutPixels) {
  std::mt19937_64 random(3);
  EXPECT_FALSE(scale_ratio_of_depths({}));
  const Frame few = frame_of(random, 150, 1.0, 0.0);
  const std::vector<SharedFrame> frames{few.shared()};
  EXPECT_FALSE(scale_ratio_of_depths(frames)) << "75 confident pixels";
  Frame broken = few;
  broken.depth_after.pop_back();
  const std::vector<SharedFrame> unequal{broken.shared()};
  EXPECT_THROW(scale_ratio_of_depths(unequal), std::invalid_argument);
}

TEST(OverlapScale, OfCenters) {
  std::mt19937_64 random(4);
  const Similarity T = test::random_similarity(random, 1.6, 1.6, 5.0);
  std::vector<Eigen::Vector3d> before, after;
  for (int i = 0; i < 10; ++i) {
    after.push_back(test::random_vector(random, 1.0));
    before.emplace_back(T * after.back());
  }
  EXPECT_NEAR(scale_ratio_of_centers(before, after)->ratio, 1.6, 1e-12);
  EXPECT_LT(scale_ratio_of_centers(before, after)->sigma_log, 1e-7);
  EXPECT_NEAR(scale_ratio_of_centers(after, before)->ratio, 1 / 1.6, 1e-12);
  // The stated deviation is the one found: relative errors over it have variance 1, to 3 sqrt(2 / 300).
  double sum_sq = 0.0;
  constexpr int kTrials = 300;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Eigen::Vector3d> noisy = before;
    for (auto& x : noisy) x += test::normal_vector(random, 0.02);
    const auto found = scale_ratio_of_centers(noisy, after);
    sum_sq += std::pow(std::log(found->ratio / 1.6) / found->sigma_log, 2) / kTrials;
  }
  EXPECT_NEAR(sum_sq, 1.0, 0.3) << "and Student's tails of 23 degrees of freedom";
}

TEST(OverlapScale, CentersThatDoNotTell) {
  std::vector<Eigen::Vector3d> two{{0, 0, 0}, {1, 0, 0}}, line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
      one_place(5, {1, 1, 1});
  EXPECT_FALSE(scale_ratio_of_centers(two, two));
  EXPECT_FALSE(scale_ratio_of_centers(line, line));
  EXPECT_FALSE(scale_ratio_of_centers(one_place, one_place));
  EXPECT_THROW(scale_ratio_of_centers(two, line), std::invalid_argument);
}

}  // namespace overlap_scale_test
}  // namespace cmap
