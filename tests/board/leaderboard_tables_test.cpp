#include "leaderboard_tables.hpp"

#include <fstream>

#include "cmap/board/leaderboard.hpp"
#include "pair_folder.hpp"
#include "report/report_testing.hpp"

namespace cmap {
namespace leaderboard_tables_test {

using test::painted_sheet;
using test::report_of;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

LeaderboardPair done(const std::string& sequence, const std::string& method, double color_distance, double overlap) {
  static const Json report = test::without_levels(report_of(painted_sheet(400, 1), painted_sheet(300, 2)));
  LeaderboardPair pair{sequence, method, PairState::kDone, "", report, "pairs/" + sequence + "/" + method, true};
  pair.report["metrics"]["color_distance"]["value"] = color_distance;
  pair.report["metrics"]["overlap"]["value"] = overlap;
  return pair;
}

/// Two sequences and two methods; B failed on T.
struct Board {
  LeaderboardManifest manifest;
  std::vector<LeaderboardPair> pairs;

  Board() {
    manifest.sequences = {{"S", "s.ply"}, {"T", "t.ply"}};
    manifest.methods = {{"A", {}, {}}, {"B", {}, {}}};
    pairs = {done("S", "A", 0.2, 0.5),
             done("S", "B", 0.1, 0.75),
             done("T", "A", 0.4, 0.125),
             {"T", "B", PairState::kFailed, "b.ply: truncated", nullptr, "pairs/T/B", false}};
  }

