#include "global/column_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "cmap/core/parallel.hpp"
#include "global/fourier.hpp"

namespace cmap {
namespace {

constexpr std::size_t kChannels = 5;
constexpr std::size_t kPeaksPerTurn = 8;
constexpr int kApartCells = 3;
constexpr int kApartTurns = 2;
constexpr double kTurnsPerCell = 1.1;  ///< half of them, so that the source's rim moves by about a cell
constexpr int kMostTurns = 240;
constexpr std::size_t kSmallestGrid = 32, kLargestGrid = 256;

/// The word scores as a sum of few products: scores[a][b] = sum_k sign_k value_k[a] value_k[b], best where words are
/// frequent.
struct Channels {
  std::array<std::array<float, ColumnMap::kWords>, kChannels> value{};
  std::array<float, kChannels> sign{};
};

Channels factored(const WordScores& scores, const ColumnMap& source, const ColumnMap& target) {
  constexpr auto n = static_cast<Eigen::Index>(ColumnMap::kWords);
  Eigen::VectorXd frequency = Eigen::VectorXd::Constant(n, 1.0);
  for (const ColumnMap* map : {&source, &target}) {
    for (const std::uint8_t word : map->word) frequency[word] += 1.0;
  }
  const Eigen::VectorXd root = frequency.cwiseSqrt();
  Eigen::MatrixXd weighted(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      weighted(a, b) = scores[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] * root[a] * root[b];
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(weighted);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(eigen.eigenvalues()[a]) > std::abs(eigen.eigenvalues()[b]);
  });
  Channels channels;
  for (std::size_t k = 0; k < kChannels; ++k) {
    const double value = eigen.eigenvalues()[order[k]];
    channels.sign[k] = value < 0.0 ? -1.0f : 1.0f;
    for (std::size_t a = 1; a < ColumnMap::kWords; ++a) {  // none of the empty word
      const auto row = static_cast<Eigen::Index>(a);
      channels.value[k][a] =
          static_cast<float>(std::sqrt(std::abs(value)) * eigen.eigenvectors()(row, order[k]) / root[row]);
    }
  }
  return channels;
}

/// The source's words after a turn, in cells of the target's side around the source's center.
class TurnedWords {
 public:
  TurnedWords(const ColumnMap& source, bool mirrored)
      : source_(source),
        mirrored_(mirrored),
        reach_(static_cast<int>(0.5 * std::hypot(source.width, source.height)) + 1) {}

  int reach() const { return reach_; }

  template <class Visit>  // (x, y, word, weight), 0 <= x, y <= 2 reach
  void visit(double turn_rad, Visit&& visit) const {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    const double middle_x = 0.5 * source_.width, middle_y = 0.5 * source_.height;
    for (int y = -reach_; y <= reach_; ++y) {
      for (int x = -reach_; x <= reach_; ++x) {
        const double u = c * x + s * y, v = -s * x + c * y;
        const int column = static_cast<int>(std::floor(middle_x + (mirrored_ ? -u : u)));
        const int row = static_cast<int>(std::floor(middle_y + v));
        const std::uint8_t word = source_.word_at(column, row);
        if (word != ColumnMap::kEmpty) visit(x + reach_, y + reach_, word, source_.weight_at(column, row));
      }
    }
  }

 private:
  const ColumnMap& source_;
  bool mirrored_;
  int reach_;
};

struct Peak {
  int turn = 0, x = 0, y = 0;  ///< of the source's center, in cells of the target
  float score = 0.0f;
};

bool are_apart(const Peak& a, const Peak& b, int n_turns) {
  const int turn = std::abs(a.turn - b.turn);
  return std::min(turn, n_turns - turn) > kApartTurns ||
         std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) > kApartCells;
}

