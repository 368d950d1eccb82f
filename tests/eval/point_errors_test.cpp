#include "cmap/eval/point_errors.hpp"

#include <cstring>
#include <map>
#include <sstream>

#include "eval/eval_testing.hpp"
#include "io/io_testing.hpp"

namespace cmap {
namespace point_errors_test {

using test::options_for;
using test::refusal_of;
using test::small_map;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

/// The columns of a binary PLY by name, and their names and types in order.
struct Columns {
  std::vector<std::pair<std::string, std::string>> types;
  std::map<std::string, std::vector<double>> values;
};

template <class T>
double take(const std::string& bytes, std::size_t& place) {
  T value;
  if (place + sizeof(T) > bytes.size()) throw std::runtime_error("the file ends early");
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  place += sizeof(T);
  return static_cast<double>(value);
}

/// Reads what write_ply writes, by the format's description alone.
Columns read_columns(const std::filesystem::path& path) {
  const std::string bytes = testing::read_bytes(path);
  const std::string end = "end_header\n";
  std::size_t place = bytes.find(end) + end.size();
  std::istringstream header(bytes.substr(0, place));
  Columns columns;
  std::size_t n = 0;
  for (std::string line, word, type, name; std::getline(header, line);) {
    std::istringstream words(line);
    words >> word >> type >> name;
    if (word == "element") n = std::stoul(name);
    if (word == "property") columns.types.emplace_back(name, type);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (const auto& [column, stored] : columns.types) {
      columns.values[column].push_back(stored == "float"    ? take<float>(bytes, place)
                                       : stored == "double" ? take<double>(bytes, place)
                                                            : take<std::uint8_t>(bytes, place));
    }
  }
  EXPECT_EQ(place, bytes.size()) << "nothing follows the last point";
  return columns;
}

const PointCloud kReference =
    small_map({{0, 0, 0}, {8, 0, 0}, {0, 5.25f, 0}}, {Rgb8{0, 0, 0}, Rgb8{0, 255, 0}, Rgb8{51, 0, 0}});
const PointCloud kEstimate = small_map({{8, 3, 0}, {0, 0.25f, 0}}, {Rgb8{0, 255, 0}, Rgb8{51, 0, 0}});

using Writer = void (*)(const EvaluatedPair&, OutputFile&);

void write(Writer errors, const EvaluatedPair& evaluation, const std::filesystem::path& path) {
  OutputFile file(path);
  errors(evaluation, file);
  file.commit();
}

Columns written(Writer errors, const EvaluatedPair& evaluation) {
  const testing::TempFolder folder;
  write(errors, evaluation, folder / "errors.ply");
  return read_columns(folder / "errors.ply");
}

Columns estimate_errors(const EvaluatedPair& evaluation) { return written(write_estimate_errors, evaluation); }

Columns reference_errors(const EvaluatedPair& evaluation) { return written(write_reference_errors, evaluation); }

TEST(EstimateErrors, AreScalarFieldsInOriginalOrder) {
  const Columns columns = estimate_errors(evaluate(kReference, kEstimate, EvaluationOptions{}));
  EXPECT_THAT(columns.types, ElementsAre(Pair("x", "float"), Pair("y", "float"), Pair("z", "float"),
                                         Pair("red", "uchar"), Pair("green", "uchar"), Pair("blue", "uchar"),
                                         Pair("scalar_distance_m", "float"), Pair("scalar_color_distance", "float")));
  EXPECT_THAT(columns.values.at("x"), ElementsAre(8, 0));
  EXPECT_THAT(columns.values.at("y"), ElementsAre(3, 0.25));
  EXPECT_THAT(columns.values.at("green"), ElementsAre(255, 0));
  EXPECT_THAT(columns.values.at("scalar_distance_m"), ElementsAre(3, 0.25));
  EXPECT_THAT(columns.values.at("scalar_color_distance"), ElementsAre(0, static_cast<double>(0.2f)));
}

TEST(ReferenceErrors, SayWhatLocalColorRecallFound) {
  const Columns columns = reference_errors(evaluate(kReference, kEstimate, EvaluationOptions{}));
  EXPECT_EQ(columns.types.back(), (std::pair<std::string, std::string>("scalar_lcr", "float")));
  EXPECT_THAT(columns.values.at("x"), ElementsAre(0, 8, 0));
  EXPECT_THAT(columns.values.at("scalar_distance_m"), ElementsAre(0.25, 3, 5));
  EXPECT_THAT(columns.values.at("scalar_lcr"), ElementsAre(2, 0, 0))
      << "0.2 is within 3 tau; the others are too far away";
  EvaluationOptions strict;
  strict.lcr_tau = 0.05;
  EXPECT_THAT(reference_errors(evaluate(kReference, kEstimate, strict)).values.at("scalar_lcr"), ElementsAre(1, 0, 0));
}

TEST(ReferenceErrors, HaveNoRecallWhereItWasNotComputed) {
  const Columns columns = reference_errors(evaluate(kReference, kEstimate, options_for({"chamfer"})));
  EXPECT_FALSE(columns.values.contains("scalar_lcr"));
  EXPECT_TRUE(columns.values.contains("scalar_color_distance"));
}

TEST(PointErrors, HaveNoColorWhereAMapHasNone) {
  const PointCloud bare = small_map({{0, 0, 1}});
  const EvaluatedPair evaluation = evaluate(kReference, bare, EvaluationOptions{});
  EXPECT_THAT(estimate_errors(evaluation).types, ElementsAre(Pair("x", "float"), Pair("y", "float"), Pair("z", "float"),
                                                             Pair("scalar_distance_m", "float")));
  const Columns columns = reference_errors(evaluation);
  EXPECT_TRUE(columns.values.contains("red")) << "the reference keeps its own color";
  EXPECT_FALSE(columns.values.contains("scalar_color_distance"));
  EXPECT_FALSE(columns.values.contains("scalar_lcr"));
}

TEST(PointErrors, AreOfTheMapsAsTheyWereCompared) {
  EvaluationOptions options;
  options.crop = Box3d{{-1, -1, -1}, {1, 9, 1}};
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(1, 3) = 1.0;
  const EvaluatedPair evaluation = evaluate(kReference, kEstimate, options, T);
  EXPECT_THAT(estimate_errors(evaluation).values.at("y"), ElementsAre(1.25)) << "moved and cropped";
  EXPECT_THAT(reference_errors(evaluation).values.at("y"), ElementsAre(0, 5.25)) << "cropped";
}

TEST(PointErrors, KeepManyPointsInOrder) {
  const PointCloud reference = test::painted_sheet(3000, 1), estimate = test::painted_sheet(2000, 2);
  const Columns columns = estimate_errors(evaluate(reference, estimate, options_for({"geometry"})));
  ASSERT_EQ(columns.values.at("x").size(), estimate.size());
  const auto& colors = std::get<Array<Rgb8>>(estimate.colors);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    ASSERT_EQ(columns.values.at("x")[i], estimate.positions[i].x());
    ASSERT_EQ(columns.values.at("blue")[i], colors[i][2]);
    double nearest = INFINITY;
    for (std::size_t j = 0; j < reference.size(); ++j)
      nearest = std::min(nearest, (estimate.world(i) - reference.world(j)).norm());
    ASSERT_NEAR(columns.values.at("scalar_distance_m")[i], nearest, 1e-6 * nearest) << i;
  }
}

TEST(PointErrors, KeepLargeCoordinates) {
  PointCloud reference = kReference, estimate = kEstimate;
  reference.origin = estimate.origin = {500000, 4000000, 100};
  const Columns columns = estimate_errors(evaluate(reference, estimate, EvaluationOptions{}));
  EXPECT_EQ(columns.types.front().second, "double");
  EXPECT_THAT(columns.values.at("x"), ElementsAre(500008, 500000));
  EXPECT_THAT(columns.values.at("y"), ElementsAre(4000003, 4000000.25));
  EXPECT_THAT(columns.values.at("scalar_distance_m"), ElementsAre(3, 0.25));
}

TEST(PointErrors, WriteColorsOfAnyStorageAs8Bit) {
  PointCloud estimate = small_map({{0, 0, 0}});
  estimate.colors = Array<RgbF>{{1.0f, 0.0f, 0.2f}};
  const Columns from_float = estimate_errors(evaluate(kReference, estimate, EvaluationOptions{}));
  estimate.colors = Array<Rgb16>{{65535, 0, 51 * 257}};
  const Columns from_16_bit = estimate_errors(evaluate(kReference, estimate, EvaluationOptions{}));
  for (const Columns& columns : {from_float, from_16_bit}) {
    EXPECT_THAT(columns.values.at("red"), ElementsAre(255));
    EXPECT_THAT(columns.values.at("green"), ElementsAre(0));
    EXPECT_THAT(columns.values.at("blue"), ElementsAre(51));
  }
}

TEST(PointErrors, AnUnwritableFileIsNamed) {
  const EvaluatedPair evaluation = evaluate(kReference, kEstimate, options_for({"chamfer"}));
  for (const char* path : {"/no/such/folder/errors.ply", "/dev/full"}) {
    for (Writer errors : {&write_estimate_errors, &write_reference_errors}) {
      EXPECT_THAT(refusal_of<OutputError>([&] { write(errors, evaluation, path); }), HasSubstr(path));
    }
  }
}

}  // namespace point_errors_test
}  // namespace cmap