  ScoreSection section(const std::string& id, bool is_plain = true) const {
    for (const ScoreSection& section : leaderboard_scores(manifest, pairs, {.plain_ranking = is_plain}).sections) {
      if (section.kind.id() == id) return section;
    }
    throw std::runtime_error("no section " + id);
  }
};

std::vector<std::string> texts_of(const TableRow& row) {
  std::vector<std::string> texts;
  for (const TableCell& cell : row.cells) {
    texts.push_back(cell.text + (cell.mark == Mark::kBest           ? "*"
                                 : cell.mark == Mark::kSecond       ? "+"
                                 : cell.mark == Mark::kBestUntested ? "?"
                                                                    : ""));
  }
  return texts;
}

TEST(LeaderboardTables, RowsAreMethodsAndColumnsSequencesInThePapersUnits) {
  const Board board;
  const ScoreTable table = board.section("color_distance").computed;
  EXPECT_EQ(table.title, "color distance (CD) ↓ [of 255]");
  EXPECT_THAT(table.value_columns, ElementsAre("S", "T"));
  EXPECT_THAT(texts_of(table.rows[0]), ElementsAre("51.00+", "102.0"));
  EXPECT_THAT(texts_of(table.rows[1]), ElementsAre("25.50*", "x"));
  EXPECT_EQ(table.rows[1].cells[1].note, "failed: b.ply: truncated");
  EXPECT_THAT(texts_of(board.section("overlap").computed.rows[1]), ElementsAre("75.00*", "x"));
}

TEST(LeaderboardTables, AnInfiniteFidelityIsBest) {
  Board board;
  Json& exact = board.pairs[0].report;
  exact["metrics"]["color_fidelity"]["value"] = nullptr;
  exact["warnings"].push_back({{"id", "color_fidelity_infinite"}, {"message", "every color is exact"}});
  board.pairs[1].report["metrics"]["color_fidelity"]["value"] = 40.0;
  const ScoreTable table = board.section("color_fidelity", false).computed;
  EXPECT_THAT(texts_of(table.rows[0]), ElementsAre("∞*", ::testing::_));
  EXPECT_THAT(texts_of(table.rows[1]), ElementsAre("40.00+", "x"));
  EXPECT_THAT(typeset_leaderboard(board.manifest, board.pairs).csv,
              HasSubstr("color_fidelity,,,dB,higher,S,A,computed,done,inf,best,,,\n"));
}

TEST(LeaderboardTables, MissingMapsAreDashesInEveryTable) {
  Board board;
  for (LeaderboardPair& pair : board.pairs)
    pair = {pair.sequence, pair.method, PairState::kMissing, "no file", nullptr, "", false};
  const LeaderboardDocuments documents = typeset_leaderboard(board.manifest, board.pairs);
  EXPECT_THAT(documents.text,
              ContainsRegex("Chamfer distance \\(CD#\\) ↓ \\[m\\]\nmethod  S   T\nA +-   -\nB +-   -\n"));
  EXPECT_THAT(documents.text, HasSubstr("- S / A: no file\n"));
  for (const std::string& text : {documents.text, documents.markdown, documents.csv})
    EXPECT_THAT(text, Not(HasSubstr("0.00")));
}

TEST(LeaderboardTables, DocumentsNameFilesAndNoFolders) {
  Board board;
  board.pairs[3].reason = "/home/ann/maps/b.ply: truncated";
  const LeaderboardDocuments documents = typeset_leaderboard(board.manifest, board.pairs);
  EXPECT_THAT(documents.text, HasSubstr("x T / B: b.ply: truncated\n"));
  for (const std::string& text : {documents.text, documents.markdown, documents.latex, documents.csv, documents.html}) {
    EXPECT_THAT(text, Not(HasSubstr("/home")));
  }
}

TEST(LeaderboardTables, PublishedNumbersStayAsPublished) {
  Board board;
  board.manifest.published = parse_published(Json::parse(R"({"source":"paper","metrics":{
      "color_distance":{"T":{"C":60.0,"A":51.0},"S":{"C":null,"A":512}},
      "local_color_recall":{"S":{"A":0.0086}},"accuracy":{"S":{"A":0.04}}},
      "color_distance_scale":{"T":255,"S":512}})"));
  const ScoreTable colors = *board.section("color_distance").published;
  EXPECT_THAT(colors.value_columns, ElementsAre("T", "of 255", "S", "of 255")) << "in the order of the source";
  EXPECT_THAT(texts_of(colors.rows[0]), ElementsAre("60+", "60.00+", "x", "x"));
  EXPECT_THAT(texts_of(colors.rows[1]), ElementsAre("51*", "51.00*", "512", "255.0"));
  EXPECT_THAT(texts_of(board.section("local_color_recall").published->rows[0]), ElementsAre("0.86"));
  EXPECT_TRUE(board.section("accuracy@0.2").published) << "MapEval's headline level";
  EXPECT_FALSE(board.section("accuracy@0.1").published);
  EXPECT_FALSE(board.section("local_color_recall.coverage").published);
  const LeaderboardDocuments documents = typeset_leaderboard(board.manifest, board.pairs);
  EXPECT_THAT(documents.csv, HasSubstr("color_distance,,,as printed,lower,S,C,published,failed,,,,,\n"));
  EXPECT_THAT(documents.csv, HasSubstr("color_distance,,,of 255,lower,S,A,normalized,done,255,,,,\n"));
  EXPECT_THAT(documents.csv, HasSubstr("accuracy,,0.2,m,lower,S,A,published,done,0.04,,,,\n"));
  EXPECT_THAT(documents.text, HasSubstr("different scales"));
}

TEST(LeaderboardTables, PublishedMetricsThatNobodyAskedForAreShown) {
  Board board;
  board.manifest.options.metrics = {"chamfer"};
  board.manifest.published =
      parse_published(Json::parse(R"({"source":"paper","metrics":{"overlap":{"S":{"A":0.5}}}})"));
  EXPECT_TRUE(board.section("overlap").published);
}

TEST(LeaderboardTables, RegistrationIsMarkedWithinItsSequence) {
  Board board;
  board.manifest.published = parse_published(Json::parse(R"({"source":"paper","registration":{
      "S":{"prefusion":{"rmse":9,"spatial_consistency":null},"normal":{"rmse":2}},"T":{"normal":{"rmse":5},"regularized":{"rmse":4}}}})"));
  const ScoreTable table = *registration_table(board.manifest, true);
  EXPECT_THAT(texts_of(table.rows[0]), ElementsAre("9+", "-", "-", "-"));
  EXPECT_THAT(texts_of(table.rows[1]), ElementsAre("2*", "-", "-", "-"));
  EXPECT_THAT(texts_of(table.rows[2]), ElementsAre("5+", "-", "-", "-"));
  EXPECT_THAT(texts_of(table.rows[3]), ElementsAre("4*", "-", "-", "-"));
}

