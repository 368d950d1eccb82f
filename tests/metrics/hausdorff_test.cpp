#include <algorithm>
#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace hausdorff_test {

using test::measured;
using test::number;

TEST(Hausdorff, HandComputed) {
  const Record found = measured(catalog::hausdorff, test::pair_with({0.0625, 9.0}, {0.25, 1.0, 25.0}));
  EXPECT_EQ(*found.value, 5.0);
  EXPECT_EQ(number(found, "estimate_to_reference.max"), 3.0);
  EXPECT_DOUBLE_EQ(number(found, "estimate_to_reference.p95"), 2.8625);
  EXPECT_DOUBLE_EQ(number(found, "estimate_to_reference.p99"), 2.9725);
  EXPECT_EQ(number(found, "reference_to_estimate.max"), 5.0);
  EXPECT_DOUBLE_EQ(number(found, "reference_to_estimate.p95"), 4.6);
}

TEST(Hausdorff, EqualsTheDefinitionOverManyChunks) {
  Array<double> sq_dist = test::random_squares(300001, 1);
  const Record found = measured(catalog::hausdorff, test::pair_with(sq_dist));
  std::ranges::sort(sq_dist);
  EXPECT_EQ(*found.value, std::sqrt(sq_dist.back()));
  // Rank (n - 1) p is whole here.
  EXPECT_EQ(number(found, "estimate_to_reference.p95"), std::sqrt(sq_dist[285000]));
  EXPECT_EQ(number(found, "estimate_to_reference.p99"), std::sqrt(sq_dist[297000]));
}

TEST(Hausdorff, OfAMapAndItselfIsZero) {
  const PointCloud cloud = test::painted_triplicates(300);
  EXPECT_EQ(*measured(catalog::hausdorff, test::Clouds{cloud, cloud}).value, 0.0);
}

TEST(Hausdorff, OneDistance) {
  const Record found = measured(catalog::hausdorff, test::pair_with({4.0}));
  for (const char* path : {"max", "p95", "p99"}) {
    EXPECT_EQ(number(found, std::string("estimate_to_reference.") + path), 2.0);
  }
}

}  // namespace hausdorff_test
}  // namespace cmap
