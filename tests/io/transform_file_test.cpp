#include "cmap/io/transform_file.hpp"

#include <nlohmann/json.hpp>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace transform_file_test {

using ::testing::HasSubstr;

TransformFile read_content(std::string_view content) {
  const TempFolder folder;
  return read_transform(folder.write("T.txt", content));
}

std::string refusal(std::string_view content) {
  try {
    read_content(content);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("T.txt: "));
    return error.what();
  }
  return {};
}

/// A quarter turn about z, doubled, and a shift.
Eigen::Matrix4d expected() {
  Eigen::Matrix4d T;
  T << 0, -2, 0, 1, 2, 0, 0, 2.5, 0, 0, 2, -3, 0, 0, 0, 1;
  return T;
}
const std::string kJsonRows = "[[0,-2,0,1],[2,0,0,2.5],[0,0,2,-3],[0,0,0,1]]";
const std::string kRow16 = "0 -2 0 1 2 0 0 2.5 0 0 2 -3 0 0 0 1";
const std::string kColumns16 = "0 2 0 0 -2 0 0 0 0 0 2 0 1 2.5 -3 1";

void expect_read(std::string_view content) {
  const TransformFile file = read_content(content);
  EXPECT_EQ(file.T, expected()) << content;
  EXPECT_TRUE(file.warnings.empty()) << content;
}

TEST(TransformFile, Text) {
  for (const char* text :
       {"0 -2 0 1\n2 0 0 2.5\n0 0 2 -3\n0 0 0 1\n", "# T\n0, -2, 0, 1\n\n2 0 0 2.5 # row\r\n0;0;2;-3\n0\t0\t0\t1",
        "0 -2 0 1\n2 0 0 2.5\n0 0 2 -3\n", "0,-2,0,1,2,0,0,2.5,0,0,2,-3",
        "0 -2 0 1 \r\n2 0 0 2.5\t\r\n0 0 2 -3 \r\n\r\n"}) {
    expect_read(text);
  }
  expect_read(kRow16);
  std::string lines = kRow16;
  std::replace(lines.begin(), lines.end(), ' ', '\n');
  expect_read(lines);
}

TEST(TransformFile, AsProgramsPrintIt) {
  for (const char* text :
       {"[[ 0.  -2.   0.   1. ]\n [ 2.   0.   0.   2.5]\n [ 0.   0.   2.  -3. ]\n [ 0.   0.   0.   1. ]]\n",
        "array([[ 0. , -2. ,  0. ,  1. ],\n       [ 2. ,  0. ,  0. ,  2.5],\n       [ 0. ,  0. ,  2. , -3. ],\n"
        "       [ 0. ,  0. ,  0. ,  1. ]], dtype=float32)\n",
        "[[ 0.00000000e+00 -2.00000000e+00\n   0.00000000e+00  1.00000000e+00]\n [ 2.00000000e+00  0.00000000e+00\n"
        "   0.00000000e+00  2.50000000e+00]\n [ 0.00000000e+00  0.00000000e+00\n   2.00000000e+00 -3.00000000e+00]]",
        "[[np.float64(0.0), np.float64(-2.0), 0, 1], [2, 0, 0, 2.5], [0, 0, 2, -3], [0, 0, 0, 1]]",
        "tensor([[ 0.0, -2.0, 0.0, 1.0],\n        [2, 0, 0, 2.5],\n [0, 0, 2, -3],\n [0, 0, 0, 1]], device='cuda:0',\n"
        "       dtype=torch.float64)",
        "[[0 -2 0 1],\n [2 0 0 2.5],\n [0 0 2 -3],\n [0 0 0 1]]\nTensor[shape={4, 4}, stride={4, 1}, Float64, CPU:0, "
        "0x55d0]",
        "Matrix([[0, -2, 0, 1], [2, 0, 0, 2.5], [0, 0, 2, -3], [0, 0, 0, 1]])",
        "T = [0 -2 0 1; 2 0 0 2.5; 0 0 2 -3; 0 0 0 1];",
        "T =\n\n     0    -2     0     1.0\n     2     0     0     2.5\n"
        "     0     0     2    -3\n     0     0     0     1\n",
        "[0, -2, 0, 1;\n 2, 0, 0, 2.5;\n 0, 0, 2, -3;\n 0, 0, 0, 1]",
        "{{0, -2, 0, 1}, {2, 0, 0, 2.5}, {0, 0, 2, -3}, {0, 0, 0, 1}}",
        "T_ref_est: ((0, -2, 0, 1), (2, 0, 0, 2.5), (0, 0, 2, -3), (0, 0, 0, 1))",
        "[0.,-2.,0.,1.,2.,0.,0.,2.5,0.,0.,2.,-3.]"}) {
    expect_read(text);
  }
}

