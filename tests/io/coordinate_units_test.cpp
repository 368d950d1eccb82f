// Units of coordinates by WKT, by GeoKeys and by EPSG codes.

#include "units/coordinate_units.hpp"

#include "io/las_testing.hpp"
#include "units/epsg_units.hpp"

namespace cmap::testing {
namespace coordinate_units_test {

using ::testing::HasSubstr;
using ::testing::Optional;

constexpr double kFoot = 0.3048;
constexpr double kSurveyFoot = 1200.0 / 3937.0;  // by its definition

const std::string kGeographic =
    R"(GEOGCS["NAD83",DATUM["D",SPHEROID["GRS 1980",6378137,298.257222101]],PRIMEM["Greenwich",0],)"
    R"(UNIT["degree",0.0174532925199433]])";

std::string projected(const std::string& unit) {
  return R"(PROJCS["here",)" + kGeographic + R"(,PROJECTION["Mercator"],PARAMETER["false_easting",984250],)" + unit +
         R"(,AXIS["X",EAST],AXIS["Y",NORTH]])";
}

std::string vertical(const std::string& unit) {
  return R"(VERT_CS["up",VERT_DATUM["any",2005],)" + unit + R"(,AXIS["Up",UP]])";
}

/// What a text is expected to say; 0: nothing.
struct Expected {
  std::string wkt;
  double horizontal_m;
  double vertical_m;
};

const Expected kWkt[] = {
    {projected(R"(UNIT["metre",1])"), 1, 0},
    {projected(R"(UNIT["foot",0.3048])"), kFoot, 0},
    {projected(R"(UNIT["US survey foot",0.304800609601219,AUTHORITY["EPSG","9003"]])"), kSurveyFoot, 0},
    {projected(R"(UNIT["Foot_US",0.30480060960121924])"), kSurveyFoot, 0},
    {projected(R"(UNIT["foot_survey_us",0.3048006])"), kSurveyFoot, 0},
    {projected(R"(UNIT["a meter by its factor",0.3048])"), kFoot, 0},
    {projected(R"(UNIT["kilometre",1000])"), 1000, 0},
    {projected(R"(UNIT["a ""quoted"" unit",0.01])"), 0.01, 0},
    {R"(COMPD_CS["c",)" + projected(R"(UNIT["metre",1])") + "," + vertical(R"(UNIT["foot",0.3048])") + "]", 1, kFoot},
    {R"(COMPD_CS["c",)" + projected(R"(UNIT["foot",0.3048])") + "," + vertical(R"(UNIT["metre",1])") + "]", kFoot, 1},
    // Esri: two systems one after the other, brackets of the other kind, blanks and line ends.
    {projected(R"(UNIT["Foot_US",0.3048006096012192])") +
         R"(,VERTCS["NAVD_1988",VDATUM["any"],PARAMETER["Direction",1.0],UNIT["Meter",1.0]])",
     kSurveyFoot, 1},
    {"PROJCS ( \"here\" ,\n GEOGCS(\"g\", UNIT(\"degree\", 0.01745)) ,\r\n\tUNIT ( \"foot\" , 0.3048 ) ) \n", kFoot, 0},
    // WKT 2: the unit behind the axes, or in each of them.
    {R"(PROJCRS["p",BASEGEOGCRS["g",DATUM["d",ELLIPSOID["e",6378137,298.25,LENGTHUNIT["metre",1]]],)"
     R"(PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]]],CONVERSION["c",METHOD["m"],)"
     R"w(PARAMETER["False easting",500000,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["(E)",east,ORDER[1]],)w"
     R"w(AXIS["(N)",north,ORDER[2]],LENGTHUNIT["US survey foot",0.304800609601219],ID["EPSG",2263]])w",
     kSurveyFoot, 0},
    {R"(PROJCRS["p",BASEGEODCRS["g",DATUM["d",ELLIPSOID["e",1,2,LENGTHUNIT["metre",1]]]],CS[Cartesian,3],)"
     R"(AXIS["x",east,ORDER[1],LENGTHUNIT["foot",0.3048]],AXIS["y",north,ORDER[2],LENGTHUNIT["foot",0.3048]],)"
     R"(AXIS["h",up,ORDER[3],LENGTHUNIT["metre",1]]])",
     kFoot, 1},
    {R"(COMPOUNDCRS["c",PROJCRS["p",CS[Cartesian,2],LENGTHUNIT["metre",1]],VERTCRS["v",VDATUM["d"],CS[vertical,1],)"
     R"(AXIS["up",up,LENGTHUNIT["foot",0.3048]]]])",
     1, kFoot},
    {R"(BOUNDCRS[SOURCECRS[PROJCRS["p",CS[Cartesian,2],LENGTHUNIT["foot",0.3048]]],)"
     R"(TARGETCRS[GEOGCRS["WGS 84",CS[ellipsoidal,2],ANGLEUNIT["degree",0.0174532925199433]]],)"
     R"(ABRIDGEDTRANSFORMATION["t"]])",
     kFoot, 0},
    {R"(GEODCRS["earth",DATUM["d"],CS[Cartesian,3],AXIS["X",geocentricX],AXIS["Y",geocentricY],AXIS["Z",geocentricZ],)"
     R"(LENGTHUNIT["metre",1]])",
     1, 1},
    {R"(GEOCCS["earth",DATUM["d",SPHEROID["s",6378137,298]],PRIMEM["G",0],UNIT["metre",1]])", 1, 0},
    {R"(LOCAL_CS["site",LOCAL_DATUM["d",32767],UNIT["foot",0.3048],AXIS["x",EAST],AXIS["y",NORTH]])", kFoot, 0},
    {R"(ENGCRS["site",EDATUM["d"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]])", 1, 0},
    {std::string(projected(R"(UNIT["foot",0.3048])")) + std::string(3, '\0') + "what follows the text", kFoot, 0},
    {projected(R"(AUTHORITY["EPSG","2263"])"), 0, 0},
    {projected(R"(UNIT["metre",1],VERT_CS["inside",VERT_DATUM["d",2005],UNIT["foot",0.3048]])"), 1, kFoot},
};

TEST(WktUnits, ByFactorOfTheSystemItself) {
  for (const auto& [wkt, horizontal_m, vertical_m] : kWkt) {
    SCOPED_TRACE(wkt);
    const CoordinateUnits units = units_from_wkt(wkt);
    EXPECT_FALSE(units.angular);
    EXPECT_EQ(units.horizontal_m.value_or(0.0), horizontal_m);
    EXPECT_EQ(units.vertical_m.value_or(0.0), vertical_m);
    EXPECT_TRUE(units.problem.empty());
  }
}

TEST(WktUnits, Angles) {
  const std::string degrees = R"(ANGLEUNIT["degree",0.0174532925199433])";
  for (const std::string& wkt :
       {kGeographic, R"(COMPD_CS["c",)" + kGeographic + "," + vertical(R"(UNIT["metre",1])") + "]",
        R"(GEOGCRS["WGS 84",DATUM["d"],CS[ellipsoidal,2],AXIS["lat",north],AXIS["lon",east],)" + degrees + "]",
        R"(GEODCRS["WGS 84",DATUM["d"],CS[ellipsoidal,3],AXIS["lat",north,)" + degrees + "]]",
        projected(R"(UNIT["Degree",0.0174532925199433])")}) {
    EXPECT_TRUE(units_from_wkt(wkt).angular) << wkt;
    EXPECT_FALSE(units_from_wkt(wkt).horizontal_m) << wkt;
  }
  EXPECT_EQ(units_from_wkt(kGeographic).system, "NAD83");
}

TEST(WktUnits, MalformedTextSaysNothingButThat) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "PROJCS[";
  const std::string whole = projected(R"(UNIT["foot",0.3048])");
  const std::vector<std::string> texts{
      R"(PROJCS["a")", R"(PROJCS["a])", "PROJCS[,]", "]",
      "<xml/>[",       whole + "]",     deep,        whole.substr(0, whole.size() / 2)};
  for (const std::string& wkt : texts) {
    const CoordinateUnits units = units_from_wkt(wkt);
    EXPECT_FALSE(units.says_something());
    EXPECT_THAT(units.problem, HasSubstr("malformed"));
  }
  EXPECT_FALSE(units_from_wkt("nothing here").says_something());
  for (const char* factor : {"0", "-1", "nan", "1e300"}) {
    const CoordinateUnits units = units_from_wkt(projected(R"(UNIT["u",)" + std::string(factor) + "]"));
    EXPECT_FALSE(units.horizontal_m) << factor;
    EXPECT_THAT(units.problem, HasSubstr("a unit named u whose factor is none"));
  }
}

