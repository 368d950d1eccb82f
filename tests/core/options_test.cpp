#include "cmap/core/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cmap/core/error.hpp"
#include "core/refusal.hpp"

namespace cmap {
namespace options_test {

using test::refusal_of;

enum class Pet { kCat, kDog };
const EnumNames<Pet> kPets{{Pet::kCat, "cat"}, {Pet::kDog, "dog"}};

struct House {
  double area_m2 = 50.0;
  int rooms = 2;
  std::uint64_t windows = 4;
  std::vector<double> heights_m{2.5};
  Eigen::Vector2d place_m{1.0, 2.0};
  Pet pet = Pet::kDog;
};

OptionFields option_fields(House& o) {
  return {
      field("area", o.area_m2, kPositive),
      field("rooms", o.rooms, NumberRange{1, 9}),
      field("windows", o.windows, {0, 99}, "N", ""),
      field("heights", o.heights_m, kNotNegative),
      field("place", o.place_m),
      beside(field("pet", o.pet, kPets)),
  };
}

/// What is said of a house after a change.
template <class Change>
std::string refusal(Change&& change) {
  House house;
  change(house);
  return refusal_of<UsageError>([&] { check_options(option_fields(house), "house"); });
}

TEST(Options, AreCheckedWhereCodeHasSetThem) {
  EXPECT_EQ(refusal([](House&) {}), "");
  EXPECT_EQ(refusal([](House& h) { h.area_m2 = 0.0; }), "house: area: 0 must be above 0");
  EXPECT_EQ(refusal([](House& h) { h.rooms = 10; }), "house: rooms: 10 must be at least 1 and at most 9");
  EXPECT_EQ(refusal([](House& h) { h.windows = 100; }), "house: windows: 100 is not a whole number from 0 to 99");
  EXPECT_EQ(refusal([](House& h) { h.heights_m = {1.0, -1.0}; }), "house: heights: -1 must be at least 0");
  EXPECT_EQ(refusal([](House& h) { h.place_m.y() = NAN; }), "house: place: nan must be a finite number");
  EXPECT_EQ(refusal([](House& h) { h.pet = static_cast<Pet>(7); }), "house: pet: has no such value");
}

TEST(Options, AreListedInTheirOrder) {
  House house;
  EXPECT_THAT(names_of(option_fields(house)),
              ::testing::ElementsAre("area", "rooms", "windows", "heights", "place", "pet"));
  const OptionField pet = option_fields(house).back();
  EXPECT_EQ(pet.placeholder, "cat|dog");
  EXPECT_EQ(pet.role, OptionRole::kBeside);
  std::get<ChoiceValue>(pet.value).set(0);
  EXPECT_EQ(house.pet, Pet::kCat);
}

TEST(EnumNames, NameValuesAndOnlyThose) {
  EXPECT_EQ(name_of(Pet::kDog, kPets), "dog");
  EXPECT_EQ(name_of(static_cast<Pet>(7), kPets), "");
  EXPECT_THAT(words_of(kPets), ::testing::ElementsAre("cat", "dog"));
}

}  // namespace options_test
}  // namespace cmap
