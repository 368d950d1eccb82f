#pragma once

#include <functional>
#include <string>
#include <vector>

namespace cmap {

/// Where a reader of many parts takes what is wrong with one of them: by default it ends the reading, as an exception;
/// with a list, it is noted there and the other parts are read as well.
class Faults {
 public:
  Faults() = default;
  explicit Faults(std::vector<std::string>& list) : list_(&list) {}

  /// Whether it has a list.
  bool goes_on() const { return list_ != nullptr; }
  /// Reads a part; whether nothing was wrong with it.
  bool attempt(const std::function<void()>& read) const;

 private:
  std::vector<std::string>* list_ = nullptr;
};

}  // namespace cmap