TEST(TransformFile, Json) {
  expect_read(kJsonRows);
  expect_read("\n {\"scale\": 2, \"T_ref_est\": " + kJsonRows + "}");
  expect_read("{\"a\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], \"T\": " + kJsonRows + "}");
  expect_read("[" + kJsonRows + "]");
  expect_read("{\"result\": {\"n\": [1,2,3], \"transformation\": " + kJsonRows + "}}");
  expect_read("[0,-2,0,1,2,0,0,2.5,0,0,2,-3,0,0,0,1]");
  expect_read("{\"T\": [0,-2,0,1,2,0,0,2.5,0,0,2,-3]}");
  expect_read("{\"values\": [1,2,3,4,5,6,7,8,9,10,11,12], \"pose\": [[0,-2,0,1],[2,0,0,2.5],[0,0,2,-3]]}");
  // evo's: half a turn about x by its quaternion, and the scale.
  Eigen::Matrix4d T = Eigen::Vector4d(3, -3, -3, 1).asDiagonal();
  T.col(3) << 1, 2, 4, 1;
  EXPECT_TRUE(
      read_content("{\"x\":1,\"y\":2,\"z\":4,\"qx\":2,\"qy\":0,\"qz\":0,\"qw\":0,\"scale\":3}").T.isApprox(T, 1e-15));
}

TEST(TransformFile, ByteOrderMarkAndLineEnds) {
  expect_read("\xEF\xBB\xBF" + kRow16);
  expect_read("\xEF\xBB\xBF" + kJsonRows);
  expect_read("\xEF\xBB\xBF[[0 -2 0 1]\r\n [2 0 0 2.5]\r\n [0 0 2 -3]\r\n [0 0 0 1]]\r\n");
  EXPECT_THAT(refusal(std::string("\xFF\xFE\x31\x00\x20\x00", 6)), HasSubstr("UTF-16"));
}

TEST(TransformFile, Log) {
  const std::string pose = "0 -2 0 1\n2 0 0 2.5\n0 0 2 -3\n0 0 0 1\n";
  expect_read("0 0 1\n" + pose);
  EXPECT_THAT(refusal("0 0 0\n" + pose + "1 1 0\n" + pose), HasSubstr("a .log of 2 poses"));
  EXPECT_THAT(refusal("0 0 0\n" + pose + "1 1 0\n0 -2 0 1\n"), HasSubstr("numbers; a transform has 16"));
}

std::string npy(std::string_view shape, std::vector<double> values, std::string_view order = "False") {
  std::string header =
      "{'descr': '<f8', 'fortran_order': " + std::string(order) + ", 'shape': " + std::string(shape) + ", }\n";
  Bytes bytes("\x93NUMPY");
  bytes.put(std::uint8_t{1}, std::uint8_t{0}, static_cast<std::uint16_t>(header.size())).text(header);
  for (const double value : values) bytes.put(value);
  return bytes.str();
}

