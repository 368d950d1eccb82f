#include "cmap/graph/g2o_file.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/io/row_writer.hpp"

namespace cmap {
namespace {

constexpr double kShortestQuaternion = 1e-6;
/// Information is printed with about six digits.
constexpr double kInformationRounding = 1e-5;

using Id = std::uint64_t;

struct EdgeLine {
  Id from, to;
  PoseGraph::Edge edge;
};

/// One line, token by token; errors name the file and the line.
class Line {
 public:
  Line(const LineReader& lines, std::string_view text) : lines_(lines), text_(text.substr(0, text.find('#'))) {}

  std::string_view token() { return next_token(text_); }
  bool at_end() const { return std::ranges::all_of(text_, is_blank); }

  Id id(std::string_view tag) {
    const std::string_view word = token();
    unsigned long long value = 0;
    if (!parse_number(word, value)) lines_.fail("{}: '{}' is not an id", tag, word.substr(0, 40));
    return value;
  }
  Eigen::Isometry3d pose(std::string_view tag) {
    std::array<double, 7> v{};
    for (double& value : v) value = number(tag);
    Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    const double length = q.norm();
    if (!(length > kShortestQuaternion)) lines_.fail("{}: the quaternion has length {:g}", tag, length);
    q.coeffs() /= length;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = q.toRotationMatrix();
    pose.translation() << v[0], v[1], v[2];
    return pose;
  }
  PoseGraph::Information information(std::string_view tag) {
    PoseGraph::Information information;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) information(column, row) = information(row, column) = number(tag);
    }
    const Eigen::SelfAdjointEigenSolver<PoseGraph::Information> eigen(information, Eigen::EigenvaluesOnly);
    if (eigen.eigenvalues()[0] < -kInformationRounding * information.cwiseAbs().maxCoeff()) {
      lines_.fail("{}: the information is not positive semidefinite: eigenvalue {:g}", tag, eigen.eigenvalues()[0]);
    }
    return information;
  }
  void require_end(std::string_view tag) {
    if (!at_end()) lines_.fail("{}: '{}' follows after the last number", tag, token().substr(0, 40));
  }

 private:
  double number(std::string_view tag) {
    const std::string_view word = token();
    if (word.empty()) lines_.fail("{}: too few numbers", tag);
    double value = 0.0;
    if (!parse_number(word, value)) lines_.fail("{}: '{}' is not a number", tag, word.substr(0, 40));
    if (!std::isfinite(value)) lines_.fail("{}: '{}' is not finite", tag, word.substr(0, 40));
    return value;
  }
  const LineReader& lines_;
  std::string_view text_;
};

/// The lines of a file as they stand.
struct G2oLines {
  std::map<Id, Eigen::Isometry3d> vertices;
  std::vector<EdgeLine> edges;
  std::map<Id, std::uint64_t> fixed;  ///< id to line
  std::size_t n_params = 0;
};

void read_line(const LineReader& lines, std::string_view text, G2oLines& content) {
  Line line(lines, text);
  const std::string_view tag = line.token();
  if (tag.empty()) return;
  if (tag == "VERTEX_SE3:QUAT") {
    const Id id = line.id(tag);
    if (!content.vertices.emplace(id, line.pose(tag)).second) lines.fail("{}: vertex {} is given twice", tag, id);
    line.require_end(tag);
  } else if (tag == "EDGE_SE3:QUAT") {
    EdgeLine edge{};
    edge.from = line.id(tag);
    edge.to = line.id(tag);
    if (edge.from == edge.to) lines.fail("{}: the edge leads from vertex {} to itself", tag, edge.from);
    edge.edge.T_from_to = line.pose(tag);
    edge.edge.information = line.information(tag);
    line.require_end(tag);
    content.edges.push_back(edge);
  } else if (tag == "FIX") {
    do {
      content.fixed.emplace(line.id(tag), lines.number());
    } while (!line.at_end());
  } else if (tag.starts_with("PARAMS_")) {
    ++content.n_params;
  } else {
    lines.fail("the tag '{}' is not supported; VERTEX_SE3:QUAT, EDGE_SE3:QUAT and FIX are", tag.substr(0, 40));
  }
}

