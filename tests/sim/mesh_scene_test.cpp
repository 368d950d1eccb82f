#include <cmath>

#include "sim/sim_testing.hpp"

namespace cmap {
namespace mesh_scene_test {

using ::testing::AllOf;
using testing::Bytes;
using ::testing::HasSubstr;
using testing::TempFolder;
using ::testing::ThrowsMessage;

constexpr const char* kPlyHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// A unit square whose red grows with x and green with y.
std::string ascii_ply() {
  return std::string("ply\nformat ascii 1.0\n") + kPlyHeader +
         "0 0 0 0 0 51\n1 0 0 255 0 51\n1 1 0 255 255 51\n0 1 0 0 255 51\n4 0 1 2 3\n";
}

std::string binary_ply(bool big_endian) {
  Bytes bytes(
      std::string(big_endian ? "ply\nformat binary_big_endian 1.0\n" : "ply\nformat binary_little_endian 1.0\n") +
          kPlyHeader,
      big_endian);
  const auto vertex = [&](float x, float y, std::uint8_t r, std::uint8_t g) {
    bytes.put(x, y, 0.0F, r, g, std::uint8_t{51});
  };
  vertex(0, 0, 0, 0);
  vertex(1, 0, 255, 0);
  vertex(1, 1, 255, 255);
  vertex(0, 1, 0, 255);
  bytes.put(std::uint8_t{4}, 0, 1, 2, 3);
  return bytes.str();
}

RgbF color_below(const Scene& scene, double x, double y) {
  const auto hit = scene.cast({x, y, 2.0}, -Eigen::Vector3d::UnitZ(), 10.0);
  EXPECT_TRUE(hit);
  if (!hit) return {};
  EXPECT_NEAR(2.0, hit->distance_m, 1e-9);
  return hit->color;
}

TEST(PlyMesh, ColorsAreInterpolatedInEveryEncoding) {
  const TempFolder folder;
  for (const std::string& text : {ascii_ply(), binary_ply(false), binary_ply(true)}) {
    const Scene scene = read_mesh_scene(folder.write("square.ply", text));
    for (const auto& [x, y] : {std::pair{0.25, 0.5}, {0.8, 0.1}, {0.1, 0.9}}) {
      const RgbF color = color_below(scene, x, y);
      EXPECT_NEAR(x, color[0], 1e-6);
      EXPECT_NEAR(y, color[1], 1e-6);
      EXPECT_NEAR(0.2, color[2], 1e-6);
    }
  }
}

TEST(ObjMesh, TakesTheImageOfItsMaterial) {
  const TempFolder folder;
  // 2 x 2 pixels: red green / blue white. v of OBJ runs upward.
  folder.write("image.ppm", std::string("P6\n2 2\n255\n") + std::string("\xff\0\0\0\xff\0\0\0\xff\xff\xff\xff", 12));
  folder.write("square.mtl", "newmtl photo\nKd 1 1 1\nmap_Kd image.ppm\nnewmtl flat\nKd 0.25 0.5 0.75\n");
  const Scene scene =
      read_mesh_scene(folder.write("square.obj",
                                   "mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 "
                                   "0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                   "usemtl photo\nf 1/1 2/2 3/3 4/4\nusemtl flat # plain\nf -3 -2 -1\n"));
  const auto expect_color = [&](double x, double y, const RgbF& expected) {
    const RgbF color = color_below(scene, x, y);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(expected[c], color[c], 1e-5) << x << " " << y;
  };
  expect_color(0.25, 0.75, {1, 0, 0});
  expect_color(0.75, 0.75, {0, 1, 0});
  expect_color(0.25, 0.25, {0, 0, 1});
  expect_color(0.75, 0.25, {1, 1, 1});
  expect_color(0.5, 0.75, {0.5F, 0.5F, 0});  // halfway between pixel centers
  expect_color(5.2, 0.2, {0.25F, 0.5F, 0.75F});
}

TEST(ObjMesh, IsGrayWithoutColorsAndLit) {
  const TempFolder folder;
  const Scene scene = read_mesh_scene(folder.write("roof.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  const RgbF color = color_below(scene, 0.2, 0.2);
  EXPECT_GT(color[1], 0.3F);
  EXPECT_NEAR(color[0], color[1], 0.05);
  EXPECT_EQ(0.0, scene.ground_height_m(0.2, 0.2));
  EXPECT_TRUE(scene.routes().empty());
}

TEST(MeshScene, GroundIsTheLowestSurface) {
  const TempFolder folder;
  const Scene scene = read_mesh_scene(folder.write("box.obj", testing::box_obj({0, 0, 5}, {1, 1, 7})));
  EXPECT_NEAR(5.0, scene.ground_height_m(0.4, 0.5), 1e-9);
  EXPECT_EQ(5.0, scene.ground_height_m(3.0, 3.0));
}

TEST(MeshScene, ErrorsNameFileAndPlace) {
  const TempFolder folder;
  const auto expect_error = [&](const char* name, const std::string& text, const char* place, const char* reason) {
    const auto file = folder.write(name, text);
    EXPECT_THAT([&] { read_mesh_scene(file); },
                ThrowsMessage<InputError>(AllOf(HasSubstr(name), HasSubstr(place), HasSubstr(reason))))
        << text;
  };
  expect_error("a.obj", "v 0 0\n", "line 1", "''");
  expect_error("b.obj", "v 0 0 0\nv 1 0 x\n", "line 2", "'x'");
  expect_error("c.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "line 3", "2 corners");
  expect_error("d.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n", "line 4", "no vertex 4");
  expect_error("e.obj", "v 0 0 0\nf 1 -2 1\n", "line 2", "no vertex -2");
  expect_error("f.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n", "line 4", "no texture point 1");
  expect_error("g.obj", "v 0 0 nan\n", "line 1", "nan");
  expect_error("h.obj", "v 0 0 0\n\nusemtl x\n", "line 3", "no material 'x'");
  expect_error("i.obj", "v 0 0 0 2 0 0\n", "line 1", "color");
  expect_error("j.obj", "v 0 0 0\n", "j.obj", "no faces");
  const auto without_materials = folder.write("k.obj", "mtllib none.mtl\n");
  EXPECT_THAT([&] { read_mesh_scene(without_materials); },
              ThrowsMessage<InputError>(HasSubstr("none.mtl: no such file")));
  std::string text = ascii_ply();
  expect_error("a.ply", text.substr(0, text.size() - 10), "truncated", "face");
  text.replace(text.find("4 0 1 2 3"), 9, "4 0 1 2 4");
  expect_error("b.ply", text, "line 17", "no vertex 4");
  text.replace(text.find("4 0 1 2 4"), 9, "2 0 1    ");
  expect_error("c.ply", text, "line 17", "2 corners");
  const std::string binary = binary_ply(false);
  expect_error("d.ply", binary.substr(0, binary.size() - 3), "d.ply", "truncated");
  std::string wrong = binary;
  wrong[wrong.size() - 1] = 1;
  expect_error("e.ply", wrong, "byte", "no vertex");
  EXPECT_THAT([&] { read_mesh_scene(folder.write("mesh.stl", "x")); }, ThrowsMessage<UsageError>(HasSubstr(".obj")));
}

}  // namespace mesh_scene_test
}  // namespace cmap
