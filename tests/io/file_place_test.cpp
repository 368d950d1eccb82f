#include "cmap/io/file_place.hpp"

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace file_place_test {

namespace fs = std::filesystem;

/// Goes back at the end.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) { fs::current_path(folder); }
  ~WorkingFolder() { fs::current_path(before_); }

 private:
  fs::path before_ = fs::current_path();
};

TEST(PlaceOfFile, IsOneForEverySpelling) {
  const TempFolder folder;
  fs::create_directory(folder / "sub");
  const WorkingFolder inside(folder.path());
  const fs::path place = fs::canonical(folder.path()) / "a.ply";
  for (const char* spelling : {"a.ply", "./a.ply", ".//a.ply", "sub/../a.ply", "./sub/.././a.ply"}) {
    EXPECT_EQ(place_of_file(spelling), place) << spelling << ", before it is there";
  }
  EXPECT_EQ(place_of_file(folder / "a.ply"), place);
  folder.write("a.ply", "ply");
  for (const char* spelling : {"a.ply", "./a.ply", "sub/../a.ply"}) EXPECT_EQ(place_of_file(spelling), place);
  EXPECT_NE(place_of_file("b.ply"), place);
  EXPECT_NE(place_of_file("sub/a.ply"), place);
}

TEST(PlaceOfFile, FollowsLinksOfFilesAndFolders) {
  const TempFolder folder;
  const fs::path place = fs::canonical(folder.path()) / "a.ply";
  fs::create_symlink("a.ply", folder / "link.ply");
  fs::create_symlink("link.ply", folder / "link_to_link.ply");
  fs::create_directory_symlink(".", folder / "again");
  for (const char* name : {"link.ply", "link_to_link.ply", "again/a.ply", "again/link.ply"}) {
    EXPECT_EQ(place_of_file(folder / name), place) << name << ", which leads to nothing yet";
  }
  folder.write("a.ply", "ply");
  for (const char* name : {"link.ply", "link_to_link.ply", "again/link.ply"}) {
    EXPECT_EQ(place_of_file(folder / name), place) << name;
  }
}

TEST(PlaceOfFile, EndsWhereLinksDoNot) {
  const TempFolder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  EXPECT_NO_THROW(place_of_file(folder / "a"));
}

TEST(WhatIsThere, IsSaidOfNamesThatCannotBeLookedAt) {
  const TempFolder folder;
  folder.write("a.ply", "ply");
  EXPECT_TRUE(is_there(folder / "a.ply") && is_file(folder / "a.ply") && !is_folder(folder / "a.ply"));
  EXPECT_TRUE(is_there(folder.path()) && !is_file(folder.path()) && is_folder(folder.path()));
  const fs::path too_long = folder / std::string(300, 'a');
  EXPECT_FALSE(is_there(too_long) || is_file(too_long) || is_folder(too_long));
  EXPECT_EQ(paths_in(folder.path()), std::vector<fs::path>{folder / "a.ply"});
  EXPECT_THROW(paths_in(too_long), InputError);
}

}  // namespace file_place_test
}  // namespace cmap::testing