TEST(LeaderboardTables, PublishedNumbersAreNotTested) {
  Board board;
  board.manifest.published = parse_published(Json::parse(R"({"source":"paper","metrics":{
      "overlap":{"S":{"A":0.5,"B":0.75}}},"registration":{"S":{"normal":{"rmse":2},"prefusion":{"rmse":9}}}})"));
  EXPECT_THAT(texts_of(board.section("overlap", false).published->rows[1]), ElementsAre("75?"));
  EXPECT_THAT(texts_of(registration_table(board.manifest, false)->rows[0]), ElementsAre("2?", "-", "-", "-"));
}

/// On S, A is better by every phase of AWD; on T, B has no map.
Board board_with_levels() {
  Board board;
  for (std::size_t i = 0; i < 2; ++i) {
    Json& metrics = board.pairs[i].report["metrics"];
    metrics["color_distance"]["skill"] = {{"value", i == 0 ? 0.5 : 0.75}, {"se", 0.01}};
    metrics["color_distance"]["floor"] = {{"value", 0.0625}, {"se", 0.01}, {"n", 400}};
    metrics["color_distance"]["chance"] = {{"value", 0.5}, {"se", 0.01}, {"n", 400}};
    const double value = i == 0 ? 0.25 : 0.5;
    metrics["average_wasserstein"]["value"] = value;
    metrics["average_wasserstein"]["phases"] = {{"n", 2},     {"mean", value}, {"std", 0.125},
                                                {"min", 0.2}, {"max", 0.6},    {"values", {value, value + 0.125}}};
  }
  return board;
}

TEST(LeaderboardTables, SkillHasASectionOfItsOwn) {
  const Board board = board_with_levels();
  const ScoreSection skill = board.section("color_distance.skill", false);
  EXPECT_EQ(skill.computed.title, "skill of color distance ↑") << "no share of 255";
  EXPECT_THAT(texts_of(skill.computed.rows[0]), ElementsAre("0.5000", "-"));
  EXPECT_THAT(texts_of(skill.computed.rows[1]), ElementsAre("0.7500?", "x"));
  const LeaderboardDocuments documents = typeset_leaderboard(board.manifest, board.pairs);
  for (const std::string& text : {documents.text, documents.markdown, documents.latex, documents.html})
    EXPECT_THAT(text, HasSubstr("skill of color distance"));
  EXPECT_THAT(documents.csv,
              HasSubstr("color_distance,,,unit RGB,lower,S,B,computed,done,0.1,best untested,0.0625,0.5,\n"));
  EXPECT_THAT(documents.csv, HasSubstr("color_distance,skill,,1,higher,S,B,computed,done,0.75,best untested,,,\n"));
}

TEST(LeaderboardTables, RankingsSayWhatIsDistinguishable) {
  Board board = board_with_levels();
  const ScoreSection section = board.section("average_wasserstein", false);
  EXPECT_THAT(texts_of(section.computed.rows[0]), ElementsAre("0.2500*", ::testing::_));
  EXPECT_THAT(texts_of(section.computed.rows[1]), ElementsAre("0.5000+", "x"));
  EXPECT_THAT(section.computed.notes, ElementsAre("1 of 1 ranking distinguishable over the grid's phases"));
  const LeaderboardDocuments documents = typeset_leaderboard(board.manifest, board.pairs);
  EXPECT_THAT(documents.text, HasSubstr("0.2500* ± 0.12"));
  EXPECT_THAT(documents.text, ContainsRegex("\n1 of [0-9]+ rankings distinguishable over the grid's phases, "));
  EXPECT_THAT(documents.text, Not(HasSubstr("1 of 1 ranking"))) << "one note for all tables";
  EXPECT_THAT(documents.latex, HasSubstr("1 of 1 ranking distinguishable")) << "its tables stand alone";
  EXPECT_THAT(documents.html, HasSubstr("1 of 1 ranking distinguishable"));
  EXPECT_THAT(documents.latex, Not(HasSubstr("pm")));
  EXPECT_THAT(typeset_leaderboard(board.manifest, board.pairs, {.bands = true}).latex, HasSubstr("0.2500 $\\pm$ 0.12"));
  board.pairs[1].report["metrics"]["average_wasserstein"]["phases"]["values"] = {0.5, 0.25};
  EXPECT_THAT(texts_of(board.section("average_wasserstein", false).computed.rows[1]), ElementsAre("0.5000*", "x"));
  EXPECT_THAT(texts_of(board.section("average_wasserstein", true).computed.rows[1]), ElementsAre("0.5000+", "x"));
}

