#include "cmap/align/verdict.hpp"

namespace cmap {

const EnumNames<Verdict>& verdict_names() {
  static const EnumNames<Verdict> names{
      {Verdict::kNotJudged, "not judged"}, {Verdict::kDetermined, "determined"},   {Verdict::kWeak, "weak"},
      {Verdict::kAmbiguous, "ambiguous"},  {Verdict::kUnsupported, "unsupported"}, {Verdict::kMirrored, "mirrored"}};
  return names;
}

bool is_trusted(Verdict verdict) {
  return verdict == Verdict::kNotJudged || verdict == Verdict::kDetermined || verdict == Verdict::kWeak;
}

}  // namespace cmap
