#include <fmt/format.h>

#include "cmap/eval/metric_catalog.hpp"
#include "cmap/report/file_names.hpp"
#include "cmap/report/parameters.hpp"
#include "html_tables.hpp"
#include "leaderboard_tables.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// A path below the page as an address.
std::string address(const std::string& path) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.~/()";
  std::string text;
  for (char c : path) {
    text += kPlain.find(c) != kPlain.npos ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

std::string link(const LeaderboardPair& pair, const char* file, const char* text) {
  return fmt::format("<a href=\"{}/{}\">{}</a>", address(pair.folder), file, text);
}

std::string map_cell(const LeaderboardPair& pair) {
  if (pair.state != PairState::kDone) {
    return fmt::format("<td class=\"none\" title=\"{}\">{}</td>", escaped_html(with_file_names(pair.reason)),
                       pair.state == PairState::kFailed ? "failed" : "missing");
  }
  return fmt::format("<td>{} · {}{}</td>", link(pair, "report.html", "report"), link(pair, "report.json", "JSON"),
                     pair.has_figure ? " · " + link(pair, "figure.png", "picture") : "");
}

/// Which map is where, and what became of it.
void add_maps(HtmlPage& page, const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs) {
  page.add_heading("Maps", "maps");
  page.add("<div class=\"frame\"><table id=\"pairs\"><thead><tr><th scope=\"col\">method</th>");
  for (const LeaderboardSequence& sequence : manifest.sequences) {
    page.add(fmt::format("<th scope=\"col\">{}</th>", escaped_html(sequence.name)));
  }
  page.add("</tr></thead>\n<tbody>\n");
  const std::size_t n_methods = manifest.methods.size();
  for (std::size_t m = 0; m < n_methods; ++m) {
    page.add(fmt::format("<tr><th scope=\"row\">{}</th>", escaped_html(manifest.methods[m].name)));
    for (std::size_t s = 0; s < manifest.sequences.size(); ++s) page.add(map_cell(pairs[s * n_methods + m]));
    page.add("</tr>\n");
  }
  page.add("</tbody></table></div>\n");
}

void add_gallery(HtmlPage& page, const std::vector<LeaderboardPair>& pairs) {
  std::string figures;
  for (const LeaderboardPair& pair : pairs) {
    if (!pair.has_figure) continue;
    const std::string name = escaped_html(fmt::format("{} / {}", pair.sequence, pair.method));
    figures += fmt::format(
        "<figure><a href=\"{0}/report.html\"><img loading=\"lazy\" width=\"1600\" height=\"1000\" "
        "src=\"{0}/figure.png\" "
        "alt=\"Maps and errors of {1}\"></a><figcaption>{1}</figcaption></figure>\n",
        address(pair.folder), name);
  }
  if (figures.empty()) return;
  page.add_heading("Pictures", "pictures");
  page.add(fmt::format("<div class=\"gallery\">\n{}</div>\n", figures));
}

std::string group_of(const ScoreSection& section) {
  const MetricInfo* info = find_metric(section.kind.metric);
  const std::string_view group = info == nullptr ? "other" : info->group;
  std::string title(group == "mme" ? "entropy" : group == "color+" ? "color, beyond the paper" : group);
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

/// One heading for each group of metrics; what was published stands beside what was computed.
void add_sections(HtmlPage& page, const std::vector<ScoreSection>& sections) {
  std::string group;
  for (const ScoreSection& section : sections) {
    if (group_of(section) != group) {
      if (!group.empty()) page.add("</div>\n");
      group = group_of(section);
      page.add_heading(group);
      page.add("<div class=\"tables\">\n");
    }
    page.add(fmt::format("<div class=\"tables\" id=\"{}\">\n", escaped_html(section.kind.id())));
    page.add_table(section.computed);
    if (section.published) page.add_table(*section.published);
    page.add("</div>\n");
  }
  if (!group.empty()) page.add("</div>\n");
}

void add_navigation(HtmlPage& page, const std::vector<ScoreSection>& sections) {
  page.add("<nav aria-label=\"Metrics\">\n");
  std::string metric;
  for (const ScoreSection& section : sections) {
    if (section.kind.metric == metric) continue;
    metric = section.kind.metric;
    page.add(fmt::format("<a href=\"#{}\">{}</a>\n", escaped_html(section.kind.id()),
                         escaped_html(heading_of(section.kind))));
  }
  page.add("<a href=\"#maps\">Maps</a>\n</nav>\n");
}

void add_parameters(HtmlPage& page, const EvaluationOptions& options) {
  page.add_heading("Parameters");
  const Json parameters = to_json(options);
  std::string text;
  for (const auto& [name, value] : parameters.items()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value.dump());
  }
  page.add_paragraph(with_file_names(text));
}

}  // namespace

std::string leaderboard_html(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                             const LeaderboardScores& scores, const LeaderboardLook& look) {
  HtmlPage page("Leaderboard of maps");
  page.add_key("of each column; - no value or no map, x failed. Every table sorts by its headings.",
               look.plain_ranking);
  add_navigation(page, scores.sections);
  add_sections(page, scores.sections);
  if (scores.registration) {
    page.add_heading("Registration", "registration");
    page.add_table(*scores.registration);
  }
  add_maps(page, manifest, pairs);
  add_gallery(page, pairs);
  page.add_heading("Notes");
  for (const std::string& note : leaderboard_notes(manifest, pairs, scores)) page.add_paragraph(note);
  add_parameters(page, manifest.options);
  return page.finish();
}

}  // namespace cmap