TEST(WktUnits, AFootWithTheFactorOfAMeter) {
  // Some libraries wrote the heights so, and inside of the projected system.
  const CoordinateUnits units =
      units_from_wkt(projected(R"(UNIT["US survey foot",0.3048006096012192],)" +
                               std::string(R"(VERTCS["NAVD88",VERT_DATUM["d",2005],UNIT["US survey foot",1.0]])")));
  EXPECT_THAT(units.horizontal_m, Optional(kSurveyFoot));
  EXPECT_FALSE(units.vertical_m);
  EXPECT_THAT(units.problem, HasSubstr("a unit named US survey foot whose factor is that of a meter"));
}

CoordinateUnits from_keys(const std::vector<GeoKey>& keys, const std::vector<double>& doubles = {}) {
  const std::string directory = geo_key_directory(keys);
  return units_from_geo_keys(std::as_bytes(std::span(directory)), std::as_bytes(std::span(doubles)));
}

constexpr GeoKey kProjectedModel{1024, 0, 1, 1}, kGeographicModel{1024, 0, 1, 2};

TEST(GeoKeyUnits, ByTheUnitKeys) {
  EXPECT_THAT(from_keys({kProjectedModel, {3076, 0, 1, 9001}}).horizontal_m, Optional(1.0));
  EXPECT_THAT(from_keys({kProjectedModel, {3076, 0, 1, 9002}}).horizontal_m, Optional(kFoot));
  EXPECT_THAT(from_keys({kProjectedModel, {3076, 0, 1, 9003}}).horizontal_m, Optional(kSurveyFoot));
  EXPECT_THAT(from_keys({{3076, 0, 1, 9036}}).horizontal_m, Optional(1000.0)) << "without a model";
  const CoordinateUnits both = from_keys({kProjectedModel, {3076, 0, 1, 9001}, {4099, 0, 1, 9003}});
  EXPECT_THAT(both.horizontal_m, Optional(1.0));
  EXPECT_THAT(both.vertical_m, Optional(kSurveyFoot));
  EXPECT_FALSE(from_keys({kProjectedModel, {3076, 0, 1, 9002}}).vertical_m);
  EXPECT_THAT(from_keys({kProjectedModel, {3076, 0, 1, 32767}, {3077, 34736, 1, 1}}, {7.0, 0.25}).horizontal_m,
              Optional(0.25))
      << "a unit of the user's own";
}

