#pragma once

// How well descriptors alone, without poses, tell places that were seen before.

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cmap/core/parallel.hpp"

namespace cmap::benchmark {

/// What a method says of one place: the earlier place most like it.
struct Answer {
  std::size_t place = 0;
  double score = -std::numeric_limits<double>::infinity();  ///< higher: more alike
  bool right = false;                                       ///< it is the same place
  bool is_revisit = false;                                  ///< there is an earlier one that is
};

/// Everything that a threshold on the score gives.
struct Curve {
  struct Point {
    double threshold, precision, recall;
  };
  std::vector<Point> points;  ///< by falling threshold
  double recall_at_full_precision = 0.0;
  double best_f1 = 0.0;
  double area = 0.0;  ///< under precision over recall
};

/// Recall: of the places that are revisits, those found; precision: of the answers given, those right.
inline Curve curve_of(std::vector<Answer> answers) {
  std::erase_if(answers, [](const Answer& a) { return a.score == -std::numeric_limits<double>::infinity(); });
  std::stable_sort(answers.begin(), answers.end(), [](const Answer& a, const Answer& b) { return a.score > b.score; });
  const auto n_revisits =
      static_cast<double>(std::count_if(answers.begin(), answers.end(), [](const Answer& a) { return a.is_revisit; }));
  Curve curve;
  double right = 0.0, given = 0.0, last_recall = 0.0;
  for (const Answer& answer : answers) {
    given += 1.0;
    right += answer.right ? 1.0 : 0.0;
    const double precision = right / given, recall = right / n_revisits;
    curve.points.push_back({answer.score, precision, recall});
    if (precision == 1.0) curve.recall_at_full_precision = recall;
    curve.best_f1 = std::max(curve.best_f1, 2.0 * precision * recall / (precision + recall + 1e-12));
    curve.area += precision * (recall - last_recall);
    last_recall = recall;
  }
  return curve;
}

/// Of every place, the earlier one with the highest score(earlier, place) among those that may be asked about.
inline std::vector<Answer> answers_by(std::size_t n, const std::function<bool(std::size_t, std::size_t)>& may_ask,
                                      const std::function<bool(std::size_t, std::size_t)>& is_same,
                                      const std::function<double(std::size_t, std::size_t)>& score) {
  std::vector<Answer> answers(n);
  parallel_chunks(n, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t to = begin; to < end; ++to) {
      Answer& answer = answers[to];
      for (std::size_t from = 0; from < to; ++from) {
        if (!may_ask(from, to)) continue;
        answer.is_revisit |= is_same(from, to);
        const double s = score(from, to);
        if (s > answer.score) answer.score = s, answer.place = from;
      }
      answer.right = answer.is_revisit && is_same(answer.place, to);
    }
  });
  return answers;
}

}  // namespace cmap::benchmark
