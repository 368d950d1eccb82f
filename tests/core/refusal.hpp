#pragma once

#include <string>

namespace cmap::test {

/// What an action says when it refuses with this kind of error; empty if it does not refuse.
template <class Error, class Action>
std::string refusal_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace cmap::test
