#include "cmap/render/alignment_figure.hpp"

#include "cmap/core/execution.hpp"
#include "eval/eval_testing.hpp"
#include "io/io_testing.hpp"

namespace cmap {
namespace alignment_figure_test {

/// Of the source pixels are orange, whatever their height; of the target blue.
std::size_t n_of_source(const Image& image, int from_column, int to_column) {
  std::size_t n = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = from_column; x < to_column; ++x) {
      const Rgba8& p = image.pixels[static_cast<std::size_t>(y * image.width + x)];
      n += p[0] > p[2] + 40 ? 1 : 0;
    }
  }
  return n;
}

struct Case {
  PointCloud source = test::painted_sheet(5'000, 1);
  PointCloud target = test::painted_sheet(5'000, 2);
  Alignment alignment;
  Eigen::Matrix4d T_initial = Eigen::Matrix4d::Identity();

  Image draw() const { return draw_alignment({source, target, T_initial, alignment}); }
};

TEST(DrawAlignment, ShowsTheSecondBestAnswerWhereThereIsOne) {
  Case c;
  EXPECT_EQ(c.draw().height, 800);
  c.alignment.judgment.rivals.push_back({});
  EXPECT_EQ(c.draw().height, 1500);  // another row
}

TEST(DrawAlignment, ASourceFarAwayIsMovedIntoTheFirstPanel) {
  Case c;
  c.T_initial(0, 3) = 10'000.0;
  EXPECT_GT(n_of_source(c.draw(), 0, 700), 1000u);
}

TEST(DrawAlignment, ASourceMovedAwayIsNotInTheSecondPanel) {
  Case c;
  const std::size_t together = n_of_source(c.draw(), 700, 1400);
  c.alignment.T_dst_src(2, 3) = -1.0;  // below the target, which hides it
  EXPECT_LT(n_of_source(c.draw(), 700, 1400), together / 2);
}

TEST(DrawAlignment, IsTheSameForAnyNumberOfThreads) {
  const Case c;
  Array<Rgba8> pixels[2];
  for (int threads : {1, 2}) {
    const ExecutionScope limit({.threads = threads});
    pixels[threads - 1] = c.draw().pixels;
  }
  EXPECT_EQ(pixels[0], pixels[1]);
}

TEST(DrawAlignment, NamesThatAreNoPicturesAreRefused) {
  const Case c;
  const testing::TempFolder folder;
  OutputFile file(folder.path() / "picture.txt");
  EXPECT_THROW(write_alignment_figure({c.source, c.target, c.T_initial, c.alignment}, "picture.txt", file), UsageError);
}

}  // namespace alignment_figure_test
}  // namespace cmap
