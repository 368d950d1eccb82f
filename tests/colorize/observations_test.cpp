#include "cmap/colorize/observations.hpp"

#include <gtest/gtest.h>

namespace cmap {
namespace observations_test {

TEST(Observations, TheHeaviestAreKeptAndAllAreCounted) {
  Observations observations(2, 3);
  for (const std::uint32_t image : {0u, 1u, 2u, 3u, 4u}) {
    const float weight = image == 1 ? 0.1f : image == 3 ? 0.6f : 0.5f;
    observations.add(1, {weight, image, {9, 9, 9}});
  }
  EXPECT_EQ(observations.n_seen(0), 0u);
  EXPECT_TRUE(observations.of(0).empty());
  EXPECT_EQ(observations.n_seen(1), 5u);
  ASSERT_EQ(observations.of(1).size(), 3u);
  // 3 takes the place of 1; 4 weighs no more than those that are there.
  EXPECT_EQ(observations.of(1)[0].image, 0u);
  EXPECT_EQ(observations.of(1)[1].image, 3u);
  EXPECT_EQ(observations.of(1)[2].image, 2u);
}

}  // namespace observations_test
}  // namespace cmap
