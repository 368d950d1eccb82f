#include <fstream>

#include "cmap/board/leaderboard.hpp"
#include "report/report_testing.hpp"

namespace cmap {
namespace leaderboard_manifest_test {

using test::refusal_of;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class ManifestTest : public ::testing::Test {
 protected:
  LeaderboardManifest read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_manifest(path_);
  }
  /// What is said about a manifest with these members beside version, sequences and methods.
  std::string refusal(const std::string& text) {
    const std::string message = refusal_of<UsageError>([&] { read(text); });
    EXPECT_TRUE(message.empty() || message.starts_with(path_.string() + ": ")) << message;
    return message.empty() ? "" : message.substr(path_.string().size() + 2);
  }
  std::string refusal_beside(const std::string& members) {
    return refusal(R"({"version":1,"sequences":[{"name":"S","reference":"s.ply"}],"methods":[{"name":"M"}],)" +
                   members + "}");
  }
  std::string refusal_of_sequence(const std::string& sequence) {
    return refusal(R"({"version":1,"sequences":[)" + sequence + R"(],"methods":[{"name":"M"}]})");
  }
  std::string refusal_of_methods(const std::string& methods) {
    return refusal(R"({"version":1,"sequences":[{"name":"S","reference":"s.ply"}],"methods":)" + methods + "}");
  }

  const std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) / "cmap_manifest_test";
  const std::filesystem::path path_ = folder_ / "manifest.json";

  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
};

TEST_F(ManifestTest, IsReadAsFormatsSays) {
  const LeaderboardManifest manifest = read(R"({"version":1, "parameters":{"lcr-tau":0.05}, // comments are fine
 "sequences":[{"name":"AMtown01","reference":"AMtown01/gt.las"},{"name":"AMvalley01","reference":"v/gt.las"}],
 "methods":[{"name":"Ours","maps":{"AMtown01":"AMtown01/ours.ply"}, "failed":["AMvalley01"]}],
 "published":{"source":"a paper","metrics":{"chamfer":{"AMtown01":{"Ours":2.23,"Other":null}}}}})");
  EXPECT_EQ(manifest.options.lcr_tau, 0.05);
  EXPECT_EQ(manifest.sequences.at(1).name, "AMvalley01");
  EXPECT_EQ(manifest.methods.at(0).maps.at("AMtown01"), "AMtown01/ours.ply");
  EXPECT_TRUE(manifest.methods.at(0).failed.contains("AMvalley01"));
  ASSERT_TRUE(manifest.published);
  EXPECT_EQ(manifest.published->metrics.at(0).entries.at(0).value, 2.23);
  EXPECT_EQ(manifest.published->metrics.at(0).entries.at(1).value, std::nullopt);
}

TEST_F(ManifestTest, PublishedMayBeAFileBesideIt) {
  std::ofstream(folder_ / "paper.json") << R"({"source":"beside"})";
  const LeaderboardManifest manifest = read(
      R"({"version":1,"sequences":[{"name":"S","reference":"s"}],"methods":[{"name":"M"}],"published":"paper.json"})");
  EXPECT_EQ(manifest.published->source, "beside");
  EXPECT_THAT(refusal_beside(R"("published":"none.json")"), EndsWith("none.json: cannot be read as published scores"));
}

TEST_F(ManifestTest, EveryBadLineIsNamed) {
  EXPECT_THAT(refusal("{"), HasSubstr("line 1"));
  EXPECT_EQ(refusal("[]"), "the manifest: expected an object");
  EXPECT_EQ(refusal("{}"), "the manifest: has no \"version\"");
  EXPECT_EQ(refusal(R"({"version":2})"), "version: 2 is unknown; this program reads version 1");
  EXPECT_EQ(refusal(R"({"version":1,"seqences":[]})"),
            "the manifest: unknown key \"seqences\"; keys are version, parameters, sequences, methods, published");
  EXPECT_EQ(refusal(R"({"version":1,"version":1})"), "key \"version\" is given twice");
  EXPECT_EQ(refusal(R"({"version":1})"), "the manifest: has no \"sequences\"");
  EXPECT_EQ(refusal(R"({"version":1,"sequences":[],"methods":[]})"), "sequences: there is none");
  EXPECT_EQ(refusal(R"({"version":1,"sequences":{},"methods":[]})"), "sequences: expected a list");
  EXPECT_THAT(refusal_beside(R"("parameters":{"lcr-tua":1})"), HasSubstr("unknown key \"lcr-tua\""));
  EXPECT_THAT(refusal_beside(R"("parameters":{"lcr-tau":-1})"), HasSubstr("lcr-tau: -1 must be above 0"));
}

