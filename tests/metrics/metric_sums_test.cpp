#include "cmap/metrics/metric_sums.hpp"

#include "metrics/measured.hpp"
#include "point_runs.hpp"

namespace cmap {
namespace metric_sums_test {

using Words = std::vector<ExactSum::Words>;

/// Every metric, with each point or voxel in a part of its own choice, and the parts merged.
class CutMap : public testing::Test {
 protected:
  CutMap() : pair_(test::two_sheets(6000, 5000).pair()), inputs_(options(), pair_) {
    for (const Metric* metric : metric_list()) {
      if (metric->prepare != nullptr) metric->prepare(inputs_);
    }
  }

  static MetricOptions options() {
    MetricOptions options;
    options.awd_voxel_m = 2.0;
    options.awd_min_points = 10;
    options.mme_radius_m = 0.6;
    return options;
  }

  /// The sums of the points or voxels dealt to n parts at random.
  Words sums(const Metric& metric, Side side, std::size_t n_parts) {
    const std::size_t n_columns = metric.columns(inputs_.settings).size();
    std::vector<std::vector<ExactSum>> parts(n_parts, std::vector<ExactSum>(n_columns));
    if (metric.add != nullptr) {
      add_points(metric, side, parts);
    } else {
      add_voxels(metric, side, parts);
    }
    Words words;
    for (std::size_t column = 0; column < n_columns; ++column) {
      ExactSum merged;
      for (const std::vector<ExactSum>& part : parts) merged += part[column];
      words.push_back(merged.words());
    }
    return words;
  }

 private:
  void add_points(const Metric& metric, Side side, std::vector<std::vector<ExactSum>>& parts) {
    std::vector<std::uint32_t> part_of_slot(inputs_.map(side).size());
    for (std::uint32_t& part : part_of_slot) part = static_cast<std::uint32_t>(random_() % parts.size());
    RunReader reader(inputs_, side, true);
    for (const SlotRun& run : slot_runs(part_of_slot.size(), part_of_slot)) {
      metric.add(reader.read(run), parts[run.part]);
    }
  }

  void add_voxels(const Metric& metric, Side side, std::vector<std::vector<ExactSum>>& parts) {
    metric.each_voxel(inputs_, side, [&](const VoxelTerms& voxel) {
      std::vector<ExactSum>& part = parts[random_() % parts.size()];
      for (std::size_t column = 0; column < part.size(); ++column) part[column].add(voxel.terms[column]);
    });
  }

  MapPair pair_;
  MetricInputs inputs_;
  std::mt19937_64 random_{1};
};

TEST_F(CutMap, SumsHaveTheSameBytesInAnyNumberOfParts) {
  std::size_t n_summed = 0;
  for (const Metric* metric : metric_list()) {
    if (metric->add == nullptr && metric->each_voxel == nullptr) continue;
    for (const Side side : {Side::kEstimate, Side::kReference}) {
      if (metric->sides != Sides::kBoth && (metric->sides == Sides::kEstimate) != (side == Side::kEstimate)) continue;
      const Words whole = sums(*metric, side, 1);
      EXPECT_NE(whole, Words(whole.size())) << metric->info.id;
      EXPECT_EQ(sums(*metric, side, 8), whole) << metric->info.id;
      EXPECT_EQ(sums(*metric, side, 1000), whole) << metric->info.id;
      ++n_summed;
    }
  }
  EXPECT_GT(n_summed, 10U);
}

}  // namespace metric_sums_test
}  // namespace cmap
