#include "global/fourier.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cmap {
namespace fourier_test {

TEST(Fourier, ThereAndBack) {
  const Fourier2d fourier(32);
  std::mt19937 random(1);
  Fourier2d::Grid grid(32 * 32);
  for (auto& v : grid) v = {static_cast<float>(random() % 100), static_cast<float>(random() % 100)};
  const Fourier2d::Grid before = grid;
  fourier.transform(grid);
  fourier.inverse(grid);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_LT(std::abs(grid[i] / 1024.0f - before[i]), 1e-4f);
}

TEST(Fourier, ProductsOfSpectraAreCyclicConvolutions) {
  const Fourier2d fourier(16);
  Fourier2d::Grid a(256), b(256);
  a[3 * 16 + 5] = 2.0f;
  b[14 * 16 + 12] = 3.0f;
  fourier.transform(a);
  fourier.transform(b);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
  fourier.inverse(a);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].real() / 256.0f, i == 1 * 16 + 1 ? 6.0f : 0.0f, 1e-4f);
}

/// By the definition, transposed.
TEST(Fourier, OfOneWave) {
  constexpr std::size_t kSide = 12;
  Fourier2d::Grid grid(kSide * kSide);
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      const double phase = 2.0 * M_PI * static_cast<double>(2 * row + 5 * column) / kSide;
      grid[row * kSide + column] = std::polar(1.0f, static_cast<float>(phase));
    }
  }
  Fourier2d(kSide).transform(grid);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(std::abs(grid[i]), i == 5 * kSide + 2 ? 144.0f : 0.0f, 1e-3f) << i;
  }
}

}  // namespace fourier_test
}  // namespace cmap