TEST(GeoKeyUnits, ByTheCodeOfTheSystemWhereTheUnitIsLeftOut) {
  EXPECT_THAT(from_keys({kProjectedModel, {3072, 0, 1, 2263}}).horizontal_m, Optional(kSurveyFoot)) << "New York";
  EXPECT_THAT(from_keys({kProjectedModel, {3072, 0, 1, 2256}}).horizontal_m, Optional(kFoot)) << "Montana";
  EXPECT_THAT(from_keys({kProjectedModel, {3072, 0, 1, 32633}}).horizontal_m, Optional(1.0)) << "UTM";
  EXPECT_THAT(from_keys({kProjectedModel, {3072, 0, 1, 2263}, {3076, 0, 1, 9001}}).horizontal_m, Optional(1.0))
      << "a unit key counts for more";
  EXPECT_THAT(from_keys({{3072, 0, 1, 32633}, {4096, 0, 1, 6360}}).vertical_m, Optional(kSurveyFoot));
  EXPECT_THAT(from_keys({{3072, 0, 1, 2263}, {4096, 0, 1, 5703}}).vertical_m, Optional(1.0));
  EXPECT_FALSE(from_keys({{3072, 0, 1, 2263}, {4096, 0, 1, 5030}}).vertical_m) << "a surface";
  EXPECT_FALSE(from_keys({kProjectedModel, {3072, 0, 1, 32767}}).says_something());
  EXPECT_EQ(from_keys({kProjectedModel, {3072, 0, 1, 2263}}).system, "EPSG:2263");
}

