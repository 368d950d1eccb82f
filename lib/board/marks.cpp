#include <algorithm>
#include <iterator>

#include "score_table.hpp"

namespace cmap {

void mark_best(const std::vector<TableCell*>& cells, std::string_view better) {
  if (better != "lower" && better != "higher") return;
  std::vector<TableCell*> ranked;  // the best first
  std::ranges::copy_if(cells, std::back_inserter(ranked),
                       [](const TableCell* cell) { return cell->value.has_value(); });
  if (ranked.size() < 2) return;
  const double sign = better == "lower" ? 1.0 : -1.0;
  std::ranges::stable_sort(ranked, {}, [&](const TableCell* cell) { return sign * *cell->value; });
  std::size_t n_better = 0;  // different texts before this one
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    if (i > 0 && ranked[i]->text != ranked[i - 1]->text) ++n_better;
    ranked[i]->mark = n_better == 0 ? Mark::kBest : n_better == 1 ? Mark::kSecond : Mark::kNone;
  }
}

void mark_columns(ScoreTable& table, std::string_view better) {
  for (std::size_t column = 0; column < table.value_columns.size(); ++column) {
    std::vector<TableCell*> cells;
    for (TableRow& row : table.rows) cells.push_back(&row.cells[column]);
    mark_best(cells, better);
  }
}

}  // namespace cmap
