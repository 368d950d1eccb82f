#include "cmap/geometry/camera_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "cmap/core/error.hpp"

#ifdef CMAP_TEST_WITH_OPENCV
#include <opencv2/calib3d.hpp>
#endif

namespace cmap {
namespace camera_model_test {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CameraModel camera(CameraProjection projection, std::vector<double> distortion) {
  return {projection, 1280, 1024, 700.0, 690.0, 626.9, 522.8, std::move(distortion)};
}

/// Lenses as they are sold: FAST-LIVO2's, MARS-LVIG's (AMvalley), opencalib's, a rational one, MUN-FRL's fisheye.
std::vector<CameraModel> lenses() {
  using enum CameraProjection;
  return {
      camera(kPinhole, {}),
      camera(kPinhole, {-.07616, .123001, -.00113, .000251}),
      {kPinhole, 2448, 2048, 1453.88, 1452.85, 1182.53, 1045.82, {-.052, .1168, .0015, .00013, -.068564}},
      {kPinhole, 1920, 1200, 2117.31, 2113.29, 924.681, 656.457, {-.102933, -.040925, .00057951, -.00419933, .429959}},
      camera(kPinhole, {.8, .12, .0004, -.0003, .01, 1.1, .35, .03}),
      camera(kFisheye, {}),
      camera(kFisheye, {-.07937700, .02228435, -.03852023, .01346873})};
}

TEST(CameraModel, PinholeOfAHandComputedPoint) {
  const CameraModel plain = camera(CameraProjection::kPinhole, {});
  EXPECT_EQ(*project(plain, {0.5, -1.0, 2.0}), Vector2d(0.25 * 700.0 + 626.9, -0.5 * 690.0 + 522.8));
  // x = 0.5, y = 0, r^2 = 1/4: radial 1 + 0.4/4 + 0.16/16 + 0.64/64 = 1.12; 3 p2 x^2 = 0.0075; p1 r^2 = 0.005.
  const CameraModel lens = camera(CameraProjection::kPinhole, {.4, .16, .02, .01, .64});
  EXPECT_TRUE(project(lens, {1.0, 0.0, 2.0})->isApprox(Vector2d(0.5675 * 700.0 + 626.9, 0.005 * 690.0 + 522.8), 1e-15));
}

TEST(CameraModel, FisheyeOfAHandComputedPoint) {
  constexpr double kRight = std::numbers::pi / 2;
  const CameraModel plain = camera(CameraProjection::kFisheye, {});
  EXPECT_TRUE(project(plain, {3.0, 0.0, 0.0})->isApprox(Vector2d(kRight * 700.0 + 626.9, 522.8), 1e-15));
  // Behind, at 135 degrees.
  EXPECT_TRUE(project(plain, {0.0, 1.0, -1.0})->isApprox(Vector2d(626.9, 1.5 * kRight * 690.0 + 522.8), 1e-15));
  EXPECT_FALSE(project(plain, {0.0, 0.0, -1.0}).has_value());
}

TEST(CameraModel, NothingBehindAPinhole) {
  for (const CameraModel& lens : lenses()) {
    EXPECT_EQ(*project(lens, Vector3d::UnitZ()), Vector2d(lens.cx, lens.cy));
    EXPECT_FALSE(project(lens, {0.0, 0.0, 0.0}).has_value());
    EXPECT_FALSE(project(lens, {kInfinity, 0.0, 1.0}).has_value());
    if (lens.projection == CameraProjection::kPinhole) {
      EXPECT_FALSE(project(lens, {1.0, 0.0, 0.0}).has_value());
      EXPECT_FALSE(project(lens, {0.1, 0.1, -1.0}).has_value());
    }
  }
}

TEST(CameraModel, RayAndProjectionAreInversesAllOverTheImage) {
  for (const CameraModel& lens : lenses()) {
    SCOPED_TRACE(::testing::PrintToString(lens.distortion));
    for (int v = 0; v < lens.height; v += 31) {
      for (int u = 0; u < lens.width; u += 31) {
        const Vector3d ray = ray_of(lens, {u, v});
        ASSERT_NEAR(ray.norm(), 1.0, 1e-15);
        const auto pixel = project(lens, 7.5 * ray);
        ASSERT_TRUE(pixel.has_value());
        ASSERT_LT((*pixel - Vector2d(u, v)).norm(), 1e-9);
      }
    }
  }
}

/// x (1 - x^2 / 3) turns back at x = 1, where it is 2/3.
TEST(CameraModel, BeyondTheFoldOfAPinholeThereIsNothing) {
  const CameraModel lens = camera(CameraProjection::kPinhole, {-1.0 / 3.0, 0, 0, 0});
  EXPECT_TRUE(project(lens, {0.999, 0.0, 1.0}).has_value());
  EXPECT_FALSE(project(lens, {1.001, 0.0, 1.0}).has_value());
  const auto ray_at = [&](double x) { return ray_of(lens, {x * lens.fx + lens.cx, lens.cy}); };
  EXPECT_TRUE(ray_at(0.6666).allFinite());
  EXPECT_TRUE(ray_at(0.6668).array().isNaN().all());
  EXPECT_TRUE(ray_at(-2.0).array().isNaN().all());
  // Close to the fold Newton's method from the image of the point goes astray; 1e-4 before it is 0.9898 or so.
  const Vector3d ray = ray_at(2.0 / 3.0 - 1e-4);
  EXPECT_LT((*project(lens, ray) - Vector2d((2.0 / 3.0 - 1e-4) * lens.fx + lens.cx, lens.cy)).norm(), 1e-9);
}

/// x (1 - x^2 + x^4 / 3 ...) may fold and rise again: what lies on the second rise has the image of something nearer.
TEST(CameraModel, TheSecondRiseOfALensIsBeyondItsFold) {
  // 1 - 3 s + 2 s^2 is negative for s in (1/2, 1): k1 = -1, k2 = 0.4.
  const CameraModel pinhole = camera(CameraProjection::kPinhole, {-1.0, 0.4, 0, 0});
  EXPECT_TRUE(project(pinhole, {0.70, 0.0, 1.0}).has_value());
  for (const double x : {0.72, 0.9, 1.2, 3.0, 100.0}) EXPECT_FALSE(project(pinhole, {x, 0.0, 1.0}).has_value()) << x;
  const CameraModel fisheye = camera(CameraProjection::kFisheye, {-1.0, 0.4, 0, 0});
  EXPECT_TRUE(project(fisheye, {std::tan(0.70), 0.0, 1.0}).has_value());
  for (const double a : {0.72, 1.2, 2.0}) EXPECT_FALSE(project(fisheye, {std::sin(a), 0, std::cos(a)}).has_value());
}

TEST(CameraModel, PastAPoleOfARationalLensThereIsNothing) {
  const CameraModel lens = camera(CameraProjection::kPinhole, {0, 0, 0, 0, 0, -1.0, 0, 0});  // x / (1 - x^2)
  EXPECT_NEAR(project(lens, {0.5, 0, 1})->x(), 0.5 / 0.75 * lens.fx + lens.cx, 1e-12);
  EXPECT_FALSE(project(lens, {1.5, 0.0, 1.0}).has_value());
  EXPECT_NEAR(project(lens, ray_of(lens, {1e6, lens.cy}))->x(), 1e6, 1e-6);
}

/// A brute-force oracle of the fold: the radial curve sampled densely.
TEST(CameraModel, FoldIsWhereTheSampledCurveStopsRising) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coefficient(-1.0, 1.0);
  constexpr double kStep = 1e-3;
  for (int n = 0; n < 200; ++n) {
    const std::vector<double> k{coefficient(random), coefficient(random), 0, 0, coefficient(random)};
    const CameraModel lens = camera(CameraProjection::kPinhole, k);
    double before = 0.0, fold = 0.0;
    for (double x = kStep; x < 3.0; x += kStep) {
      const double s = x * x, image = x * (1 + s * (k[0] + s * (k[1] + s * k[4])));
      if (image <= before) break;
      before = image;
      fold = x;
    }
    for (const double x : {0.1, 0.5, 0.9, 1.3, 2.0, 2.9}) {
      if (std::abs(x - fold) < 2 * kStep) continue;
      EXPECT_EQ(project(lens, {x, 0.0, 1.0}).has_value(), x < fold) << ::testing::PrintToString(k) << " " << x;
    }
  }
}

TEST(CameraModel, AnImageReachesHalfAPixelAroundItsCenters) {
  const CameraModel lens = camera(CameraProjection::kPinhole, {});
  EXPECT_TRUE(is_inside(lens, {-0.5, -0.5}));
  EXPECT_TRUE(is_inside(lens, {1279.49, 1023.49}));
  EXPECT_FALSE(is_inside(lens, {1279.5, 0.0}));
  EXPECT_FALSE(is_inside(lens, {0.0, -0.51}));
  EXPECT_FALSE(is_inside(lens, {std::numeric_limits<double>::quiet_NaN(), 0.0}));
}

TEST(CameraModel, ChecksItself) {
  const auto refusal = [](auto change) -> std::string {
    CameraModel lens = camera(CameraProjection::kPinhole, {});
    change(lens);
    try {
      check(lens);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "accepted";
  };
  using ::testing::HasSubstr;
  EXPECT_EQ(refusal([](CameraModel&) {}), "accepted");
  EXPECT_THAT(refusal([](auto& c) { c.width = 0; }), HasSubstr("width is 0"));
  EXPECT_THAT(refusal([](auto& c) { c.height = -1; }), HasSubstr("height is -1"));
  EXPECT_THAT(refusal([](auto& c) { c.fx = 0; }), HasSubstr("fx is 0"));
  EXPECT_THAT(refusal([](auto& c) { c.fy = kInfinity; }), HasSubstr("fy is inf"));
  EXPECT_THAT(refusal([](auto& c) { c.cy = kInfinity; }), HasSubstr("cy is inf"));
  EXPECT_THAT(refusal([](auto& c) { c.distortion = {1, 2, 3}; }), HasSubstr("0, 4, 5 or 8"));
  EXPECT_THAT(refusal([](auto& c) { c.distortion = {0, 0, 0, kInfinity}; }), HasSubstr("finite"));
  EXPECT_THAT(refusal([](auto& c) {
                c.projection = CameraProjection::kFisheye;
                c.distortion = {0, 0, 0, 0, 0};
              }),
              HasSubstr("0 or 4"));
}

#ifdef CMAP_TEST_WITH_OPENCV
/// OpenCV's own projection of the same points.
Vector2d opencv_pixel(const CameraModel& lens, const Vector3d& point) {
  const cv::Matx33d K(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
  const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
  std::vector<cv::Point2d> pixels;
  if (lens.projection == CameraProjection::kPinhole) {
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, lens.distortion, pixels);
  } else {
    std::vector<double> k = lens.distortion;
    k.resize(4, 0.0);
    cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), K, k);
  }
  return {pixels[0].x, pixels[0].y};
}

