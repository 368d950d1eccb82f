#include <algorithm>

#include "score_table.hpp"

namespace cmap {

std::vector<std::size_t> ranked_cells(const std::vector<TableCell*>& cells, std::string_view better) {
  std::vector<std::size_t> ranked;
  if (better != "lower" && better != "higher") return ranked;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i]->value) ranked.push_back(i);
  }
  const double sign = better == "lower" ? 1.0 : -1.0;
  std::ranges::stable_sort(ranked, {}, [&](std::size_t i) { return sign * *cells[i]->value; });
  return ranked;
}

void mark_best(const std::vector<TableCell*>& cells, std::string_view better) {
  const std::vector<std::size_t> ranked = ranked_cells(cells, better);
  if (ranked.size() < 2) return;
  std::size_t n_better = 0;  // different texts before this one
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    TableCell& cell = *cells[ranked[i]];
    if (i > 0 && cell.text != cells[ranked[i - 1]]->text) ++n_better;
    cell.mark = n_better == 0 ? Mark::kBest : n_better == 1 ? Mark::kSecond : Mark::kNone;
  }
}

std::vector<TableCell*> cells_of(TableRow& row) {
  std::vector<TableCell*> cells;
  for (TableCell& cell : row.cells) cells.push_back(&cell);
  return cells;
}

std::vector<TableCell*> cells_of(ScoreTable& table, std::size_t column) {
  std::vector<TableCell*> cells;
  for (TableRow& row : table.rows) cells.push_back(&row.cells[column]);
  return cells;
}

void remove_bands(std::vector<ScoreTable>& tables) {
  for (ScoreTable& table : tables) {
    for (TableRow& row : table.rows) {
      for (TableCell& cell : row.cells) cell.band.clear();
    }
  }
}

}  // namespace cmap
