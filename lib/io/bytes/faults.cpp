#include "cmap/io/faults.hpp"

#include "cmap/core/error.hpp"

namespace cmap {

bool Faults::attempt(const std::function<void()>& read) const {
  if (list_ == nullptr) {
    read();
    return true;
  }
  try {
    read();
    return true;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    list_->push_back(error.what());
    return false;
  }
}

}  // namespace cmap
