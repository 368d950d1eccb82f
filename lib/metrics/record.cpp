#include "cmap/metrics/record.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace cmap {
namespace {

const Number* number_named(const std::vector<Number>& numbers, std::string_view name) {
  const auto found = std::ranges::find(numbers, name, &Number::name);
  return found == numbers.end() ? nullptr : &*found;
}

/// The number at "3.name" of a list.
std::optional<double> number_in_list(const std::vector<Record>& list, std::string_view path) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), index);
  const auto used = static_cast<std::size_t>(end - path.data());
  if (error != std::errc() || index >= list.size() || used == path.size() || path[used] != '.') return std::nullopt;
  return list[index].number(path.substr(used + 1));
}

}  // namespace

Record& Record::add(std::string name, double number) {
  numbers.push_back({std::move(name), number});
  return *this;
}

Record& Record::add(std::string name, std::uint64_t count) {
  numbers.push_back({std::move(name), count});
  return *this;
}

Record& Record::add(std::string name, const char* word) {
  numbers.push_back({std::move(name), std::string(word)});
  return *this;
}

Record& Record::add(std::string name, std::vector<double> list) {
  numbers.push_back({std::move(name), std::move(list)});
  return *this;
}

Record& Record::add(std::string name, Record part) {
  parts.push_back({std::move(name), std::move(part)});
  return *this;
}

Record& Record::add(std::string name, std::vector<Record> list) {
  rows.push_back({std::move(name), std::move(list)});
  return *this;
}

const std::vector<Record>& Record::list(std::string_view name) const& {
  static const std::vector<Record> kNone;
  const auto found = std::ranges::find(rows, name, &RecordRows::name);
  return found == rows.end() ? kNone : found->rows;
}

std::vector<Record>& Record::list_to_change(std::string_view name) {
  const auto found = std::ranges::find(rows, name, &RecordRows::name);
  if (found == rows.end()) throw std::out_of_range("a record has no list " + std::string(name));
  return found->rows;
}

Record& Record::part_to_change(std::string_view name) {
  const auto found = std::ranges::find(parts, name, &NamedRecord::name);
  if (found == parts.end()) throw std::out_of_range("a record has no part " + std::string(name));
  return found->record;
}

const Record* Record::part(std::string_view name) const {
  const auto found = std::ranges::find(parts, name, &NamedRecord::name);
  return found == parts.end() ? nullptr : &found->record;
}

std::optional<double> Record::number(std::string_view path) const {
  const std::size_t dot = path.find('.');
  if (dot != path.npos) {
    const std::string_view first = path.substr(0, dot), rest = path.substr(dot + 1);
    if (const Record* inner = part(first)) return inner->number(rest);
    return number_in_list(list(first), rest);
  }
  if (path == "value") return value;
  const Number* found = number_named(numbers, path);
  if (found == nullptr) return std::nullopt;
  if (const auto* count = std::get_if<std::uint64_t>(&found->value)) return static_cast<double>(*count);
  if (const auto* number = std::get_if<double>(&found->value)) return *number;
  return std::nullopt;
}

}  // namespace cmap