/// The best of a list that is sorted by score, without those next to better ones.
std::vector<Peak> distinct(const std::vector<Peak>& sorted, int n_turns, std::size_t n_best) {
  std::vector<Peak> kept;
  for (const Peak& peak : sorted) {
    if (kept.size() == n_best) break;
    const auto is_apart = [&](const Peak& other) { return are_apart(peak, other, n_turns); };
    if (std::all_of(kept.begin(), kept.end(), is_apart)) kept.push_back(peak);
  }
  return kept;
}

void sort_peaks(std::vector<Peak>& peaks) {
  std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.score > b.score; });
}

class ColumnSearch {
 public:
  ColumnSearch(const ColumnMap& source, const ColumnMap& target, const WordScores& scores, bool mirrored)
      : source_(source),
        target_(target),
        turned_(source, mirrored),
        channels_(factored(scores, source, target)),
        fourier_(grid_side()),
        n_turns_(2 * std::clamp(static_cast<int>(kTurnsPerCell * std::hypot(source.width, source.height)), 8,
                                kMostTurns / 2)) {
    for (std::size_t k = 0; k < kChannels; ++k) spectra_.push_back(target_spectrum(k));
  }

  int n_turns() const { return n_turns_; }
  double turn_rad(int turn) const { return 2.0 * std::numbers::pi * turn / n_turns_; }

  std::vector<Peak> best(std::size_t n_best) const {
    std::vector<std::vector<Peak>> by_pair(static_cast<std::size_t>(n_turns_ / 2));
    parallel_chunks(by_pair.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t pair = begin; pair < end; ++pair) by_pair[pair] = peaks_of_pair(2 * static_cast<int>(pair));
    });
    std::vector<Peak> all;
    for (const auto& peaks : by_pair) all.insert(all.end(), peaks.begin(), peaks.end());
    sort_peaks(all);
    return distinct(all, n_turns_, n_best);
  }

 private:
  using Grid = Fourier2d::Grid;

  struct TurnedWord {
    std::size_t place;
    std::uint8_t word;
    float weight;
  };

  /// Shifts with a sliver in common may wrap around.
  std::size_t grid_side() const {
    constexpr double kUsed = 0.85;
    const double needed = kUsed * (std::max(target_.width, target_.height) + 2 * turned_.reach());
    return std::clamp(std::bit_ceil(static_cast<std::size_t>(needed)), kSmallestGrid, kLargestGrid);
  }

  std::size_t cell(int x, int y) const {
    const auto side = static_cast<int>(fourier_.side());
    return static_cast<std::size_t>((y & (side - 1)) * side + (x & (side - 1)));
  }

  Grid target_spectrum(std::size_t k) const {
    Grid grid(fourier_.side() * fourier_.side());
    for (int y = 0; y < target_.height; ++y) {
      for (int x = 0; x < target_.width; ++x) {
        const std::uint8_t word = target_.word_at(x, y);
        if (word != ColumnMap::kEmpty) grid[cell(x, y)] += target_.weight_at(x, y) * channels_.value[k][word];
      }
    }
    fourier_.transform(grid);
    return grid;
  }

  /// Two turns at once, as real and imaginary part.
  std::vector<Peak> peaks_of_pair(int first_turn) const {
    std::vector<TurnedWord> words[2];
    for (int part = 0; part < 2; ++part) {
      turned_.visit(turn_rad(first_turn + part), [&](int x, int y, std::uint8_t word, float weight) {
        words[part].push_back({cell(-x, -y), word, weight});  // turned round: products of spectra then correlate
      });
    }
    Grid sum(fourier_.side() * fourier_.side());
    for (std::size_t k = 0; k < kChannels; ++k) {
      Grid grid(sum.size());
      for (const auto& [place, word, weight] : words[0]) grid[place] += weight * channels_.value[k][word];
      for (const auto& [place, word, weight] : words[1]) {
        grid[place] += std::complex<float>(0.0f, weight * channels_.value[k][word]);
      }
      fourier_.transform(grid);
      const float sign = channels_.sign[k];
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const std::complex<float> a = grid[i], b = spectra_[k][i];
        sum[i] += std::complex<float>(sign * (a.real() * b.real() - a.imag() * b.imag()),
                                      sign * (a.real() * b.imag() + a.imag() * b.real()));
      }
    }
    fourier_.inverse(sum);
    std::vector<Peak> peaks;
    for (int part = 0; part < 2; ++part) add_peaks(sum, part == 1, first_turn + part, peaks);
    return peaks;
  }

  void add_peaks(const Grid& sum, bool imaginary, int turn, std::vector<Peak>& peaks) const {
    const auto side = static_cast<int>(fourier_.side());
    const float per_cell = 1.0f / static_cast<float>(side * side);
    const auto value = [&](int x, int y) {
      const std::complex<float> v = sum[cell(x, y)];
      return imaginary ? v.imag() : v.real();
    };
    std::vector<Peak> found;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const float v = value(x, y);
        if (!(v > 0.0f) || value(x - 1, y) > v || value(x + 1, y) >= v || value(x, y - 1) > v || value(x, y + 1) >= v) {
          continue;
        }
        found.push_back({turn, centered(x, target_.width), centered(y, target_.height), v * per_cell});
      }
    }
    sort_peaks(found);
    found = distinct(found, n_turns_, kPeaksPerTurn);
    peaks.insert(peaks.end(), found.begin(), found.end());
  }

  /// Where a shift brings the source's center: of the two that the grid cannot tell apart the one that meets the
  /// target.
  int centered(int shift, int target_cells) const {
    const auto side = static_cast<int>(fourier_.side());
    const int place = shift + turned_.reach();
    return place - side > -turned_.reach() && 2 * place - side > target_cells ? place - side : place;
  }

  const ColumnMap& source_;
  const ColumnMap& target_;
  TurnedWords turned_;
  Channels channels_;
  Fourier2d fourier_;
  int n_turns_;
  std::vector<Grid> spectra_;
};

