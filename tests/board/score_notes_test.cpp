#include "score_notes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cmap {
namespace score_notes_test {

using ::testing::ElementsAre;

Score with_phases(double std) {
  Score score{{}, 0.25};
  score.phases = Phases{{0.25, 0.5}, std, 0.25, 0.5};
  return score;
}

TEST(BandOf, HasTwoDigits) {
  EXPECT_EQ(band_of(nullptr), "");
  const Score without{{}, 0.25};
  EXPECT_EQ(band_of(&without), "");
  const auto band = [](double std, double factor = 1.0) {
    const Score score = with_phases(std);
    return band_of(&score, factor);
  };
  EXPECT_EQ(band(0.09712), "± 0.097");
  EXPECT_EQ(band(0.1), "± 0.10");
  EXPECT_EQ(band(0.09712, 100.0), "± 9.7");
  EXPECT_EQ(band(123.4), "± 123");
  EXPECT_EQ(band(0.0), "± 0");
}

TEST(NoteOn, SaysWhatTheNumberIsWorth) {
  Score score{{}, 0.1014};
  EXPECT_EQ(note_on(&score), "0.1014");
  score.floor = 0.07412;
  EXPECT_EQ(note_on(&score), "0.1014; floor 0.07412");
  score.chance = 0.3;
  EXPECT_EQ(note_on(&score), "0.1014; floor 0.07412, chance 0.3");
  score.floor.reset();
  EXPECT_EQ(note_on(&score), "0.1014; chance 0.3");
  const Score phased = with_phases(0.125);
  EXPECT_EQ(note_on(&phased), "0.25; grid phases 0.25 to 0.5");
}

TEST(NoteOn, SaysWhyThereIsNoValue) {
  EXPECT_EQ(note_on(nullptr), "no value");
  Score score;
  EXPECT_EQ(note_on(&score), "no value");
  score.reason = "the floor is no better than chance";
  EXPECT_EQ(note_on(&score), "no value: the floor is no better than chance");
}

TEST(MissingNotes, OneForEachReason) {
  ScoreKind skill;
  skill.metric = "color_distance";
  skill.part = "skill";
  skill.title = "skill of color distance";
  const auto missing = [&](const std::string& reason) { return std::vector<Score>{{skill, {}, {}, {}, {}, reason}}; };
  EXPECT_THAT(missing_notes({"a", "b", "c", "d", "e"},
                            {missing("the estimate is gray"),
                             {{skill, 0.5}},
                             {},
                             missing("the estimate is gray"),
                             missing("fewer than 20 points")},
                            {skill}),
              ElementsAre("no skill of color distance: fewer than 20 points (e)",
                          "no skill of color distance: the estimate is gray (a, d)"));
}

}  // namespace score_notes_test
}  // namespace cmap
