#include "html_tables.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <cmath>

#include "cmap/report/base64.hpp"
#include "cmap/report/embedded_file.hpp"
#include "cmap/report/table_text.hpp"

CMAP_EMBED(tables_style, CMAP_TABLES_PAGE "/tables.css")
CMAP_EMBED(tables_script, CMAP_TABLES_PAGE "/tables.js")

namespace cmap {
namespace {

/// How a content security policy names an inline script or style.
std::string policy_hash(std::string_view text) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest);
  return fmt::format("'sha256-{}'", base64(digest));
}

std::string policy() {
  return fmt::format(
      "default-src 'none'; script-src {}; style-src {}; img-src 'self' file: data:; base-uri 'none'; form-action "
      "'none'",
      policy_hash(tables_script()), policy_hash(tables_style()));
}

std::string heading_cell(const std::string& text, const char* kind) {
  return fmt::format("<th scope=\"col\" class=\"{}\">{}</th>", kind, escaped_html(text));
}

const char* look_of(const TableCell& cell) {
  switch (cell.mark) {
    case Mark::kBest:
      return "value best";
    case Mark::kSecond:
      return "value second";
    case Mark::kBestUntested:
      return "value untested";
    case Mark::kBetter:
      return "value better";
    case Mark::kWorse:
      return "value worse";
    case Mark::kNone:
      break;
  }
  return cell.value ? "value" : "value none";
}

std::string number_in_script(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : value > 0.0 ? "Infinity" : "-Infinity";
}

std::string value_cell(const TableCell& cell) {
  std::string attributes = fmt::format("class=\"{}\"", look_of(cell));
  if (cell.value) attributes += fmt::format(" data-value=\"{}\"", number_in_script(*cell.value));
  if (!cell.note.empty()) attributes += fmt::format(" title=\"{}\"", escaped_html(cell.note));
  const std::string band =
      cell.band.empty() ? "" : fmt::format(" <span class=\"band\">{}</span>", escaped_html(cell.band));
  return fmt::format("<td {}>{}{}</td>", attributes, escaped_html(cell.text), band);
}

}  // namespace

HtmlPage::HtmlPage(std::string_view title) : title_(escaped_html(title)) {
  body_ = fmt::format("<h1>{}</h1>\n", title_);
}

void HtmlPage::add_heading(std::string_view text, std::string_view id) {
  body_ +=
      fmt::format("<h2{}>{}</h2>\n", id.empty() ? "" : fmt::format(" id=\"{}\"", escaped_html(id)), escaped_html(text));
}

void HtmlPage::add_paragraph(std::string_view text) {
  body_ += fmt::format("<p class=\"note\">{}</p>\n", escaped_html(text));
}

void HtmlPage::add_key(std::string_view text, bool is_plain) {
  body_ += fmt::format(
      "<p class=\"note key\"><span class=\"best\">best</span><span class=\"second\">second best</span>{}{}</p>\n",
      is_plain ? "" : "<span class=\"untested\">best by value alone, not tested</span>", escaped_html(text));
}

void HtmlPage::add_table(const ScoreTable& table) {
  body_ += fmt::format("<div class=\"frame\"><table id=\"{}\">", escaped_html(table.id));
  if (!table.title.empty()) body_ += fmt::format("<caption>{}</caption>", escaped_html(table.title));
  body_ += "<thead><tr>";
  for (const std::string& column : table.head_columns) body_ += heading_cell(column, "head");
  for (const std::string& column : table.value_columns) body_ += heading_cell(column, "value");
  body_ += "</tr></thead>\n<tbody>\n";
  for (const TableRow& row : table.rows) {
    body_ += "<tr>";
    for (const std::string& head : row.heads) {
      const bool names_row = &head == &row.heads.front();
      body_ += names_row ? "<th scope=\"row\">" : "<td class=\"head\">";
      body_ += escaped_html(head);
      body_ += names_row ? "</th>" : "</td>";
    }
    for (const TableCell& cell : row.cells) body_ += value_cell(cell);
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table>";
  for (const std::string& note : table.notes) body_ += fmt::format("<p class=\"note\">{}</p>", escaped_html(note));
  body_ += "</div>\n";
}

std::string HtmlPage::finish() const {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n<script>{}</script>\n</body>\n</html>\n",
      policy(), title_, tables_style(), body_, tables_script());
}

}  // namespace cmap
