#pragma once

#include <limits>
#include <string>

#include "cmap/align/alignment.hpp"

namespace cmap {

/// What an alignment must be, for whoever goes on with it.
struct TrustRule {
  bool allow_unconverged = false;  ///< take it whatever its verdict, with a warning
  /// A weak direction whose standard error reaches this is not trusted: the largest threshold that is to be scored.
  double largest_error_m = std::numeric_limits<double>::infinity();
};

/// Puts what the verdict says into the alignment's warnings: each weak direction, and, where it is allowed, that the
/// alignment is not to be trusted. Throws UnsupportedError with the reason and what would help where it is neither
/// trusted nor allowed.
void require_trust(Alignment& alignment, const TrustRule& rule);

/// The verdict for people, one line each with a name of at most 11 letters before it: the verdict and its reason,
/// rivals, weak directions and what would help. Empty where nothing was judged.
std::string verdict_lines(const Alignment& alignment);

}  // namespace cmap
