#include "cmap/io/transform_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "io/line_reader.hpp"
#include "io/number_text.hpp"
#include "io/text_layout.hpp"

namespace cmap {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 20;
constexpr double kRotationTolerance = 1e-3;

std::string read_all(ByteSource& source) {
  if (source.size() > kMaxBytes) source.fail("{} bytes are too many for a transform", source.size());
  std::string text(source.size(), '\0');
  source.read(std::as_writable_bytes(std::span(text)), "the file");
  return text;
}

Eigen::Matrix4d from_text(const ByteSource& named, std::string_view text) {
  ByteSource source(named.name(), std::as_bytes(std::span(text)));
  LineReader lines(source);
  std::vector<double> values;
  std::string_view line;
  while (lines.next(line)) {
    line = line.substr(0, line.find('#'));
    for (std::string_view token; next_column(line, token);) {
      double value = 0.0;
      if (!parse_number(token, value)) lines.fail("'{}' is not a number", token.substr(0, 40));
      if (!std::isfinite(value)) lines.fail("'{}' is not finite", token);
      if (values.size() == 16) lines.fail("more than the 16 numbers of a 4x4 matrix");
      values.push_back(value);
    }
  }
  if (values.size() != 16) lines.fail("the file ends after {} numbers; a 4x4 matrix has 16", values.size());
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
}

std::optional<Eigen::Matrix4d> as_matrix(const Json& json) {
  Eigen::Matrix4d matrix;
  if (!json.is_array() || json.size() != 4) return std::nullopt;
  for (int row = 0; row < 4; ++row) {
    const Json& values = json[static_cast<std::size_t>(row)];
    if (!values.is_array() || values.size() != 4) return std::nullopt;
    for (int column = 0; column < 4; ++column) {
      const Json& value = values[static_cast<std::size_t>(column)];
      if (!value.is_number()) return std::nullopt;
      matrix(row, column) = value.get<double>();
    }
  }
  return matrix;
}

Eigen::Matrix4d from_json(const ByteSource& source, std::string_view text) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    source.fail("not valid JSON: {}", error.what());
  }
  if (const auto matrix = as_matrix(json)) return *matrix;
  if (!json.is_object()) source.fail("the JSON is no 4x4 matrix of numbers");
  if (json.contains("T")) {
    if (const auto matrix = as_matrix(json["T"])) return *matrix;
    source.fail("the member 'T' is no 4x4 matrix of numbers");
  }
  std::optional<Eigen::Matrix4d> only;
  for (const Json& member : json) {
    const auto matrix = as_matrix(member);
    if (matrix && only) source.fail("several members are 4x4 matrices; name one of them 'T'");
    if (matrix) only = matrix;
  }
  if (!only) source.fail("no member is a 4x4 matrix of numbers");
  return *only;
}

void check_similarity(const ByteSource& source, const Eigen::Matrix4d& matrix) {
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    source.fail("the last row is {:g} {:g} {:g} {:g}; 0 0 0 1 expected (is the matrix column-major?)", matrix(3, 0),
                matrix(3, 1), matrix(3, 2), matrix(3, 3));
  }
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(linear.determinant());
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    source.fail("the determinant of the linear part is {:g}; a rotation times a positive scale expected",
                linear.determinant());
  }
  const Eigen::Matrix3d rotation = linear / scale;
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRotationTolerance)) {
    source.fail("the linear part deviates by {:g} from a rotation times a scale; {:g} accepted", deviation,
                kRotationTolerance);
  }
}

}  // namespace

Eigen::Matrix4d read_transform(const std::filesystem::path& path) {
  ByteSource source(path);
  const std::string text = read_all(source);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && (text[first] == '{' || text[first] == '[');
  const Eigen::Matrix4d matrix = json ? from_json(source, text) : from_text(source, text);
  if (!matrix.allFinite()) source.fail("a number of the matrix is not finite");
  check_similarity(source, matrix);
  return matrix;
}

std::string transform_text(const Eigen::Matrix4d& T) {
  std::string text;
  for (Eigen::Index row = 0; row < 4; ++row) {
    text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", T(row, 0), T(row, 1), T(row, 2), T(row, 3));
  }
  return text;
}

nlohmann::ordered_json transform_json(const Eigen::Matrix4d& T) {
  auto rows = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < 4; ++row) rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
  return rows;
}

}  // namespace cmap
