#pragma once

#include <string>

namespace cmap {

/// Something a user should know about a result that stands all the same.
struct Warning {
  std::string id;  ///< stable, for programs: "rotation_not_orthonormal"
  std::string message;
};

}  // namespace cmap