/// The shift in height that brings the grounds of the common cells together.
double height_between(const ColumnMap& source, const ColumnMap& target, const Eigen::Matrix3d& turn,
                      const Eigen::Vector2d& shift) {
  std::vector<float> differences;
  for (int y = 0; y < source.height; ++y) {
    for (int x = 0; x < source.width; ++x) {
      if (source.word_at(x, y) == ColumnMap::kEmpty) continue;
      const Eigen::Vector2d place = source.low_m + source.cell_m * Eigen::Vector2d(x + 0.5, y + 0.5);
      const Eigen::Vector2d cell = target.cell_at(turn.topLeftCorner<2, 2>() * place + shift);
      const int u = static_cast<int>(std::floor(cell.x())), v = static_cast<int>(std::floor(cell.y()));
      if (target.word_at(u, v) == ColumnMap::kEmpty) continue;
      differences.push_back(target.ground_at(u, v) - source.ground_at(x, y));
    }
  }
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return static_cast<double>(*middle);
}

}  // namespace

std::vector<ColumnPose> search_columns(const ColumnMap& source, const ColumnMap& target, const WordScores& scores,
                                       bool mirrored, std::size_t n_best) {
  const ColumnSearch search(source, target, scores, mirrored);
  std::vector<ColumnPose> poses;
  for (const Peak& peak : search.best(n_best)) {
    const double turn = search.turn_rad(peak.turn);
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R.topLeftCorner<2, 2>() << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    if (mirrored) R.col(0) *= -1.0;
    const Eigen::Vector2d center = target.low_m + target.cell_m * Eigen::Vector2d(peak.x + 0.5, peak.y + 0.5);
    const Eigen::Vector2d shift = center - R.topLeftCorner<2, 2>() * source.center();
    const double up = height_between(source, target, R, shift);
    ColumnPose pose;
    pose.score = static_cast<double>(peak.score);
    pose.local.rotation = target.upright.transpose() * R * source.upright;
    pose.local.translation = target.upright.transpose() * Eigen::Vector3d(shift.x(), shift.y(), up);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace cmap
