#include "cmap/graph/g2o_file.hpp"

#include "graph/graph_testing.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace g2o_file_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kUnit = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";

G2oGraph read_text(std::string_view text) {
  const TempFolder folder;
  return read_g2o(folder.write("graph.g2o", text));
}

std::string refusal_of(std::string_view text) {
  try {
    read_text(text);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("graph.g2o: "));
    return error.what();
  }
  return {};
}

TEST(G2oFile, ReadsVerticesEdgesAndInformation) {
  const G2oGraph file = read_text(
      "# a graph\nVERTEX_SE3:QUAT 7 1 2 3 0 0 2 2\r\nVERTEX_SE3:QUAT 3 0 0 0 0 0 0 1 # first\n\n"
      "EDGE_SE3:QUAT 3 7 4 5 6 0 0 0 -2 11 12 13 14 15 16 220 23 24 25 26 330 34 35 36 440 45 46 550 56 660\n");
  EXPECT_THAT(file.ids, ElementsAre(3u, 7u));
  ASSERT_EQ(file.graph.poses.size(), 2u);
  // (0 0 2 2): a quarter turn about z.
  EXPECT_TRUE((file.graph.poses[1] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-14));
  ASSERT_EQ(file.graph.edges.size(), 1u);
  const PoseGraph::Edge& edge = file.graph.edges[0];
  EXPECT_EQ(edge.from, 0u);
  EXPECT_EQ(edge.to, 1u);
  EXPECT_EQ(edge.T_from_to.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(edge.T_from_to.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-15));
  PoseGraph::Information expected;
  expected << 11, 12, 13, 14, 15, 16, 12, 220, 23, 24, 25, 26, 13, 23, 330, 34, 35, 36,  //
      14, 24, 34, 440, 45, 46, 15, 25, 35, 45, 550, 56, 16, 26, 36, 46, 56, 660;
  EXPECT_EQ(edge.information, expected);
  EXPECT_THAT(file.graph.fixed, ElementsAre(0u));
  EXPECT_TRUE(file.notes.empty());
}

TEST(G2oFile, FixedVertices) {
  const G2oGraph file = read_text("EDGE_SE3:QUAT 1 5 1 0 0 0 0 0 1" + kUnit + "\nEDGE_SE3:QUAT 5 9 1 0 0 0 0 0 1" +
                                  kUnit + "\nFIX 9 5\nFIX 5\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n");
  EXPECT_THAT(file.graph.fixed, ElementsAre(1u, 2u));
  EXPECT_THAT(file.notes, ElementsAre("3 vertices have no line; placed along edges", "1 PARAMS_ lines passed over"));
}

TEST(G2oFile, PlacesMissingVerticesAlongEdges) {
  // 2 is known; 1 lies before it, 0 before that, 3 after it; 10 and 11 are another piece.
  const G2oGraph file = read_text("VERTEX_SE3:QUAT 2 5 0 0 0 0 1 1\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1" + kUnit +
                                  "\nEDGE_SE3:QUAT 1 2 0 2 0 0 0 0 1" + kUnit + "\nEDGE_SE3:QUAT 2 3 3 0 0 0 0 0 1" +
                                  kUnit + "\nEDGE_SE3:QUAT 11 10 0 0 4 0 0 0 1" + kUnit + "\n");
  EXPECT_THAT(file.ids, ElementsAre(0u, 1u, 2u, 3u, 10u, 11u));
  // Axes turned by 90 degrees: x ahead is y of the world, y is -x.
  const Eigen::Vector3d kExpected[] = {{7, -1, 0}, {7, 0, 0}, {5, 0, 0}, {5, 3, 0}, {0, 0, 0}, {0, 0, -4}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT((file.graph.poses[i].translation() - kExpected[i]).norm(), 1e-14) << i;
  }
  EXPECT_THAT(file.notes, ElementsAre("5 vertices have no line; placed along edges"));
}

