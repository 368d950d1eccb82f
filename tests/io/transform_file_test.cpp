#include "cmap/io/transform_file.hpp"

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

using ::testing::HasSubstr;

Eigen::Matrix4d read_content(std::string_view content) {
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

TEST(TransformFile, Text) {
  for (const char* text :
       {"0 -2 0 1\n2 0 0 2.5\n0 0 2 -3\n0 0 0 1\n", "# T\n0, -2, 0, 1\n\n2 0 0 2.5 # row\r\n0;0;2;-3\n0\t0\t0\t1",
        "0 -2 0 1 2 0 0 2.5 0 0 2 -3 0 0 0 1"}) {
    EXPECT_EQ(read_content(text), expected()) << text;
  }
}

TEST(TransformFile, Json) {
  EXPECT_EQ(read_content(kJsonRows), expected());
  EXPECT_EQ(read_content("\n {\"scale\": 2, \"T_ref_est\": " + kJsonRows + "}"), expected());
  EXPECT_EQ(read_content("{\"a\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], \"T\": " + kJsonRows + "}"), expected());
}

TEST(TransformFile, RotationNeedsNoMoreThanPrintedDigits) {
  EXPECT_EQ(read_content("0.7071 -0.7071 0 0 0.7071 0.7071 0 0 0 0 1 0 0 0 0 1")(0, 0), 0.7071);
}

TEST(TransformFile, SaysWhatIsWrong) {
  const std::pair<std::string, std::string> kCases[] = {
      {"1 2 3\n", "the file ends after 3 numbers"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n5\n", "line 5: more than the 16 numbers"},
      {"1 0 0 0\n0 one 0 0\n", "line 2: 'one' is not a number"},
      {"1 0 0 nan\n", "line 1: 'nan' is not finite"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n", "the last row is 5 6 7 1"},
      {"-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "the determinant of the linear part is -1"},
      {"0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n", "the determinant of the linear part is 0"},
      {"1 0 0 0\n0 1.1 0 0\n0 0 1 0\n0 0 0 1\n", "deviates by"},
      {"[[1,2],[3,4]]", "no 4x4 matrix"},
      {"[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,\"1\"]]", "no 4x4 matrix"},
      {"{\"T\": 1}", "the member 'T'"},
      {"{\"a\": 1}", "no member is a 4x4 matrix"},
      {"{\"a\": " + kJsonRows + ", \"b\": " + kJsonRows + "}", "several members"},
      {"{\"a\": ", "not valid JSON"},
      {"[1e999]", "not valid JSON"},
      {std::string(2 << 20, ' '), "too many for a transform"},
      {"", "the file is empty"},
  };
  for (const auto& [content, message] : kCases)
    EXPECT_THAT(refusal(content), HasSubstr(message)) << content.substr(0, 80);
  EXPECT_THROW(read_transform("/no/such/T.txt"), InputError);
}

}  // namespace
}  // namespace cmap::testing
