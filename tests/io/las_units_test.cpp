// A LAS file's coordinates in meters, or refused.

#include "io/las_testing.hpp"

namespace cmap::testing {
namespace las_units_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr U16 kWktCounts = 16;
constexpr double kFloats_m = 1e-6;  // coordinates near zero are floats
constexpr GeoKey kProjected{1024, 0, 1, 1}, kFeet{3076, 0, 1, 9002}, kHeightsInMeters{4099, 0, 1, 9001};

const std::string kSurveyFeet =
    R"(PROJCS["p",GEOGCS["g",UNIT["degree",0.0174532925199433]],UNIT["US survey foot",0.304800609601219]])";
const std::string kMetersAndFeet =
    R"(COMPD_CS["c",PROJCS["p",GEOGCS["g",UNIT["degree",0.0174532925199433]],UNIT["metre",1]],)"
    R"(VERT_CS["v",VERT_DATUM["d",2005],UNIT["foot",0.3048]]])";

/// One point at 1000 x, 2000 y, 30 z of whatever unit.
Las las_at(U8 minor, U8 format) {
  return {.minor = minor, .format = format, .offset = {900, 0, 0}, .points = {{10000, 200000, 30000}}};
}

TEST(LasUnits, FeetByGeoKeys) {
  Las las = las_at(2, 3);
  las.records = {geo_keys_record({kProjected, kFeet})};
  const auto file = read_content("a.las", las.file().str());
  EXPECT_LT((point(file, 0) - Eigen::Vector3d(304.8, 609.6, 9.144)).norm(), kFloats_m);
  EXPECT_EQ(all_notes(file), "feet became meters, also of z, whose unit the file does not name\n");
}

TEST(LasUnits, HeightsOfAnotherUnit) {
  Las las = las_at(2, 3);
  las.records = {geo_keys_record({kProjected, kFeet, kHeightsInMeters})};
  auto file = read_content("a.las", las.file().str());
  EXPECT_LT((point(file, 0) - Eigen::Vector3d(304.8, 609.6, 30)).norm(), kFloats_m);
  EXPECT_THAT(all_notes(file), HasSubstr("x and y: feet that became meters; z: meters already"));
  las = las_at(4, 7);
  las.records = {wkt_record(kMetersAndFeet)};
  las.global_encoding = kWktCounts;
  file = read_content("a.las", las.file().str());
  EXPECT_LT((point(file, 0) - Eigen::Vector3d(1000, 2000, 9.144)).norm(), kFloats_m);
}

TEST(LasUnits, WktBehindThePoints) {
  Las las = las_at(4, 7);
  las.global_encoding = kWktCounts;
  las.extended_records = {{"other", 1, "any"}, wkt_record(kSurveyFeet)};
  const auto file = read_content("a.las", las.file().str());
  EXPECT_LT((point(file, 0) - Eigen::Vector3d(1200000, 2400000, 36000) / 3937).norm(), kFloats_m);
  EXPECT_TRUE(file.info.warnings.empty()) << "the records are no bytes left over";
}

TEST(LasUnits, MetersAndFilesThatSayNothingStayAsTheyAre) {
  Las las = las_at(2, 3);
  for (const std::vector<LasRecord>& records : {std::vector<LasRecord>{},
                                                {geo_keys_record({kProjected, {3072, 0, 1, 32633}})},
                                                {wkt_record(R"(PROJCS["p",UNIT["metre",1]])")},
                                                {{"somebody", 2112, kSurveyFeet}}}) {
    las.records = records;
    const auto file = read_content("a.las", las.file().str());
    EXPECT_LT((point(file, 0) - Eigen::Vector3d(1000, 2000, 30)).norm(), kFloats_m);
    EXPECT_TRUE(file.info.notes.empty());
    EXPECT_TRUE(file.info.warnings.empty());
  }
}

TEST(LasUnits, TheHeaderSaysWhichDescriptionCounts) {
  Las las = las_at(4, 3);
  las.records = {geo_keys_record({kProjected, kFeet}), {"liblas", 2112, kSurveyFeet}};
  auto file = read_content("a.las", las.file().str());
  EXPECT_NEAR(point(file, 0).x(), 304.8, kFloats_m);
  EXPECT_THAT(all_warnings(file), HasSubstr("disagree about the units; those of the GeoKeys count"));
  las.global_encoding = kWktCounts;
  file = read_content("a.las", las.file().str());
  EXPECT_NEAR(point(file, 0).x(), 1200000.0 / 3937.0, kFloats_m);
  las.records = {geo_keys_record({kProjected}), {"liblas", 2112, kSurveyFeet}};
  las.global_encoding = 0;
  file = read_content("a.las", las.file().str());
  EXPECT_NEAR(point(file, 0).x(), 1200000.0 / 3937.0, kFloats_m) << "keys that name no unit";
  EXPECT_TRUE(file.info.warnings.empty());
}

/// Around 11.5 degrees east and 48 north, or west and south.
Las las_in_degrees(double sign) {
  Las las = las_at(2, 3);
  las.scale = {1e-7, 1e-7, 0.001};
  las.offset = {sign * 11.5, sign * 48, 500};
  las.records = {geo_keys_record({{1024, 0, 1, 2}, {2048, 0, 1, 4326}, {2054, 0, 1, 9102}})};
  return las;
}

std::string unsupported(const Las& las) {
  try {
    read_content("city.las", las.file().str());
  } catch (const UnsupportedError& error) {
    return error.what();
  }
  return {};
}

TEST(LasUnits, DegreesAreRefusedWithTheCommandThatProjects) {
  EXPECT_THAT(unsupported(las_in_degrees(1)),
              AllOf(HasSubstr("degrees of longitude and latitude (EPSG:4326)"), HasSubstr("pdal translate"),
                    HasSubstr("city_utm.las"), HasSubstr("out_srs=EPSG:32632 ")));
  EXPECT_THAT(unsupported(las_in_degrees(-1)), HasSubstr("out_srs=EPSG:32729 "));
  Las wkt = las_in_degrees(1);
  wkt.records = {wkt_record(R"(GEOGCS["WGS 84",UNIT["degree",0.0174532925199433]])")};
  EXPECT_THAT(unsupported(wkt), HasSubstr("degrees of longitude and latitude (WGS 84)"));
}

TEST(LasUnits, DegreesThatCannotBeAreMeters) {
  Las las = las_in_degrees(1);
  las.offset = {690000, 5330000, 500};
  const auto file = read_content("city.las", las.file().str());
  EXPECT_NEAR(point(file, 0).x(), 690000.001, 1e-4);
  EXPECT_THAT(all_warnings(file), HasSubstr("coordinate_system: the file says that its coordinates are degrees"));
}

TEST(LasUnits, WhatIsNotUnderstoodIsSaidAndThePointsAreRead) {
  Las las = las_at(4, 7);
  for (const auto& [record, says] :
       {std::pair{wkt_record("PROJCS[\"p\""), "well-known text that is malformed"},
        std::pair{geo_keys_record({kProjected, {3076, 0, 1, 9999}}), "the unknown code 9999"},
        std::pair{LasRecord{"LASF_Projection", 34735, std::string(7, '\1')}, "GeoKeys that ends too early"}}) {
    las.records = {record};
    const auto file = read_content("a.las", las.file().str());
    EXPECT_NEAR(point(file, 0).x(), 1000, kFloats_m);
    EXPECT_THAT(all_warnings(file), HasSubstr(says));
  }
}

TEST(LasUnits, DamagedRecordsAreSaidAndThePointsAreRead) {
  Las las = las_at(4, 7);
  las.records = {geo_keys_record({kProjected, kFeet}), {"other", 1, "any"}};
  const std::size_t second = las.header_bytes() + 54 + 24;
  auto file = read_content("a.las", las.file().set(second + 20, U16{4}).str());
  EXPECT_NEAR(point(file, 0).x(), 304.8, kFloats_m) << "the record before it is whole";
  EXPECT_THAT(all_warnings(file), HasSubstr("damaged_record: record 2 of 2 before the points is damaged"));
  file = read_content("a.las", las.file().set(100, 4000000000U).str());
  EXPECT_THAT(all_warnings(file), HasSubstr("record 3 of 4000000000 before the points is damaged"));
  file = read_content("a.las", las.file().set(las.header_bytes() + 20, U16{65535}).str());
  EXPECT_NEAR(point(file, 0).x(), 1000, kFloats_m);
  EXPECT_THAT(all_warnings(file), HasSubstr("record 1 of 2 before"));
}

TEST(LasUnits, DamagedExtendedRecordsAreSaidAndThePointsAreRead) {
  Las las = las_at(4, 7);
  las.extended_records = {wkt_record(kSurveyFeet), {"other", 1, "any"}};
  const std::size_t behind = las.data_offset() + las.record_bytes();
  const std::size_t second = behind + 60 + kSurveyFeet.size();
  for (const std::uint64_t bytes : {std::uint64_t{4}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
    const auto file = read_content("a.las", las.file().set(second + 20, bytes).str());
    EXPECT_NEAR(point(file, 0).x(), 1200000.0 / 3937.0, kFloats_m);
    EXPECT_THAT(all_warnings(file), HasSubstr("record 2 of 2 behind the points is damaged"));
  }
  for (const std::uint64_t place : {std::uint64_t{behind - 1}, ~std::uint64_t{0}, std::uint64_t{0}}) {
    const auto file = read_content("a.las", las.file().set(235, place).str());
    EXPECT_NEAR(point(file, 0).x(), 1000, kFloats_m);
    EXPECT_THAT(all_warnings(file), HasSubstr("record 1 of 2 behind the points is damaged"));
  }
}

}  // namespace las_units_test
}  // namespace cmap::testing