TEST(G2oFile, WhatIsWrittenReadsBackEqual) {
  std::mt19937_64 random(31);
  PoseGraph graph = test::exact_graph(8, 32);
  graph.fixed = {2, 4};
  const TempFolder folder;
  const std::vector<std::uint64_t> ids{1, 4, 9, 16, 25, 36, 49, 1ull << 60};
  write_g2o(graph, folder / "a.g2o", ids);
  const G2oGraph back = read_g2o(folder / "a.g2o");
  EXPECT_EQ(back.ids, ids);
  EXPECT_THAT(back.graph.fixed, ElementsAre(2u, 4u));
  ASSERT_EQ(back.graph.edges.size(), graph.edges.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    EXPECT_EQ(back.graph.edges[i].from, graph.edges[i].from);
    EXPECT_EQ(back.graph.edges[i].to, graph.edges[i].to);
    PoseGraph::Information upper = graph.edges[i].information;
    EXPECT_EQ(back.graph.edges[i].information.triangularView<Eigen::Upper>().toDenseMatrix(),
              upper.triangularView<Eigen::Upper>().toDenseMatrix());
    // Rotations go through quaternions: rounding.
    EXPECT_LT((back.graph.edges[i].T_from_to.matrix() - graph.edges[i].T_from_to.matrix()).norm(), 1e-14);
    EXPECT_EQ(back.graph.edges[i].T_from_to.translation(), graph.edges[i].T_from_to.translation());
  }
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    EXPECT_LT((back.graph.poses[i].matrix() - graph.poses[i].matrix()).norm(), 1e-14);
  }
  write_g2o(graph, folder / "b.g2o");
  EXPECT_THAT(read_bytes(folder / "b.g2o"), HasSubstr("\nFIX 2\nFIX 4\nEDGE_SE3:QUAT 0 1 "));
}

TEST(G2oFile, WritesNothingThatItCannotHold) {
  const TempFolder folder;
  PoseGraph graph = test::exact_graph(3, 33);
  graph.edges[0].cauchy_width = 1.0;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { write_g2o(graph, folder / "a.g2o"); }), HasSubstr("no widths"));
  graph.edges[0].cauchy_width = 0.0;
  graph.priors.push_back({1, graph.poses[1], PoseGraph::Information::Identity(), 0.0});
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { write_g2o(graph, folder / "a.g2o"); }), HasSubstr("no priors"));
  graph.priors.clear();
  const std::vector<std::uint64_t> ids{1, 2};
  EXPECT_THROW(write_g2o(graph, folder / "a.g2o", ids), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THROW(write_g2o(graph, folder / "no" / "a.g2o"), OutputError);
}

TEST(G2oFile, SaysWhatIsWrong) {
  const std::string edge = "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1" + kUnit + "\n";
  const std::pair<std::string, std::string> kCases[] = {
      {edge + "VERTEX_SE3:QUAT 0 1 2 3 0 0 1\n", "line 2: VERTEX_SE3:QUAT: too few numbers"},
      {edge + "VERTEX_SE3:QUAT 0 1 2 3 0 0 0 1 5\n", "line 2: VERTEX_SE3:QUAT: '5' follows after the last number"},
      {edge + "VERTEX_SE3:QUAT 0 1 2 3 0 0 0 0\n", "line 2: VERTEX_SE3:QUAT: the quaternion has length 0"},
      {edge + "VERTEX_SE3:QUAT 0 1 x 3 0 0 0 1\n", "line 2: VERTEX_SE3:QUAT: 'x' is not a number"},
      {edge + "VERTEX_SE3:QUAT 0 1 nan 3 0 0 0 1\n", "line 2: VERTEX_SE3:QUAT: 'nan' is not finite"},
      {edge + "VERTEX_SE3:QUAT -1 1 2 3 0 0 0 1\n", "line 2: VERTEX_SE3:QUAT: '-1' is not an id"},
      {edge + "VERTEX_SE3:QUAT\n", "line 2: VERTEX_SE3:QUAT: '' is not an id"},
      {"VERTEX_SE3:QUAT 4 1 2 3 0 0 0 1\nVERTEX_SE3:QUAT 4 1 2 3 0 0 0 1\n",
       "line 2: VERTEX_SE3:QUAT: vertex 4 is given twice"},
      {"EDGE_SE3:QUAT 3 3 1 0 0 0 0 0 1" + kUnit, "line 1: EDGE_SE3:QUAT: the edge leads from vertex 3 to itself"},
      {"EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0\n", "line 1: EDGE_SE3:QUAT: too few numbers"},
      {"EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 -1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
       "line 1: EDGE_SE3:QUAT: the information is not positive semidefinite: eigenvalue -1"},
      {edge + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n", "line 2: the tag 'EDGE_SE2' is not supported"},
      {edge + "hello\n", "line 2: the tag 'hello' is not supported"},
      {edge + "FIX\n", "line 2: FIX: '' is not an id"},
      {edge + "FIX 7\n", "line 2: FIX: there is no vertex 7"},
      {"VERTEX_SE3:QUAT 4 1 2 3 0 0 0 1\n", "no EDGE_SE3:QUAT in the file"},
      {"", "the file is empty"},
  };
  for (const auto& [text, message] : kCases) EXPECT_THAT(refusal_of(text), HasSubstr(message)) << text;
  EXPECT_THROW(read_g2o("/no/such.g2o"), InputError);
}

}  // namespace g2o_file_test
}  // namespace cmap::testing
