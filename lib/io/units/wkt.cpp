#include "units/wkt.hpp"

#include <algorithm>
#include <cctype>

namespace cmap {
namespace {

// Real coordinate systems nest about ten deep.
constexpr int kMaxDepth = 40;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool is_word_character(char c) { return !is_space(c) && std::string_view(",[]()\"").find(c) == std::string_view::npos; }

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  /// Items between commas up to a closing bracket or the end, as values and children of `parent`.
  bool items(WktNode& parent, int depth) {
    for (;;) {
      if (!item(parent, depth)) return false;
      if (!take(',')) return true;
    }
  }
  bool at_end() {
    skip_blanks();
    return text_.empty();
  }

 private:
  bool item(WktNode& parent, int depth) {
    skip_blanks();
    if (take('"')) return quoted(parent.values.emplace_back());
    std::string word(text_.begin(), std::ranges::find_if_not(text_, is_word_character));
    if (word.empty()) return false;
    text_.remove_prefix(word.size());
    const bool square = take('[');
    if (!square && !take('(')) {
      parent.values.push_back(std::move(word));
      return true;
    }
    if (depth == kMaxDepth) return false;
    std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::toupper(c); });
    WktNode& node = parent.children.emplace_back();
    node.keyword = std::move(word);
    return items(node, depth + 1) && take(square ? ']' : ')');
  }

  /// The rest of a text after its opening quote; a doubled quote stands for one.
  bool quoted(std::string& value) {
    for (;;) {
      const std::size_t quote = text_.find('"');
      if (quote == text_.npos) return false;
      value += text_.substr(0, quote);
      text_.remove_prefix(quote + 1);
      if (!text_.starts_with('"')) return true;
      value += '"';
      text_.remove_prefix(1);
    }
  }

  bool take(char c) {
    skip_blanks();
    if (!text_.starts_with(c)) return false;
    text_.remove_prefix(1);
    return true;
  }
  void skip_blanks() {
    while (!text_.empty() && is_space(text_.front())) text_.remove_prefix(1);
  }

  std::string_view text_;
};

bool contains(std::initializer_list<std::string_view> words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

}  // namespace

bool WktNode::is(std::initializer_list<std::string_view> keywords) const { return contains(keywords, keyword); }

const WktNode* WktNode::child(std::initializer_list<std::string_view> keywords) const {
  const auto found = std::ranges::find_if(children, [&](const WktNode& node) { return node.is(keywords); });
  return found == children.end() ? nullptr : &*found;
}

std::optional<std::vector<WktNode>> parse_wkt(std::string_view text) {
  Parser parser(text);
  WktNode root;
  if (!parser.items(root, 0) || !parser.at_end()) return std::nullopt;
  return std::move(root.children);
}

}  // namespace cmap
