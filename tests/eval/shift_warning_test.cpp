#include "cmap/eval/shift_warning.hpp"

#include "eval/eval_testing.hpp"
#include "io/io_testing.hpp"

namespace cmap {
namespace shift_warning_test {

using cmap::testing::TempFolder;
using test::gray_map;
using test::options_for;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Ten meters, at `shift` beside the local ones.
PointCloud map_at(const Eigen::Vector3d& shift) {
  PointCloud map = gray_map({{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 2}});
  map.origin = shift;
  return map;
}

/// What is said of two maps and the files they came from.
std::vector<std::string> said(const PointCloud& reference, const PointCloud& estimate,
                              const std::filesystem::path& reference_file, const std::filesystem::path& estimate_file) {
  EvaluatedPair evaluation = evaluate(reference, estimate, options_for({"chamfer"}));
  warn_about_shifts(evaluation, reference_file, estimate_file);
  std::vector<std::string> messages;
  for (const Warning& warning : evaluation.warnings) {
    if (warning.id == "shift_found") messages.push_back(warning.message);
  }
  return messages;
}

const Eigen::Vector3d kPlace{651000, 6861000, 30};

struct Files : ::testing::Test {
  TempFolder folder;
  std::filesystem::path plain = folder.write("plain.xyz", "1 2 3\n");
  std::filesystem::path with_shift = folder.write("shifted.xyz", "# offset 651000 6861000 30\n1 2 3\n");
};

TEST_F(Files, TheEstimatesShiftIsAdded) {
  const auto messages = said(map_at(kPlace), map_at({0, 0, 0}), plain, with_shift);
  EXPECT_THAT(messages, Contains(AllOf(HasSubstr("shifted.xyz"), HasSubstr("--transform"),
                                       HasSubstr("1 0 0 651000 0 1 0 6861000 0 0 1 30 0 0 0 1"))));
}

TEST_F(Files, TheReferencesIsTakenOff) {
  EXPECT_THAT(said(map_at({0, 0, 0}), map_at(kPlace), with_shift, plain),
              Contains(HasSubstr("1 0 0 -651000 0 1 0 -6861000 0 0 1 -30 0 0 0 1")));
}

TEST_F(Files, ACommentMayNameWhatWasAdded) {
  EXPECT_THAT(said(map_at({0, 0, 0}), map_at(kPlace), plain, with_shift),
              Contains(HasSubstr("1 0 0 -651000 0 1 0 -6861000 0 0 1 -30 0 0 0 1")));
}

TEST_F(Files, AShiftThatDoesNotHelpIsNotNamed) {
  EXPECT_THAT(said(map_at(2 * kPlace), map_at({0, 0, 0}), plain, with_shift), ::testing::SizeIs(0));
  EXPECT_THAT(said(map_at({0, 0, 0}), map_at({0, 0, 0}), plain, with_shift), ::testing::SizeIs(0)) << "boxes meet";
}

TEST_F(Files, NothingIsSaidOfATransformThatWasGiven) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(0, 3) = 100;
  EvaluatedPair evaluation = evaluate(map_at(kPlace), map_at({0, 0, 0}), options_for({"chamfer"}), T);
  warn_about_shifts(evaluation, plain, with_shift);
  EXPECT_THAT(test::warning_ids(evaluation.warnings), Not(Contains("shift_found")));
}

}  // namespace shift_warning_test
}  // namespace cmap