/// Places the nodes that have no vertex line, along edges.
std::size_t place_missing(PoseGraph& graph, std::vector<char>& placed) {
  std::vector<std::vector<std::size_t>> edges_of(graph.poses.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    edges_of[graph.edges[e].from].push_back(e);
    edges_of[graph.edges[e].to].push_back(e);
  }
  std::vector<std::size_t> queue;
  const auto spread = [&] {
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const std::size_t node = queue[head];
      for (const std::size_t e : edges_of[node]) {
        const PoseGraph::Edge& edge = graph.edges[e];
        const bool forward = edge.from == node;
        const std::size_t next = forward ? edge.to : edge.from;
        if (placed[next]) continue;
        graph.poses[next] = graph.poses[node] * (forward ? edge.T_from_to : edge.T_from_to.inverse());
        placed[next] = 1;
        queue.push_back(next);
      }
    }
    queue.clear();
  };
  std::size_t n_missing = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (placed[i]) queue.push_back(i);
    n_missing += placed[i] ? 0 : 1;
  }
  spread();
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (placed[i]) continue;
    placed[i] = 1;
    queue.push_back(i);
    spread();
  }
  return n_missing;
}

std::size_t index_of(const std::vector<Id>& ids, Id id) {
  return static_cast<std::size_t>(std::ranges::lower_bound(ids, id) - ids.begin());
}

G2oGraph assembled(const ByteSource& source, const G2oLines& content) {
  G2oGraph result;
  for (const auto& [id, pose] : content.vertices) result.ids.push_back(id);
  for (const EdgeLine& edge : content.edges) result.ids.insert(result.ids.end(), {edge.from, edge.to});
  std::ranges::sort(result.ids);
  result.ids.erase(std::ranges::unique(result.ids).begin(), result.ids.end());
  PoseGraph& graph = result.graph;
  graph.poses.assign(result.ids.size(), Eigen::Isometry3d::Identity());
  std::vector<char> placed(result.ids.size(), 0);
  for (const auto& [id, pose] : content.vertices) {
    graph.poses[index_of(result.ids, id)] = pose;
    placed[index_of(result.ids, id)] = 1;
  }
  for (const EdgeLine& line : content.edges) {
    graph.edges.push_back(line.edge);
    graph.edges.back().from = index_of(result.ids, line.from);
    graph.edges.back().to = index_of(result.ids, line.to);
  }
  if (!content.fixed.empty()) graph.fixed.clear();
  for (const auto& [id, line] : content.fixed) {
    if (!std::ranges::binary_search(result.ids, id)) source.fail("line {}: FIX: there is no vertex {}", line, id);
    graph.fixed.push_back(index_of(result.ids, id));
  }
  const std::size_t n_missing = place_missing(graph, placed);
  if (n_missing > 0) result.notes.push_back(fmt::format("{} vertices have no line; placed along edges", n_missing));
  if (content.n_params > 0) result.notes.push_back(fmt::format("{} PARAMS_ lines passed over", content.n_params));
  return result;
}

void put(RowWriter& row, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  for (int i = 0; i < 3; ++i) row.put_text(pose.translation()[i]);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) row.put_text(value);
}

void put_word(RowWriter& row, std::string_view word) {
  for (const char c : word) row.put_binary(c);
  row.put_binary(' ');
}

void check_writable(const PoseGraph& graph, std::span<const Id> ids) {
  if (!ids.empty() && ids.size() != graph.poses.size()) {
    throw std::invalid_argument(fmt::format("write_g2o: {} ids for {} nodes", ids.size(), graph.poses.size()));
  }
  if (!graph.priors.empty()) throw UnsupportedError("a g2o file holds no priors");
  for (const PoseGraph::Edge& edge : graph.edges) {
    if (edge.cauchy_width != 0.0) throw UnsupportedError("a g2o file holds no widths of robust edges");
  }
}

}  // namespace

G2oGraph read_g2o(const std::filesystem::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  G2oLines content;
  std::string_view line;
  while (lines.next(line)) read_line(lines, line, content);
  if (content.edges.empty()) source.fail("no EDGE_SE3:QUAT in the file");
  return assembled(source, content);
}

void write_g2o(const PoseGraph& graph, const std::filesystem::path& path, std::span<const std::uint64_t> ids) {
  check_writable(graph, ids);
  const auto id_of = [&](std::size_t node) { return ids.empty() ? static_cast<Id>(node) : ids[node]; };
  OutputFile file(path);
  RowWriter row(file);
  const auto end = [&row] { row.end_line(), row.end_row(); };
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    put_word(row, "VERTEX_SE3:QUAT");
    row.put_text(id_of(i));
    put(row, graph.poses[i]);
    end();
  }
  for (const std::size_t node : graph.fixed) {
    put_word(row, "FIX");
    row.put_text(id_of(node));
    end();
  }
  for (const PoseGraph::Edge& edge : graph.edges) {
    put_word(row, "EDGE_SE3:QUAT");
    row.put_text(id_of(edge.from));
    row.put_text(id_of(edge.to));
    put(row, edge.T_from_to);
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) row.put_text(edge.information(r, c));
    }
    end();
  }
  row.flush();
  file.commit();
}

}  // namespace cmap
