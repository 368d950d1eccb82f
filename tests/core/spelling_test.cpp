#include "cmap/core/spelling.hpp"

#include <gtest/gtest.h>

namespace cmap {
namespace spelling_test {

TEST(EditDistance, CountsEveryKindOfChange) {
  EXPECT_EQ(edit_distance("accuracy", "accuracy"), 0U);
  EXPECT_EQ(edit_distance("acuracy", "accuracy"), 1U) << "a letter left out";
  EXPECT_EQ(edit_distance("acccuracy", "accuracy"), 1U) << "a letter twice";
  EXPECT_EQ(edit_distance("accuracz", "accuracy"), 1U) << "another letter";
  EXPECT_EQ(edit_distance("accuarcy", "accuracy"), 1U) << "two letters swapped";
  EXPECT_EQ(edit_distance("ACCURACY", "accuracy"), 0U) << "case";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U) << "Levenshtein's usual example";
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
}

TEST(DidYouMean, NamesTheNearest) {
  const std::vector<std::string> known{"chamfer", "rmse", "color_distance", "delta_e"};
  EXPECT_EQ(did_you_mean("champfer", known), "; did you mean chamfer?");
  EXPECT_EQ(did_you_mean("colour_distance", known), "; did you mean color_distance?");
  EXPECT_EQ(did_you_mean("color-distance", known), "; did you mean color_distance?");
  EXPECT_EQ(did_you_mean("color", known), "; did you mean color_distance?") << "its beginning";
  EXPECT_EQ(did_you_mean("rsme", known), "; did you mean rmse?");
}

TEST(DidYouMean, IsSilentWhereNothingIsNear) {
  const std::vector<std::string> known{"chamfer", "rmse", "AC", "F"};
  EXPECT_EQ(did_you_mean("lidar", known), "");
  EXPECT_EQ(did_you_mean("", known), "");
  EXPECT_EQ(did_you_mean("x", known), "") << "one letter is no likeness";
  EXPECT_EQ(did_you_mean("AC", {}), "");
}

}  // namespace spelling_test
}  // namespace cmap
