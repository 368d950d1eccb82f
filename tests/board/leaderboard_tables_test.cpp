#include "leaderboard_tables.hpp"

#include <fstream>

#include "cmap/board/leaderboard.hpp"
#include "pair_folder.hpp"
#include "report/report_testing.hpp"

namespace cmap {
namespace {

using test::painted_sheet;
using test::report_of;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

LeaderboardPair done(const std::string& sequence, const std::string& method, double color_distance, double overlap) {
  static const Json report = report_of(painted_sheet(400, 1), painted_sheet(300, 2));
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

  const ScoreSection section(const std::string& id) const {
    for (const ScoreSection& section : leaderboard_sections(manifest, pairs)) {
      if (section.kind.id() == id) return section;
    }
    throw std::runtime_error("no section " + id);
  }
};

std::vector<std::string> texts_of(const TableRow& row) {
  std::vector<std::string> texts;
  for (const TableCell& cell : row.cells) {
    texts.push_back(cell.text + (cell.mark == Mark::kBest ? "*" : cell.mark == Mark::kSecond ? "+" : ""));
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
  const ScoreTable table = board.section("color_fidelity").computed;
  EXPECT_THAT(texts_of(table.rows[0]), ElementsAre("∞*", ::testing::_));
  EXPECT_THAT(texts_of(table.rows[1]), ElementsAre("40.00+", "x"));
  EXPECT_THAT(leaderboard_csv(board.manifest, board.pairs),
              HasSubstr("color_fidelity,,,dB,higher,S,A,computed,done,inf,best\n"));
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
  EXPECT_THAT(documents.csv, HasSubstr("color_distance,,,as printed,lower,S,C,published,failed,,\n"));
  EXPECT_THAT(documents.csv, HasSubstr("color_distance,,,of 255,lower,S,A,normalized,done,255,\n"));
  EXPECT_THAT(documents.csv, HasSubstr("accuracy,,0.2,m,lower,S,A,published,done,0.04,\n"));
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
  const ScoreTable table = *registration_table(board.manifest);
  EXPECT_THAT(texts_of(table.rows[0]), ElementsAre("9+", "-", "-", "-"));
  EXPECT_THAT(texts_of(table.rows[1]), ElementsAre("2*", "-", "-", "-"));
  EXPECT_THAT(texts_of(table.rows[2]), ElementsAre("5+", "-", "-", "-"));
  EXPECT_THAT(texts_of(table.rows[3]), ElementsAre("4*", "-", "-", "-"));
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

}  // namespace
}  // namespace cmap
