#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace rmse_test {

using test::measured;
using test::number;

TEST(Rmse, HandComputed) {
  // Distances 0.25 and 3, of which one is within a meter; the reference's distances do not count.
  const Record found = measured(catalog::rmse, test::pair_with({0.0625, 9.0}, {100.0}));
  EXPECT_EQ(*found.value, std::sqrt(9.0625 / 2));
  EXPECT_EQ(number(found, "inlier_rmse"), 0.25);
  EXPECT_EQ(number(found, "n"), 2);
  EXPECT_EQ(number(found, "n_inliers"), 1);
}

TEST(Rmse, WithoutInliersThatIsMissing) {
  const Record found = measured(catalog::rmse, test::pair_with({9.0}));
  EXPECT_EQ(*found.value, 3.0);
  EXPECT_TRUE(std::isnan(number(found, "inlier_rmse")));
}

TEST(Rmse, EqualsTheDefinitionOverManyChunks) {
  const Array<double> sq_dist = test::random_squares(300001, 5);
  long double sum = 0.0L;
  for (const double sq : sq_dist) sum += sq;
  EXPECT_NEAR_RELATIVE(*measured(catalog::rmse, test::pair_with(sq_dist)).value,
                       static_cast<double>(std::sqrt(sum / 300001.0L)), test::kLongDoubleSum);
}

}  // namespace rmse_test
}  // namespace cmap
