#include "cmap/core/round_number.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cmap {
namespace round_number_test {

TEST(RoundNumberAbove, IsTheNextRoundNumber) {
  EXPECT_EQ(round_number_above(1.0), 1.0);
  EXPECT_EQ(round_number_above(1.01), 1.5);
  EXPECT_EQ(round_number_above(0.21), 0.3);  // exactly, not 0.30000000000000004
  EXPECT_EQ(round_number_above(0.0000061), 0.000008);
  EXPECT_EQ(round_number_above(8.1), 10.0);
  EXPECT_EQ(round_number_above(4321.0), 5000.0);
}

TEST(RoundNumberAbove, ARoundNumberUpToRoundingStays) { EXPECT_EQ(round_number_above(0.1 + 0.2), 0.3); }

TEST(RoundNumberAbove, WithoutAPositiveValueItIsOne) {
  EXPECT_EQ(round_number_above(0.0), 1.0);
  EXPECT_EQ(round_number_above(-2.0), 1.0);
  EXPECT_EQ(round_number_above(std::numeric_limits<double>::quiet_NaN()), 1.0);
}

}  // namespace round_number_test
}  // namespace cmap
