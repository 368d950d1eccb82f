#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace color_psnr_test {

struct Psnr {
  double y, cb, cr;
};

Psnr psnr_of(const Record& record) {
  return {test::number(record, "y"), test::number(record, "cb"), test::number(record, "cr")};
}

/// Y, Cb, Cr of a direction.
std::vector<double> mse(const Record& record, const char* direction) {
  for (const Number& number : record.part("mse")->numbers) {
    if (number.name == direction) return std::get<std::vector<double>>(number.value);
  }
  return {};
}

TEST(ColorPsnr, HandComputed) {
  const auto record_of = [](Rgb8 reference, Rgb8 estimate) {
    return test::measured(catalog::color_psnr, test::Clouds{test::cloud_of({{0, 0, 0}}, {reference}),
                                                            test::cloud_of({{0, 0, 0}}, {estimate})});
  };
  // A gray step of 0.2 has no chroma.
  const Psnr gray = psnr_of(record_of({100, 100, 100}, {151, 151, 151}));
  EXPECT_NEAR_RELATIVE(gray.y, 10.0 * std::log10(25.0), test::kSummation);
  EXPECT_EQ(gray.cb, INFINITY);
  EXPECT_EQ(gray.cr, INFINITY);
  const Record red = record_of({0, 0, 0}, {255, 0, 0});
  EXPECT_DOUBLE_EQ(mse(red, "estimate_to_reference")[0], 0.2126 * 0.2126);
  EXPECT_DOUBLE_EQ(mse(red, "estimate_to_reference")[1], 0.1146 * 0.1146);
  EXPECT_DOUBLE_EQ(mse(red, "reference_to_estimate")[2], 0.25);
  const Psnr exact = psnr_of(record_of({9, 8, 7}, {9, 8, 7}));
  for (const double db : {exact.y, exact.cb, exact.cr}) EXPECT_EQ(db, INFINITY);
}

TEST(ColorPsnr, TakesTheWorseDirectionOfEachChannel) {
  // The far white reference point is found in one direction only: mse 0 against 1/2.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {10, 0, 0}}, {{0, 0, 0}, {255, 255, 255}}),
                            test::cloud_of({{0, 0, 0}}, {{0, 0, 0}})};
  const Record psnr = test::measured(catalog::color_psnr, clouds);
  EXPECT_EQ(mse(psnr, "estimate_to_reference")[0], 0.0);
  EXPECT_NEAR(*psnr.value, 10.0 * std::log10(2.0), 1e-12);
  const Record other = test::measured(catalog::color_psnr, test::Clouds{clouds.estimate, clouds.reference});
  EXPECT_EQ(*other.value, *psnr.value);
}

}  // namespace color_psnr_test
}  // namespace cmap