TEST(LeaderboardPage, LinksAndNamesAreEscaped) {
  Board board;
  board.manifest.methods[0].name = board.pairs[0].method = "<b>&";
  board.pairs[0].folder = "pairs/S/" + folder_name("<b>&");
  const std::string page = typeset_leaderboard(board.manifest, board.pairs).html;
  EXPECT_THAT(page, HasSubstr("href=\"pairs/S/~3Cb~3E~26/report.html\""));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;&amp;"));
  EXPECT_THAT(page, Not(HasSubstr("<b>&")));
}

TEST(FolderName, IsDifferentForDifferentNames) {
  EXPECT_EQ(folder_name("V-Sim(3)"), "V-Sim(3)");
  EXPECT_EQ(folder_name("a/b"), "a~2Fb");
  EXPECT_EQ(folder_name("a~2Fb"), "a~7E2Fb");
  EXPECT_EQ(folder_name(".."), "~2E.");
}

class PairFolderTest : public ::testing::Test {
 protected:
  std::filesystem::path path_ = std::filesystem::path(::testing::TempDir()) / "cmap_pair_folder_test";
  Json key_{{"tool", "1"}, {"maps", "a"}};
  Json report_ = report_of(painted_sheet(400, 1), painted_sheet(300, 2));
  std::string reason_;

  PairFolder folder() const { return PairFolder(path_, {"report.json", "figure.png"}); }
  void TearDown() override { std::filesystem::remove_all(path_); }
  void SetUp() override {
    folder().store(key_, {{"figure.png", [](OutputFile& file) { file.write("picture"); }},
                          {"report.json", [&](OutputFile& file) { file.write(report_.dump()); }}});
  }
  bool loads(const Json& key) { return folder().load(key, reason_).has_value(); }
};

TEST_F(PairFolderTest, GivesBackWhatWasStored) {
  EXPECT_EQ(folder().load(key_, reason_), report_);
  EXPECT_EQ(reason_, "");
}

TEST_F(PairFolderTest, AnotherKeyIsNotUsed) {
  EXPECT_FALSE(loads({{"tool", "1"}, {"maps", "b"}}));
  EXPECT_EQ(reason_, "of other maps or parameters");
  EXPECT_FALSE(loads({{"tool", "2"}, {"maps", "a"}}));
  EXPECT_EQ(reason_, "of another version");
}

TEST_F(PairFolderTest, DamageIsNoticed) {
  std::ofstream(path_ / "figure.png") << "Picture";
  EXPECT_FALSE(loads(key_));
  EXPECT_EQ(reason_, "damaged: figure.png is not as it was written");
  std::ofstream(path_ / "pair.json") << "{";
  EXPECT_FALSE(loads(key_));
  std::ofstream(path_ / "pair.json") << "{}";
  EXPECT_FALSE(loads(key_));
  EXPECT_EQ(reason_, "damaged: pair.json is not as it was written");
  std::filesystem::remove(path_ / "pair.json");
  EXPECT_FALSE(loads(key_));
  EXPECT_EQ(reason_, "") << "nothing is no damage";
}

TEST_F(PairFolderTest, WhatKilledRunsLeftIsRemoved) {
  std::ofstream(path_ / ".report.json.12-0.tmp") << "half";
  std::ofstream(path_ / ".mine.tmp") << "somebody else's";
  EXPECT_TRUE(loads(key_));
  EXPECT_FALSE(std::filesystem::exists(path_ / ".report.json.12-0.tmp"));
  EXPECT_TRUE(std::filesystem::exists(path_ / ".mine.tmp"));
}

}  // namespace leaderboard_tables_test
}  // namespace cmap
