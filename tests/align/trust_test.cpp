#include "cmap/align/trust.hpp"

#include "align/align_testing.hpp"

namespace cmap {
namespace trust_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Alignment judged(Verdict verdict) {
  Alignment alignment;
  alignment.judgment.verdict = verdict;
  alignment.judgment.reason = "because of that";
  alignment.judgment.help = "try this";
  return alignment;
}

Alignment weak(double standard_error_m) {
  Alignment alignment = judged(Verdict::kWeak);
  alignment.judgment.weak = {{"translation along (1.00, 0.00, 0.00)", standard_error_m},
                             {"rotation about (0.00, 0.00, 1.00)", 0.5 * standard_error_m}};
  return alignment;
}

std::vector<std::string> warnings_of(Alignment alignment, const TrustRule& rule = {}) {
  require_trust(alignment, rule);
  return alignment.warnings;
}

TEST(RequireTrust, OfWhatIsDeterminedNothingIsSaid) {
  for (const Verdict verdict : {Verdict::kNotJudged, Verdict::kDetermined}) {
    EXPECT_THAT(warnings_of(judged(verdict)), ElementsAre());
  }
}

TEST(RequireTrust, TheOthersEndWithTheReasonAndWhatWouldHelp) {
  for (const Verdict verdict : {Verdict::kAmbiguous, Verdict::kUnsupported, Verdict::kMirrored}) {
    const std::string name(name_of(verdict, verdict_names()));
    EXPECT_EQ(test::refusal_of<UnsupportedError>([&] { warnings_of(judged(verdict)); }),
              "the alignment is " + name + ": because of that; try this; --allow-unconverged takes it all the same");
    EXPECT_THAT(warnings_of(judged(verdict), {.allow_unconverged = true}),
                ElementsAre("the alignment is " + name + ": because of that; try this"));
  }
}

TEST(RequireTrust, WeakDirectionsWarnBelowTheLargestThresholdOnly) {
  EXPECT_THAT(
      warnings_of(weak(0.1), {.largest_error_m = 0.2}),
      ElementsAre(HasSubstr("translation along (1.00, 0.00, 0.00) is only weakly determined: standard error 0.1"),
                  HasSubstr("rotation about (0.00, 0.00, 1.00)")));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([] { warnings_of(weak(0.2), {.largest_error_m = 0.2}); }),
              HasSubstr("weak: translation along (1.00, 0.00, 0.00) is only weakly determined: standard error 0.2 m, "
                        "and no more than 0.2 m is accepted; try this"));
  EXPECT_EQ(warnings_of(weak(0.2), {.allow_unconverged = true, .largest_error_m = 0.2}).size(), 3U);
  EXPECT_EQ(warnings_of(weak(1e9)).size(), 2U) << "without a limit";
}

TEST(VerdictLines, SayEverything) {
  EXPECT_EQ(verdict_lines(judged(Verdict::kNotJudged)), "");
  EXPECT_EQ(verdict_lines(judged(Verdict::kDetermined)),
            "verdict     determined   because of that\nhelp        try this\n");
  Alignment alignment = weak(0.125);
  RivalPose rival;
  rival.T_dst_src.topLeftCorner<3, 3>() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  rival.T_dst_src(1, 3) = 3.0;
  rival.score = 0.75;
  alignment.judgment.rivals = {rival};
  const std::string text = verdict_lines(alignment);
  EXPECT_THAT(text, HasSubstr("\nrival       score 0.75, turned 90.0 degrees about (0.00, 0.00, 1.00) from this one, "
                              "translation 3 m from its\n"));
  EXPECT_THAT(text, HasSubstr("\nweak        translation along (1.00, 0.00, 0.00), standard error 0.125 m\n"));
}

}  // namespace trust_test
}  // namespace cmap