TEST(GeoKeyUnits, ModelsOfTheEarth) {
  const CoordinateUnits degrees = from_keys({kGeographicModel, {2048, 0, 1, 4326}, {2054, 0, 1, 9102}});
  EXPECT_TRUE(degrees.angular);
  EXPECT_EQ(degrees.system, "EPSG:4326");
  EXPECT_TRUE(from_keys({{2048, 0, 1, 4326}}).angular) << "without a model";
  EXPECT_FALSE(from_keys({{2048, 0, 1, 4326}, {3072, 0, 1, 32633}}).angular) << "what the projection starts from";
  const CoordinateUnits geocentric = from_keys({{1024, 0, 1, 3}, {2048, 0, 1, 4978}});
  EXPECT_FALSE(geocentric.angular);
  EXPECT_THAT(geocentric.horizontal_m, Optional(1.0));
}

TEST(GeoKeyUnits, DamagedLists) {
  const std::string whole = geo_key_directory({kProjectedModel, {3076, 0, 1, 9002}});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const CoordinateUnits units = units_from_geo_keys(std::as_bytes(std::span(whole).first(size)), {});
    EXPECT_FALSE(units.says_something()) << size;
    EXPECT_THAT(units.problem, HasSubstr("ends too early")) << size;
  }
  EXPECT_TRUE(from_keys({}).problem.empty()) << "an empty list is whole";
  EXPECT_THAT(from_keys({{3076, 0, 1, 9999}}).problem, HasSubstr("unknown code 9999"));
  EXPECT_FALSE(from_keys({{3076, 0, 1, 32767}, {3077, 34736, 1, 65535}}, {0.5}).says_something());
}

TEST(EpsgUnits, TheDefinitions) {
  EXPECT_THAT(epsg_length_m(9001), Optional(1.0));
  EXPECT_THAT(epsg_length_m(9003), Optional(::testing::DoubleEq(0.30480060960121924)));
  EXPECT_FALSE(epsg_length_m(9102)) << "degrees";
  // State planes of NAD83(2011) come in pairs: meters, then US survey feet or feet.
  EXPECT_EQ(epsg_projected_unit_m(6538), 1.0);
  EXPECT_EQ(epsg_projected_unit_m(6539), kSurveyFoot);
  EXPECT_EQ(epsg_projected_unit_m(6494), kFoot);
  EXPECT_EQ(epsg_vertical_unit_m(8228), kFoot);
  EXPECT_EQ(epsg_vertical_unit_m(3855), 1.0);
}

TEST(Units, NamesForPeople) {
  EXPECT_EQ(unit_name(kFoot), "feet");
  EXPECT_EQ(unit_name(kSurveyFoot), "US survey feet");
  EXPECT_EQ(unit_name(0.01), "units of 0.01 m");
}

}  // namespace coordinate_units_test
}  // namespace cmap::testing
