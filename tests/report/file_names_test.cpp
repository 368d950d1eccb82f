#include "cmap/report/file_names.hpp"

#include <gtest/gtest.h>

namespace cmap {
namespace file_names_test {

TEST(WithFileNames, AbsolutePathsLoseTheirFolders) {
  const auto expect = [](const char* text, const char* wanted) { EXPECT_EQ(with_file_names(text), wanted) << text; };
  expect("/home/ann/maps/a.ply", "a.ply");
  expect("cmap_eval /home/ann/a.ply ../b.ply -o /tmp/r.json", "cmap_eval a.ply ../b.ply -o r.json");
  expect("cmap_eval '/home/ann lee/my map.ply' --transform=/home/ann/T.txt",
         "cmap_eval 'my map.ply' --transform=T.txt");
  expect("read \"/home/ann/a b.csv\" (/home/ann/c.txt), /home/ann/d.txt: bad", "read \"a b.csv\" (c.txt), d.txt: bad");
  expect("--observed-from /home/ann/capture/", "--observed-from capture/");
}

TEST(WithFileNames, EverythingElseStays) {
  for (const char* text : {"maps/a.ply", "/a.ply", "1 m/s", "n / total", "a and/or b", "/", "",
                           "https://example.org/a/b", "see //host/share/x"}) {
    EXPECT_EQ(with_file_names(text), text);
  }
}

TEST(SharedReport, NamesFilesInAllItsTexts) {
  const nlohmann::ordered_json report{
      {"inputs", {{"reference", {{"path", "/home/ann lee/maps of may/a.ply"}, {"points", 3}}}}},
      {"warnings", {{{"message", "/home/ann lee/maps of may/a.offset.txt names a shift"}}}},
      {"run", {{"command", "cmap_eval '/home/ann lee/maps of may/a.ply'"}, {"threads", 2}}}};
  const nlohmann::ordered_json shared{{"inputs", {{"reference", {{"path", "a.ply"}, {"points", 3}}}}},
                                      {"warnings", {{{"message", "a.offset.txt names a shift"}}}},
                                      {"run", {{"command", "cmap_eval 'a.ply'"}, {"threads", 2}}}};
  EXPECT_EQ(shared_report(report), shared);
}

}  // namespace file_names_test
}  // namespace cmap
