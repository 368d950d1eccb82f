#pragma once

#include <string>
#include <string_view>

#include "score_table.hpp"

namespace cmap {

/// One HTML page of tables that readers sort by mouse and keyboard. It needs no other file: style and script stand in
/// it, no other may run, and nothing is fetched but pictures beside it.
class HtmlPage {
 public:
  explicit HtmlPage(std::string_view title);

  void add_heading(std::string_view text, std::string_view id = "");
  void add_paragraph(std::string_view text);
  /// What the marks look like, and what they are about; all by value alone where `is_plain`.
  void add_key(std::string_view text, bool is_plain);
  void add_table(const ScoreTable& table);
  /// Markup, as it is.
  void add(std::string_view markup) { body_ += markup; }

  std::string finish() const;

 private:
  std::string title_, body_;
};

}  // namespace cmap
