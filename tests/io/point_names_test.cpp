#include "clouds/point_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace cmap {
namespace point_names_test {

using Names = std::vector<std::string>;

TEST(PointNames, SynonymsAndSpellings) {
  const Names kPositions[] = {{"x", "y", "z"},
                              {"X", "Y", "Z"},
                              {"x_m", "y_m", "z_m"},
                              {"X [m]", "Y [m]", "Z [m]"},
                              {"//X", "Y", "Z"},
                              {"\"x\"", "\"y\"", "\"z\""},
                              {"Easting", "Northing", "Height"},
                              {"EASTING", "NORTHING", "Elevation (m)"},
                              {"east", "north", "up"},
                              {"pos_x", "pos_y", "pos_z"},
                              {"Position.X", "Position.Y", "Position.Z"},
                              {"Points:0x", "Points:0y", "Points:0z", "X", "Y", "Z"}};
  for (const Names& names : kPositions) EXPECT_TRUE(find_point_names(names).position) << names[0];
  const Names kColors[] = {{"red", "green", "blue"},
                           {"Red", "Green", "Blue"},
                           {"R", "G", "B"},
                           {"Rf", "Gf", "Bf"},
                           {"diffuse_red", "diffuse_green", "diffuse_blue"},
                           {"color_r", "color_g", "color_b"}};
  for (const Names& names : kColors) EXPECT_TRUE(find_point_names(names).color) << names[0];
}

TEST(PointNames, TakesWhatIsThereInAnyOrder) {
  const Names names{"label", "B", "z", "R", "X", "nx", "Y", "G", "Ori_x"};
  const PointNames found = find_point_names(names);
  EXPECT_EQ(found.position, (ColumnTriple{4, 6, 2}));
  EXPECT_EQ(found.color, (ColumnTriple{3, 7, 1}));
  EXPECT_FALSE(found.packed_color);
  EXPECT_EQ(find_point_names(Names{"x", "y", "z", "RGB"}).packed_color, 3U);
}

TEST(PointNames, OtherNamesAreNone) {
  for (const Names& names :
       {Names{"nx", "ny", "nz"}, Names{"a", "b", "c"}, Names{"x", "y"}, Names{"id", "time", "range"}}) {
    EXPECT_FALSE(find_point_names(names).position) << names[0];
  }
  EXPECT_EQ(find_point_names(Names{"x", "y", "z", "red", "blue"}).n_color_channels, 2U);
}

TEST(PointNames, SplatsDegreesAndUnits) {
  EXPECT_TRUE(names_splats(Names{"x", "y", "z", "f_dc_0", "f_dc_1"}));
  EXPECT_FALSE(names_splats(Names{"x", "y", "z", "red"}));
  EXPECT_TRUE(names_degrees(Names{"Latitude", "Longitude", "Altitude"}));
  EXPECT_TRUE(names_degrees(Names{"id", "lat", "lon", "h"}));
  EXPECT_FALSE(names_degrees(Names{"x", "y", "z", "label", "lonely"}));
  EXPECT_EQ(unit_in_name("X [mm]"), "mm");
  EXPECT_EQ(unit_in_name("easting_ft"), "feet");
  EXPECT_EQ(unit_in_name("x_m"), "");
  EXPECT_EQ(unit_in_name("x"), "");
}

}  // namespace point_names_test
}  // namespace cmap