TEST(CameraModel, ProjectsAsOpenCv) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-0.8, 0.8), depth(0.3, 40.0);
  for (const CameraModel& lens : lenses()) {
    int compared = 0;
    for (int i = 0; i < 500; ++i) {
      const double z = depth(random);
      const Vector3d point(side(random) * z, side(random) * z, z);
      const auto pixel = project(lens, point);
      if (!pixel) continue;  // OpenCV knows no fold
      ++compared;
      // Two orders of the same few operations: some units in the last place of numbers up to 2,000.
      EXPECT_LT((*pixel - opencv_pixel(lens, point)).norm(), 1e-11) << point.transpose();
    }
    EXPECT_GT(compared, 400) << ::testing::PrintToString(lens.distortion);
  }
}

TEST(CameraModel, RaysGoWhereOpenCvUndistortsTo) {
  for (const CameraModel& lens : lenses()) {
    if (lens.projection != CameraProjection::kPinhole || lens.distortion.empty()) continue;
    const cv::Matx33d K(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
    const std::vector<cv::Point2d> pixel{{400.0, 300.0}};
    std::vector<cv::Point2d> plane;
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-13);
    cv::undistortPoints(pixel, plane, K, lens.distortion, cv::noArray(), cv::noArray(), until);
    const Vector3d ray = ray_of(lens, {400.0, 300.0});
    EXPECT_LT((ray.hnormalized() - Vector2d(plane[0].x, plane[0].y)).norm(), 1e-11);
  }
}
#endif

}  // namespace camera_model_test
}  // namespace cmap
