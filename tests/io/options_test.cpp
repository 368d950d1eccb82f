#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/io/option_text.hpp"
#include "cmap/io/options_json.hpp"
#include "core/refusal.hpp"

namespace cmap {
namespace options_test {

using Json = nlohmann::ordered_json;
using test::refusal_of;

enum class Pet { kCat, kDog };

struct House {
  double area_m2 = 50.0;
  std::optional<double> garden_m2;
  int rooms = 2;
  std::uint64_t windows = 4;
  bool sold = false;
  std::string street = "Main";
  Eigen::Vector2d place_m{1.0, 2.0};
  std::vector<double> heights_m{2.5};
  std::vector<int> floors{0};
  std::vector<std::uint8_t> classes;
  Pet pet = Pet::kDog;
};

OptionFields option_fields(House& o) {
  static const EnumNames<Pet> pets{{Pet::kCat, "cat"}, {Pet::kDog, "dog"}};
  return {field("area", o.area_m2, kPositive, "M2", "inside"),
          field("garden", o.garden_m2, kPositive, "M2", "outside"),
          field("rooms", o.rooms, NumberRange{1, 9}),
          field("windows", o.windows, {1, 99}, "N", "all"),
          field("sold", o.sold),
          field("street", o.street),
          field("place", o.place_m),
          field("heights", o.heights_m, kPositive),
          field("floors", o.floors, kAnyNumber),
          {"classes", BytesValue{&o.classes, "classes"}},
          field("pet", o.pet, pets)};
}

TEST(OptionsJson, HasEveryFieldAndIsReadBack) {
  House house, again;
  EXPECT_EQ(options_json(option_fields(house)), Json::parse(R"({"area": 50.0, "garden": null, "rooms": 2, "windows": 4,
      "sold": false, "street": "Main", "place": [1.0, 2.0], "heights": [2.5], "floors": [0], "classes": [],
      "pet": "dog"})"));
  const Json other = Json::parse(R"({"area": 60.0, "garden": 7.5, "rooms": 3, "windows": 5, "sold": true,
      "street": "Low", "place": [3.0, -4.0], "heights": [], "floors": [-1, 2], "classes": [2, 255], "pet": "cat"})");
  set_from_json(option_fields(again), other);
  EXPECT_EQ(options_json(option_fields(again)), other);
  set_from_json(option_fields(again), Json::parse(R"({"garden": null})"));
  EXPECT_FALSE(again.garden_m2.has_value());
  EXPECT_EQ(again.rooms, 3) << "what is not named stays";
}

TEST(OptionsJson, RefusesByPlaceNameValueAndRule) {
  const auto refusal = [](const char* json) {
    House house;
    return refusal_of<UsageError>([&] { set_from_json(option_fields(house), Json::parse(json), "house"); });
  };
  EXPECT_EQ(refusal("[1]"), "house: expected a JSON object of options");
  EXPECT_EQ(refusal(R"({"room": 1})"), "house: unknown key \"room\"; did you mean rooms?");
  EXPECT_EQ(refusal(R"({"area": "big"})"), "house: area: \"big\" is not a number");
  EXPECT_EQ(refusal(R"({"area": null})"), "house: area: null is not a number");
  EXPECT_EQ(refusal(R"({"area": -1.0})"), "house: area: -1 must be above 0");
  EXPECT_EQ(refusal(R"({"garden": 0})"), "house: garden: 0 must be above 0");
  EXPECT_EQ(refusal(R"({"rooms": 2.5})"), "house: rooms: 2.5 is not a whole number");
  EXPECT_EQ(refusal(R"({"rooms": 10})"), "house: rooms: 10 must be at least 1 and at most 9");
  EXPECT_EQ(refusal(R"({"windows": 0})"), "house: windows: 0 is not a whole number from 1 to 99");
  EXPECT_EQ(refusal(R"({"sold": 1})"), "house: sold: 1 is neither true nor false");
  EXPECT_EQ(refusal(R"({"street": 1})"), "house: street: 1 is not a text");
  EXPECT_EQ(refusal(R"({"place": [1]})"), "house: place: [1] is not a list of 2 numbers");
  EXPECT_EQ(refusal(R"({"heights": 1})"), "house: heights: 1 is not a list of numbers");
  EXPECT_EQ(refusal(R"({"heights": [1, 0]})"), "house: heights: 0 must be above 0");
  EXPECT_EQ(refusal(R"({"floors": [0.5]})"), "house: floors: 0.5 is not a whole number");
  EXPECT_EQ(refusal(R"({"classes": 2})"), "house: classes: 2 is not a list of classes");
  EXPECT_EQ(refusal(R"({"classes": [256]})"), "house: classes: 256 is not a whole number from 0 to 255");
  EXPECT_EQ(refusal(R"({"pet": "dgo"})"), "house: pet: \"dgo\" is none of cat, dog; did you mean dog?");
}

TEST(OptionText, SetsWhatItSays) {
  House house;
  const OptionFields fields = option_fields(house);
  const std::vector<std::string> texts{"60.5",     "7.5",     "3",    "5",   "true", "Low",
                                       "3.0,-4.0", "1.5,2.5", "-1,2", "2,6", "cat"};
  ASSERT_EQ(texts.size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    set_from_text(fields[i], texts[i]);
    EXPECT_EQ(value_text(fields[i]), texts[i]) << fields[i].name;
    EXPECT_EQ(is_flag(fields[i]), fields[i].name == std::string("sold"));
  }
  EXPECT_EQ(refusal_of<UsageError>([&] { set_from_text(fields.front(), "60m"); }), "area: \"60m\" is not a number");
}

TEST(OptionText, ArgumentsAreThoseThatDiffer) {
  House house, other;
  house.sold = true;
  house.heights_m = {3.0, 4.5};
  EXPECT_THAT(arguments_for(option_fields(house), option_fields(other)),
              ::testing::ElementsAre("--sold", "--heights", "3.0,4.5"));
}

TEST(Assignment, IsANameAndJsonOrAText) {
  EXPECT_EQ(read_assignment("a=2", "name=value").value, 2);
  EXPECT_EQ(read_assignment("a=b=c", "name=value").value, "b=c");
  const auto refusal = [](const char* text) {
    return refusal_of<UsageError>([&] { read_assignment(text, "name=value"); });
  };
  EXPECT_EQ(refusal("a"), "\"a\" is not name=value");
  EXPECT_EQ(refusal("=2"), "\"=2\" is not name=value");
}

}  // namespace options_test
}  // namespace cmap