TEST(TransformFile, Npy) {
  const std::vector<double> upper{0, -2, 0, 1, 2, 0, 0, 2.5, 0, 0, 2, -3};
  std::vector<double> all = upper;
  all.insert(all.end(), {0, 0, 0, 1});
  for (const char* shape : {"(4, 4)", "(1, 4, 4)", "(16,)", "(1, 16)"}) expect_read(npy(shape, all));
  for (const char* shape : {"(3, 4)", "(12,)"}) expect_read(npy(shape, upper));
  // Eigen's matrices, which Open3D's Python hands out, lie column by column.
  expect_read(npy("(4, 4)", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 1, 2.5, -3, 1}, "True"));
  std::vector<double> two = all;
  two.insert(two.end(), all.begin(), all.end());
  EXPECT_THAT(refusal(npy("(2, 4, 4)", two)), HasSubstr("2 matrices"));
  EXPECT_THAT(refusal(npy("(4, 3)", upper)), HasSubstr("4 rows of 3 numbers"));
  EXPECT_THAT(refusal(npy("(5,)", {1, 2, 3, 4, 5})), HasSubstr("5 numbers"));
  EXPECT_THAT(refusal(npy("(4, 4)", upper)), HasSubstr("(4, 4)"));
  all[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(npy("(4, 4)", all)), HasSubstr("not finite"));
}

TEST(TransformFile, ColumnMajorListsAreReadAndSaid) {
  std::string json = "[" + kColumns16 + "]";
  std::replace(json.begin(), json.end(), ' ', ',');
  for (const std::string& content : {kColumns16, json, "{\"parameters\": {\"extrinsic\": " + json + "}}"}) {
    const TransformFile file = read_content(content);
    EXPECT_EQ(file.T, expected()) << content;
    ASSERT_EQ(file.warnings.size(), 1U) << content;
    EXPECT_EQ(file.warnings[0].id, "transform_column_major");
    EXPECT_THAT(file.warnings[0].message, HasSubstr("T.txt"));
  }
  // Without a translation only the name tells.
  const std::string turn = "[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,0,1]";
  EXPECT_EQ(read_content(turn).T(0, 1), 1.0);
  EXPECT_EQ(read_content("{\"extrinsic\": " + turn + "}").T(0, 1), -1.0);
}

TEST(TransformFile, NamesThatSayTheOtherDirectionAreRefused) {
  for (const char* name : {"T_est_ref", "ref_to_est", "gt2est", "refToEst", "T_estimate_reference", "est_from_ref",
                           "est_T_ref", "transform_est_gt", "truth_to_estimate"}) {
    EXPECT_THAT(
        refusal("{\"" + std::string(name) + "\": " + kJsonRows + "}"),
        ::testing::AllOf(HasSubstr("the name '" + std::string(name) + "' says"), HasSubstr("numpy.linalg.inv")));
    EXPECT_THAT(refusal(std::string(name) + " =\n" + kRow16), HasSubstr("the name '" + std::string(name) + "' says"));
  }
  EXPECT_THAT(refusal("{\"poses\": {\"T_est_ref\": " + kJsonRows + "}}"), HasSubstr("the name 'poses.T_est_ref'"));
  for (const char* name :
       {"T_ref_est", "est_to_ref", "T", "transformation", "T_lidar_camera", "estimate", "T_est", "latest"}) {
    EXPECT_EQ(read_content("{\"" + std::string(name) + "\": " + kJsonRows + "}").T, expected()) << name;
  }
}

TEST(TransformFile, ComputedMatricesAreAMillionthOff) {
  const TransformFile file = read_content("1 0 0 5\n0 1 0 0\n0 0 1 0\n1e-17 -9e-7 0 0.9999995\n");
  EXPECT_EQ(file.T.row(3), Eigen::RowVector4d(0, 0, 0, 1));
  EXPECT_THAT(refusal("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1.00001\n"), HasSubstr("the last row is 0 0 0 1.00001"));
}

TEST(TransformFile, RotationNeedsNoMoreThanPrintedDigits) {
  EXPECT_EQ(read_content("0.7071 -0.7071 0 0 0.7071 0.7071 0 0 0 0 1 0 0 0 0 1").T(0, 0), 0.7071);
}

