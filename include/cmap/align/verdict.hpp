#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cmap/core/enum_names.hpp"

namespace cmap {

/// Whether to believe an alignment.
enum class Verdict {
  kNotJudged,    ///< by this method
  kDetermined,   ///< one pose fits, and no other as well
  kWeak,         ///< determined but for some directions, which Judgment::weak names
  kAmbiguous,    ///< another pose fits as well: Judgment::rivals
  kUnsupported,  ///< too little in common to tell
  kMirrored,     ///< a reflection fits better: one of the two is in a left-handed frame
};

/// "not judged", "determined", "weak", "ambiguous", "unsupported", "mirrored".
const EnumNames<Verdict>& verdict_names();

/// A direction along which an alignment is uncertain.
struct WeakDirection {
  std::string name;               ///< "translation along (1.00, 0.00, 0.00)"
  double standard_error_m = 0.0;  ///< of a rotation, or the scale: what it moves the source's farthest corner by
};

/// Another answer to the same question.
struct RivalPose {
  Eigen::Matrix4d T_dst_src = Eigen::Matrix4d::Identity();
  double score = 0.0;
};

/// What is to be said of an alignment, and why.
struct Judgment {
  Verdict verdict = Verdict::kNotJudged;
  std::string reason;               ///< one sentence with its figures, without a full stop
  std::string help;                 ///< what would help: options by name; empty where nothing is to be helped
  double score = 0.0;               ///< share of what both can see that agrees at fine reach, 0 to 1
  std::vector<RivalPose> rivals;    ///< distinct other answers, the best first
  std::vector<WeakDirection> weak;  ///< the worst first
};

/// Whether to go on with it: determined, weak, or not judged.
bool is_trusted(Verdict verdict);

}  // namespace cmap
