// Matrices as people have them in text: rows of numbers, and what NumPy, PyTorch, MATLAB, Octave and Eigen print.

#include <algorithm>
#include <array>
#include <cmath>

#include "bytes/decimal_comma.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"
#include "poses/transform_numbers.hpp"

namespace cmap {
namespace {

using namespace std::string_view_literals;

/// Words around a printed matrix that say nothing about its numbers.
constexpr std::array kWords{"array"sv,         "matrix"sv,        "tensor"sv,       "np.array"sv,   "numpy.array"sv,
                            "np.matrix"sv,     "numpy.matrix"sv,  "torch.tensor"sv, "np.float32"sv, "np.float64"sv,
                            "numpy.float32"sv, "numpy.float64"sv, "float32"sv,      "float64"sv,    "torch.float32"sv,
                            "torch.float64"sv, "Matrix"sv,        "Matrix4d"sv,     "Matrix4f"sv};

bool is_word(std::string_view token) {
  const char c = token.front();
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

class PrintedMatrix {
 public:
  explicit PrintedMatrix(LineReader& lines) : lines_(lines) {}

  void add_line(std::string_view line) {
    if (line.starts_with("Tensor[")) return;  // Open3D's last line: shape, stride, type, device
    if (has_decimal_commas(line)) lines_.fail("decimal commas; write the numbers with points");
    while (!line.empty()) {
      const char c = line.front();
      if (c == '\'' || c == '"') {
        skip_quoted(line);
      } else if (is_blank(c) || ",()=:"sv.find(c) != std::string_view::npos) {
        line.remove_prefix(1);
      } else if ("[]{};"sv.find(c) != std::string_view::npos) {
        bracket(c);
        line.remove_prefix(1);
      } else {
        take_token(line);
      }
    }
    if (depth_ < 2) end_row();  // NumPy wraps long rows, within two brackets
  }

  TransformNumbers take() {
    end_row();
    return std::move(numbers_);
  }

 private:
  void bracket(char c) {
    if (c == '[' || c == '{') {
      ++depth_;
    } else {
      depth_ -= c != ';';
      end_row();
    }
  }

  void end_row() {
    if (n_in_row_ > 0) numbers_.rows.push_back(n_in_row_);
    n_in_row_ = 0;
  }

  /// A text between quotes (device='cuda:0') is none of the numbers.
  void skip_quoted(std::string_view& line) const {
    const std::size_t end = line.find(line.front(), 1);
    if (end == std::string_view::npos) lines_.fail("a quotation mark without its partner; a matrix expected");
    line.remove_prefix(end + 1);
  }

  void take_token(std::string_view& line) {
    const std::size_t end = std::min(line.size(), line.find_first_of(" \t\v\f\r,;()[]{}=:'\""));
    const std::string_view token = line.substr(0, end);
    line.remove_prefix(end);
    double value = 0.0;
    if (!parse_number(token, value)) return take_word(token, line);
    if (!std::isfinite(value)) lines_.fail("'{}' is not finite", token.substr(0, 40));
    numbers_.values.push_back(value);
    ++n_in_row_;
  }

  /// A name before '=' or ':' is a label; other words must be known.
  void take_word(std::string_view token, std::string_view rest) const {
    if (token.find("...") != std::string_view::npos) {
      lines_.fail("the matrix is abbreviated with '...'; write all of it (numpy.savetxt)");
    }
    if (token == "*") {
      lines_.fail("a factor before the matrix, as MATLAB prints it; 'format long g' prints the numbers themselves");
    }
    const std::size_t next = rest.find_first_not_of(" \t");
    const bool is_label = next != std::string_view::npos && (rest[next] == '=' || rest[next] == ':');
    const bool is_known = std::find(kWords.begin(), kWords.end(), token) != kWords.end();
    if (is_label && names_reference_to_estimate(token)) {
      lines_.fail("{}", reference_to_estimate_error(token.substr(0, 40), "numpy.linalg.inv"));
    }
    if (!is_known && !(is_word(token) && is_label)) lines_.fail("'{}' is not a number", token.substr(0, 40));
  }

  LineReader& lines_;
  TransformNumbers numbers_;
  std::size_t n_in_row_ = 0;
  int depth_ = 0;  ///< of brackets and braces
};

bool is_whole_number(double value) { return value == std::floor(value); }

/// COLMAP's and Open3D's .log: before each pose's four rows a line of three whole numbers.
void take_log(const ByteSource& source, TransformNumbers& numbers) {
  constexpr std::array<std::size_t, 5> kPose{3, 4, 4, 4, 4};
  const std::vector<std::size_t>& rows = numbers.rows;
  if (rows.empty() || rows.size() % kPose.size() != 0) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] != kPose[i % kPose.size()]) return;
  }
  if (!std::all_of(numbers.values.begin(), numbers.values.begin() + 3, is_whole_number)) return;
  if (const std::size_t n = rows.size() / kPose.size(); n > 1) {
    source.fail("a .log of {} poses; a transform is one: keep its four rows", n);
  }
  numbers.values.erase(numbers.values.begin(), numbers.values.begin() + 3);
  numbers.rows.erase(numbers.rows.begin());
}

}  // namespace

TransformNumbers transform_from_text(const ByteSource& source, std::string_view text) {
  if (text.find("opencv-matrix") != std::string_view::npos) {
    source.fail("a matrix in OpenCV's YAML or XML; the 16 numbers of its data alone can be read");
  }
  ByteSource bytes(source.name(), std::as_bytes(std::span(text)));
  LineReader lines(bytes);
  PrintedMatrix matrix(lines);
  for (std::string_view line; lines.next(line);) matrix.add_line(without_comment(line));
  TransformNumbers numbers = matrix.take();
  take_log(source, numbers);
  return numbers;
}

}  // namespace cmap