TEST(TransformFile, SaysWhatIsWrong) {
  const std::string row12 = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::pair<std::string, std::string> kCases[] = {
      {"1 2 3\n", "3 numbers; a transform has 16"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n5\n", "17 numbers; a transform has 16"},
      {"1 0 0 0\n0 one 0 0\n", "line 2: 'one' is not a number"},
      {"1 0 0 nan\n", "line 1: 'nan' is not finite"},
      {"1 0 0 1.#QNAN\n", "line 1: '1.#QNAN' is not finite"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n", "the last row is 5 6 7 1"},
      {"-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "the determinant of the linear part is -1"},
      {"0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n", "the determinant of the linear part is 0"},
      {"1 0 0 0\n0 1.1 0 0\n0 0 1 0\n0 0 0 1\n", "deviates by"},
      {"1 0 0\n0 1 0\n0 0 1\n5 6 7\n", "4 rows of 3 numbers"},
      {"[[1. 0. 0.] [0. 1. 0.] [0. 0. 1.] [5. 6. 7.]]", "4 rows of 3 numbers"},
      {"1 0 0\n0 1 0\n0 0 1\n", "9 numbers, as of a rotation"},
      {"1 2 3 0 0 0 1\n", "7 numbers, as of a pose with its quaternion"},
      {"5.5 1 2 3 0 0 0 1\n", "8 numbers, as of a pose with its quaternion"},
      {"0 1 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n", "2 rows of 8 numbers are the poses of a trajectory"},
      {row12 + row12, "2 rows of 12 numbers are the poses of a trajectory"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "2 matrices"},
      {"1,0 0,0 0,0 0,5\n0,0 1,0 0,0 0,0\n0,0 0,0 1,0 0,0\n0,0 0,0 0,0 1,0\n", "line 1: decimal commas"},
      {"1;0;0;0,5\n0;1;0;0\n0;0;1;0\n0;0;0;1\n", "line 1: decimal commas"},
      {"[[1. 0. ... 0. 0.]\n ...\n [0. 0. ... 0. 1.]]", "abbreviated"},
      {"T =\n\n   1.0e+03 *\n\n 0.001 0 0 2\n0 0.001 0 0\n0 0 0.001 0\n0 0 0 0.001\n", "a factor before the matrix"},
      {"%YAML:1.0\nT: !!opencv-matrix\n  rows: 4\n  cols: 4\n", "OpenCV"},
      {"PK\x03\x04", "is an archive"},
      {std::string("\x00\x01\x02", 3), "is no text"},
      {"[[1,2],[3,4]]", "no 4x4"},
      {"[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,\"1\"]]", "no 4x4"},
      {"{\"T\": 1}", "the member 'T'"},
      {"{\"a\": 1}", "holds no 4x4"},
      {"{\"a\": " + kJsonRows + ", \"b\": {\"c\": " + kJsonRows + "}}", "2 matrices ('a', 'b.c')"},
      {"[" + kJsonRows + "," + kJsonRows + "]", "2 matrices"},
      {"{\"T\": " + kJsonRows + ", \"T\": " + kJsonRows + "}", "given twice"},
      {"{\"x\":1,\"y\":2,\"z\":4,\"qx\":0,\"qy\":0,\"qz\":0,\"qw\":0}", "quaternion has length 0"},
      {"{\"a\": ", "parse error"},
      {"[1e999]", "not finite"},
      {std::string(300000, '['), "longer than"},
      {std::string(2 << 20, ' '), "too many for a transform"},
      {"# nothing\n", "0 numbers"},
      {"", "the file is empty"},
  };
  for (const auto& [content, message] : kCases)
    EXPECT_THAT(refusal(content), HasSubstr(message)) << content.substr(0, 80);
  EXPECT_THROW(read_transform("/no/such/T.txt"), InputError);
}

/// JSON's arrays nest deeper than anybody's transform; reading them must not nest as deep.
TEST(TransformFile, DeepJsonIsRefused) {
  EXPECT_THAT(refusal(std::string(100000, '[') + std::string(100000, ']')), HasSubstr("no 4x4"));
}

TEST(TransformFile, WrittenAndReadBackIsIdentical) {
  Eigen::Matrix4d T = expected();
  T(0, 3) = 1.0 / 3;
  EXPECT_EQ(read_content(transform_text(T)).T, T);
  EXPECT_EQ(read_content(transform_json(T).dump()).T, T);
}

}  // namespace transform_file_test
}  // namespace cmap::testing
