#include <fmt/format.h>

#include "leaderboard_tables.hpp"

namespace cmap {
namespace {

std::vector<ScoreTable> tables_of(const LeaderboardScores& scores, bool headlines_only) {
  std::vector<ScoreTable> tables;
  for (const ScoreSection& section : scores.sections) {
    const bool is_shown = !headlines_only || section.kind.headline || section.published;
    if (is_shown) tables.push_back(section.computed);
    if (section.published) tables.push_back(*section.published);
  }
  if (scores.registration) tables.push_back(*scores.registration);
  return tables;
}

/// Tables that are read together say together how much their rankings say: the notes do.
void remove_notes(std::vector<ScoreTable>& tables) {
  for (ScoreTable& table : tables) table.notes.clear();
}

std::string typeset_with_notes(std::vector<ScoreTable> tables, const std::vector<std::string>& notes,
                               TableFormat format) {
  if (format != TableFormat::kLatex) remove_notes(tables);
  std::vector<std::string>& last = tables.back().notes;
  last.insert(last.end(), notes.begin(), notes.end());
  return typeset(tables, format);
}

std::vector<std::string> with_marks(TableFormat format, const LeaderboardLook& look, std::vector<std::string> notes) {
  notes.insert(notes.begin(),
               fmt::format("of each column: {}; {} or no map, {} failed", marks_note(format, look.plain_ranking),
                           missing_note(format), format == TableFormat::kLatex ? "×" : kFailedMark));
  return notes;
}

}  // namespace

LeaderboardDocuments typeset_leaderboard(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                                         const LeaderboardLook& look) {
  const LeaderboardScores scores = leaderboard_scores(manifest, pairs, look);
  const std::vector<std::string> notes = leaderboard_notes(manifest, pairs, scores);
  const std::vector<ScoreTable> tables = tables_of(scores, false);
  std::vector<ScoreTable> latex_tables = tables;
  if (!look.bands) remove_bands(latex_tables);
  const auto noted = [&](std::vector<ScoreTable> of, TableFormat format) {
    return typeset_with_notes(std::move(of), with_marks(format, look, notes), format);
  };
  LeaderboardDocuments documents;
  documents.markdown = noted(tables, TableFormat::kMarkdown);
  documents.latex = noted(std::move(latex_tables), TableFormat::kLatex);
  documents.csv = leaderboard_csv(manifest, pairs, scores);
  documents.html = leaderboard_html(manifest, pairs, scores, look);
  documents.text = noted(tables_of(scores, true), TableFormat::kText);
  return documents;
}

}  // namespace cmap
