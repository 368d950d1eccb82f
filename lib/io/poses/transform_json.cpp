#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "bytes/input_json.hpp"
#include "poses/transform_numbers.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Deeper ones are no transform that anybody wrote.
constexpr int kMostLevels = 32;

struct FoundMatrix {
  std::string place;  ///< "poses.0.T"
  TransformNumbers numbers;
};

bool are_numbers(const Json& json) {
  return json.is_array() && std::all_of(json.begin(), json.end(), [](const Json& n) { return n.is_number(); });
}

void append(const Json& list, TransformNumbers& numbers) {
  for (const Json& value : list) numbers.values.push_back(value.get<double>());
  numbers.rows.push_back(list.size());
}

/// Three or four lists of four numbers, or one list of 12 or 16.
std::optional<TransformNumbers> as_matrix(const Json& json) {
  if (!json.is_array()) return std::nullopt;
  TransformNumbers numbers;
  if (are_numbers(json)) {
    if (json.size() != 12 && json.size() != 16) return std::nullopt;
    append(json, numbers);
    return numbers;
  }
  if (json.size() != 3 && json.size() != 4) return std::nullopt;
  for (const Json& row : json) {
    if (!are_numbers(row) || row.size() != 4) return std::nullopt;
    append(row, numbers);
  }
  return numbers;
}

void find_matrices(const Json& json, const std::string& place, int level, std::vector<FoundMatrix>& found) {
  if (auto numbers = as_matrix(json)) {
    found.push_back({place, std::move(*numbers)});
  } else if (json.is_structured() && level < kMostLevels) {
    for (const auto& [key, value] : json.items()) {
      find_matrices(value, place.empty() ? key : place + "." + key, level + 1, found);
    }
  }
}

/// evo's --transform_left: x y z qx qy qz qw and scale.
std::optional<TransformNumbers> as_pose(const Json& json) {
  constexpr std::array kNames{"x", "y", "z", "qx", "qy", "qz", "qw"};
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (!json.is_object() || !json.contains(kNames[i])) return std::nullopt;
    v[i] = finite_number(json[kNames[i]], kNames[i]);
  }
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (!(rotation.norm() > 1e-6)) throw UsageError(fmt::format("the quaternion has length {:g}", rotation.norm()));
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T;
  T.leftCols<3>() =
      (json.contains("scale") ? finite_number(json["scale"], "scale") : 1.0) * rotation.normalized().toRotationMatrix();
  T.col(3) = Eigen::Vector3d(v[0], v[1], v[2]);
  return TransformNumbers{{T.data(), T.data() + T.size()}, {4, 4, 4}, false};
}

/// Open3D's cameras and three.js write their lists column by column.
bool is_column_major(const FoundMatrix& matrix) {
  return matrix.numbers.rows.size() == 1 && (matrix.place.ends_with("extrinsic") || matrix.place.ends_with("elements"));
}

/// Refuses a matrix whose name says that it maps the other way.
void require_direction(const FoundMatrix& matrix, const Json& json) {
  const std::string name = matrix.place.substr(matrix.place.rfind('.') + 1);
  if (!names_reference_to_estimate(name)) return;
  const bool is_simple = name == matrix.place && json.is_object() && matrix.numbers.rows.size() == 4;
  throw UsageError(reference_to_estimate_error(
      matrix.place, is_simple ? fmt::format("python3 -c \"import json, numpy; numpy.savetxt('T_ref_est.txt', "
                                            "numpy.linalg.inv(json.load(open('FILE'))['{}']))\" writes it",
                                            name)
                              : "numpy.linalg.inv"));
}

TransformNumbers only_matrix(const Json& json) {
  if (json.is_object() && json.contains("T")) {
    if (auto numbers = as_matrix(json["T"])) return *numbers;
    throw UsageError("the member 'T' is no 4x4 matrix of numbers");
  }
  if (auto numbers = as_pose(json)) return *numbers;
  std::vector<FoundMatrix> found;
  find_matrices(json, "", 0, found);
  // Lists of 12 or 16 numbers beside a matrix in rows are something else.
  const auto in_rows = [](const FoundMatrix& matrix) { return matrix.numbers.rows.size() > 1; };
  if (std::any_of(found.begin(), found.end(), in_rows)) std::erase_if(found, std::not_fn(in_rows));
  if (found.empty()) {
    throw UsageError("the JSON holds no 4x4 or 3x4 matrix of numbers, in rows or in one list (row-major)");
  }
  if (found.size() > 1) {
    throw UsageError(fmt::format("the JSON holds {} matrices ('{}', '{}'); keep one, or name one of them 'T'",
                                 found.size(), found[0].place, found[1].place));
  }
  require_direction(found.front(), json);
  found.front().numbers.column_major = is_column_major(found.front());
  return std::move(found.front().numbers);
}

}  // namespace

TransformNumbers transform_from_json(const ByteSource& source, const std::string& text) {
  TransformNumbers numbers;
  read_input_json(text, source.name(), [&](const Json& json) { numbers = only_matrix(json); });
  return numbers;
}

}  // namespace cmap
