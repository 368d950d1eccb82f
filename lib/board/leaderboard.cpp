#include "leaderboard_tables.hpp"

namespace cmap {
namespace {

std::vector<ScoreTable> tables_of(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                                  bool headlines_only) {
  std::vector<ScoreTable> tables;
  for (const ScoreSection& section : leaderboard_sections(manifest, pairs)) {
    const bool is_shown = !headlines_only || section.kind.headline || section.published;
    if (is_shown) tables.push_back(section.computed);
    if (section.published) tables.push_back(*section.published);
  }
  if (const std::optional<ScoreTable> registration = registration_table(manifest)) tables.push_back(*registration);
  return tables;
}

std::string typeset_with_notes(std::vector<ScoreTable> tables, std::vector<std::string> notes, TableFormat format) {
  tables.back().notes = std::move(notes);
  return typeset(tables, format);
}

}  // namespace

LeaderboardDocuments typeset_leaderboard(const LeaderboardManifest& manifest,
                                         const std::vector<LeaderboardPair>& pairs) {
  const std::vector<ScoreTable> tables = tables_of(manifest, pairs, false);
  std::vector<std::string> notes = leaderboard_notes(manifest, pairs);
  LeaderboardDocuments documents;
  documents.markdown = typeset_with_notes(tables, notes, TableFormat::kMarkdown);
  documents.latex = typeset_with_notes(tables, notes, TableFormat::kLatex);
  documents.csv = leaderboard_csv(manifest, pairs);
  documents.html = leaderboard_html(manifest, pairs);
  notes.insert(notes.begin(), "* best, + second best of the column; - no value or no map, x failed");
  documents.text = typeset_with_notes(tables_of(manifest, pairs, true), notes, TableFormat::kText);
  return documents;
}

}  // namespace cmap