TEST_F(ManifestTest, BadSequences) {
  EXPECT_EQ(refusal_of_sequence("5"), "sequences[0]: expected an object");
  EXPECT_EQ(refusal_of_sequence(R"({"reference":"a"})"), "sequences[0]: has no \"name\"");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"S"})"), "sequences[0]: has no \"reference\"");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"","reference":"a"})"), "sequences[0].name: the name is empty");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"a\nb","reference":"a"})"),
            "sequences[0].name: the name has control characters");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"S","reference":"a"},{"name":"S","reference":"b"})"),
            "sequences[1]: \"S\" is there twice");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"S","reference":"/etc/map.ply"})"),
            "sequences[0].reference: \"/etc/map.ply\" must be a path below the data root");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"S","reference":"a/../../b"})"),
            "sequences[0].reference: \"a/../../b\" must be a path below the data root");
  EXPECT_EQ(refusal_of_sequence(R"({"name":"S","reference":"a","ref":"b"})"),
            "sequences[0]: unknown key \"ref\"; keys are name, reference");
}

TEST_F(ManifestTest, BadMethods) {
  EXPECT_EQ(refusal_of_methods("[]"), "methods: there is none");
  EXPECT_EQ(refusal_of_methods(R"([{"name":"M"},{"name":"M"}])"), "methods[1]: \"M\" is there twice");
  EXPECT_EQ(refusal_of_methods(R"([{"name":"M","maps":{"T":"m.ply"}}])"),
            "methods[0].maps: \"T\" is no sequence of this manifest");
  EXPECT_EQ(refusal_of_methods(R"([{"name":"M","maps":{"S":5}}])"), "methods[0].maps.S: 5 is no text");
  EXPECT_EQ(refusal_of_methods(R"([{"name":"M","failed":["T"]}])"),
            "methods[0].failed: \"T\" is no sequence of this manifest");
  EXPECT_EQ(refusal_of_methods(R"([{"name":"M","failed":["S","S"]}])"), "methods[0].failed: \"S\" is there twice");
  EXPECT_EQ(refusal_of_methods(R"([{"name":"M","maps":{"S":"m"},"failed":["S"]}])"),
            "methods[0]: \"S\" is in both maps and failed");
}

TEST_F(ManifestTest, BadPublishedNumbers) {
  const auto refusal_of_published = [&](const std::string& members) {
    return refusal_beside(R"("published":{"source":"x",)" + members + "}");
  };
  EXPECT_EQ(refusal_beside(R"("published":{})"), "published: has no \"source\"");
  EXPECT_EQ(refusal_of_published(R"("metrics":{"chamfre":{}})"), "published.metrics: \"chamfre\" is no metric's id");
  EXPECT_EQ(refusal_of_published(R"("metrics":{"CD":{}})"), "published.metrics: \"CD\" is no metric's id");
  EXPECT_EQ(refusal_of_published(R"("metrics":{"chamfer":{"S":{"M":"2"}}})"),
            "published.metrics.chamfer.S.M: \"2\" is neither a number nor null");
  EXPECT_EQ(refusal_of_published(R"("color_distance_scale":{"S":0})"),
            "published.color_distance_scale.S: must be above 0");
  EXPECT_EQ(refusal_of_published(R"("registration":{"S":{"fused":{}}})"),
            "published.registration.S.fused: variants are prefusion, normal, regularized");
  EXPECT_EQ(refusal_of_published(R"("registration":{"S":{"normal":{"rsme":1}}})"),
            "published.registration.S.normal: unknown key \"rsme\"; keys are rmse, average_wasserstein, chamfer, "
            "spatial_consistency");
}

}  // namespace leaderboard_manifest_test
}  // namespace cmap
