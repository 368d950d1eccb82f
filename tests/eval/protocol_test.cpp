#include "cmap/eval/protocol.hpp"

#include <Eigen/Geometry>

#include "cmap/align/align.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace protocol_test {

using test::options_for;
using test::refusal_of;
using test::warning_ids;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Scale, a turn about no axis of the frame, a shift.
Eigen::Matrix4d similarity(double scale, double angle_deg, const Eigen::Vector3d& shift_m) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() =
      scale * Eigen::AngleAxisd(angle_deg * M_PI / 180.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T.topRightCorner<3, 1>() = shift_m;
  return T;
}

/// Relief in all directions, so that nothing slides in itself.
const PointCloud& map() {
  static const PointCloud cloud = [] {
    PointCloud relief = test::painted_sheet(20'000, 1);
    for (Eigen::Vector3f& p : relief.positions) p.z() += std::cos(1.3f * p.y());
    return relief;
  }();
  return cloud;
}

double value(const Evaluation& evaluation, const char* id) { return *evaluation.metrics.at(id).value; }

EvaluationOptions aligning(std::string_view method) {
  EvaluationOptions options = options_for({"chamfer", "color_distance"});
  options.align = test::aligner(method);
  options.align_voxel_m = 0.3;
  return options;
}

TEST(Protocol, WithoutAnAlignmentItIsThePlainEvaluation) {
  const Eigen::Matrix4d T = similarity(1.0, 1.0, {0.1, 0.2, 0.3});
  const EvaluationOptions options = options_for({"default"});
  const Evaluation found = evaluate_by_protocol(map(), map(), options, {.T_initial = T});
  const Evaluation plain = evaluate(map(), map(), options, T);
  EXPECT_EQ(test::fields_of(found.metrics), test::fields_of(plain.metrics));
  EXPECT_FALSE(found.alignment.has_value());
  EXPECT_TRUE(found.metrics_before.empty());
}

std::vector<std::string> names_from_a_start() {
  std::vector<std::string> names;
  for (const RegistrationMethod* method : registration_methods()) {
    if (method->needs_initial) names.emplace_back(method->name);
  }
  return names;
}

class EveryAlignment : public ::testing::TestWithParam<std::string> {};

/// A copy that was moved comes back: its scores are those of the map with itself, to 1e-4.
TEST_P(EveryAlignment, BringsAMovedCopyBack) {
  const PointCloud moved = transformed(map(), similarity(1.0, 1.0, {0.1, -0.05, 0.1}));
  const Evaluation found = evaluate_by_protocol(map(), moved, aligning(GetParam()));
  EXPECT_LT(value(found, "chamfer"), 1e-4);
  EXPECT_LT(value(found, "color_distance"), 1e-4);
  ASSERT_FALSE(found.metrics_before.empty());
  EXPECT_GT(*found.metrics_before.at("chamfer").value, 0.05) << "before, it was off";
  EXPECT_NEAR(found.alignment->scale, 1.0, 1e-4);
  EXPECT_THAT(warning_ids(found.warnings), Not(Contains("alignment_low_overlap")));
}

INSTANTIATE_TEST_SUITE_P(Protocol, EveryAlignment, ::testing::ValuesIn(names_from_a_start()));

TEST(Protocol, TheScaleErrorIsFound) {
  const PointCloud larger = transformed(map(), similarity(1.02, 0.0, {0, 0, 0}));
  const Evaluation found = evaluate_by_protocol(map(), larger, aligning("sim3"));
  EXPECT_NEAR(found.alignment->scale, 1.0 / 1.02, 1e-3);
}

Trajectory loop(const Eigen::Matrix4d& T_world, double time_shift_s = 0.0) {
  Trajectory trajectory;
  for (int i = 0; i < 40; ++i) {
    const double a = 0.1 * i;
    const Eigen::Vector4d p = T_world * Eigen::Vector4d(5 * std::cos(a), 3 * std::sin(a), std::sin(2 * a), 1.0);
    trajectory.push_back({a + time_shift_s, p.head<3>(), Eigen::Quaterniond::Identity()});
  }
  return trajectory;
}

TEST(Protocol, TrajectoriesAlignTheirMaps) {
  const Eigen::Matrix4d T_est_ref = similarity(0.5, 30.0, {4, 5, 6});
  const PointCloud moved = transformed(map(), T_est_ref);
  const ProtocolInputs inputs{.reference_trajectory = loop(Eigen::Matrix4d::Identity()),
                              .estimate_trajectory = loop(T_est_ref)};
  const Evaluation found = evaluate_by_protocol(map(), moved, aligning("trajectory"), inputs);
  EXPECT_LT(value(found, "chamfer"), 1e-4);
  EXPECT_NEAR(found.alignment->scale, 2.0, 1e-6);
}

TEST(Protocol, RefusesWhatCannotBeAligned) {
  EXPECT_THAT(refusal_of<UsageError>([] { evaluate_by_protocol(map(), map(), aligning("trajectory")); }),
              HasSubstr("needs the trajectories"));
  const ProtocolInputs apart{.reference_trajectory = loop(Eigen::Matrix4d::Identity()),
                             .estimate_trajectory = loop(Eigen::Matrix4d::Identity(), 1000.0)};
  EXPECT_THROW(evaluate_by_protocol(map(), map(), aligning("trajectory"), apart), UnsupportedError);
  const PointCloud far_away = transformed(map(), similarity(1.0, 0.0, {0, 0, 500}));
  EXPECT_THROW(evaluate_by_protocol(map(), far_away, aligning("gicp")), UnsupportedError);
}

/// A plane slides in itself: point to plane determines three directions of six.
TEST(Protocol, APlaneIsRefusedByDirection) {
  PointCloud plane = test::uniform_cloud(5000, 3);
  for (Eigen::Vector3f& p : plane.positions) p.z() = 0.0f;
  EvaluationOptions geometry = aligning("plane");
  geometry.metrics = {"chamfer"};
  const std::string says = refusal_of<UnsupportedError>([&] { evaluate_by_protocol(plane, plane, geometry); });
  EXPECT_THAT(says, ::testing::AnyOf(HasSubstr("translation along"), HasSubstr("rotation about")));
}

}  // namespace protocol_test
}  // namespace cmap
