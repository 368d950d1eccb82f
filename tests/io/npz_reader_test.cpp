#include "io/npy_testing.hpp"

namespace cmap::testing {
namespace npz_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Members = std::vector<std::pair<std::string, std::string>>;

PointCloudFile read(Members members, bool deflate = true) {
  for (auto& member : members) member.first += ".npy";
  return read_content("a.npz", ZipText{deflate, false, std::move(members)}.str());
}
std::string refused(Members members) {
  for (auto& member : members) member.first += ".npy";
  return refusal("a.npz", ZipText{false, false, std::move(members)}.str());
}

std::string points(std::string_view shape, std::size_t n) { return npy_text("'<f4'", shape, point_bytes<float>(n)); }
std::string colors(std::string_view shape, std::size_t n) { return npy_text("'|u1'", shape, color_bytes<U8>(n)); }

/// Colors in planes: all red of a frame, all green, all blue, then the next frame.
template <class T>
std::string planes(std::size_t frames, std::size_t pixels, double scale) {
  std::vector<T> values;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < pixels; ++i) {
        values.push_back(static_cast<T>(scale * sample_color(frame * pixels + i)[k]));
      }
    }
  }
  return raw(values);
}

TEST(NpzCloud, PointsAndColorsByTheirUsualNames) {
  const std::pair<const char*, const char*> kNames[] = {
      {"points", "colors"},       {"xyz", "rgb"},
      {"positions", "colors"},    {"Points", "Colors"},
      {"pointcloud", "color"},    {"XYZ", "RGB"},
      {"position", "colours"},    {"vertices", "vertex_colors"},
      {"world_points", "images"}, {"pts3d", "rgb"},
      {"point", "color"},         {"coords", "colour"},
      {"point_cloud", "image"},   {"world_points_from_depth", "images"}};
  for (const auto& [xyz, rgb] : kNames) {
    SCOPED_TRACE(xyz);
    expect_samples(read({{xyz, points("(6, 3)", 6)}, {rgb, colors("(6, 3)", 6)}}), 6, true);
    expect_samples(read({{rgb, colors("(6, 3)", 6)}, {xyz, points("(6, 3)", 6)}}, false), 6, true);
  }
}

TEST(NpzCloud, ColorsOfEveryTypeAndShape) {
  const auto with = [](const std::string& colors_array, std::string_view point_shape = "(6, 3)") {
    return read({{"points", points(point_shape, 6)}, {"colors", colors_array}});
  };
  expect_samples(with(npy_text("'<f4'", "(6, 3)", color_bytes<float>(6, 1.0 / 255))), 6, true);
  expect_samples(with(npy_text("'<f8'", "(6, 3)", color_bytes<double>(6, 1.0 / 255))), 6, true);
  expect_samples(with(npy_text("'<f4'", "(6, 3)", color_bytes<float>(6))), 6, true);
  expect_samples(with(npy_text("'<i8'", "(6, 3)", color_bytes<std::int64_t>(6))), 6, true);
  expect_samples(with(npy_text("'<u2'", "(6, 3)", color_bytes<U16>(6, 257))), 6, true);
  expect_samples(with(colors("(1, 6, 3)", 6)), 6, true);
  expect_samples(with(colors("(2, 3, 3)", 6)), 6, true);
  expect_samples(with(colors("(6, 3)", 6), "(2, 3, 3)"), 6, true);
  expect_samples(with(colors("(2, 3, 3)", 6), "(2, 3, 3)"), 6, true);
  expect_samples(with(npy_text("'|u1'", "(3, 6)", planes<U8>(1, 6, 1))), 6, true);
  expect_samples(with(npy_text("'|u1'", "(3, 2, 3)", planes<U8>(1, 6, 1)), "(2, 3, 3)"), 6, true);
  expect_samples(with(npy_text("'<f8'", "(2, 3, 1, 3)", planes<double>(2, 3, 1.0 / 255)), "(2, 1, 3, 3)"), 6, true);
  expect_samples(with(npy_text("'<f4'", "(6, 3)", planes<float>(1, 6, 1.0 / 255), "True")), 6, true);
  std::string rgba;
  for (std::size_t i = 0; i < 6; ++i) {
    for (const U8 value : sample_color(i)) rgba.push_back(static_cast<char>(value));
    rgba.push_back('\xff');
  }
  expect_samples(with(npy_text("'|u1'", "(6, 4)", rgba)), 6, true);
}

TEST(NpzCloud, PackedColors) {
  std::vector<std::uint32_t> packed;
  for (std::size_t i = 0; i < 6; ++i) {
    const Rgb8 c = sample_color(i);
    packed.push_back(static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 | c[2]);
  }
  for (const char* type : {"'<u4'", "'<f4'"}) {
    expect_samples(read({{"xyz", points("(6, 3)", 6)}, {"rgb", npy_text(type, "(6,)", raw(packed))}}), 6, true);
  }
}

TEST(NpzCloud, Predictions) {
  const auto session = read({{"world_points", points("(2, 1, 3, 3)", 6)},
                             {"images", npy_text("'<f4'", "(2, 3, 1, 3)", planes<float>(2, 3, 1.0 / 255))},
                             {"world_points_conf", npy_text("'<f4'", "(2, 1, 3)", std::string(24, '\0'))},
                             {"world_points_from_depth", points("(2, 1, 3, 3)", 6)},
                             {"pose_enc_list", npy_text("'|O'", "()", "\x80\x04N.")}});
  EXPECT_EQ(session.info.format, "NPZ VGGT predictions");
  expect_samples(session, 6, true);
  EXPECT_THAT(all_notes(session),
              AllOf(HasSubstr("all of world_points taken, whatever their confidence, in the unit of the session"),
                    HasSubstr("arrays not used: world_points_conf, world_points_from_depth, pose_enc_list")));
  // Pi3: the channels last, a trailing 1 of the confidence.
  const auto pi3 = read({{"points", points("(2, 1, 3, 3)", 6)},
                         {"images", npy_text("'<f4'", "(2, 1, 3, 3)", color_bytes<float>(6, 1.0 / 255))},
                         {"conf", npy_text("'<f4'", "(2, 1, 3, 1)", std::string(24, '\0'))},
                         {"camera_poses", npy_text("'<f4'", "(2, 4, 4)", std::string(128, '\0'))}});
  expect_samples(pi3, 6, true);
  EXPECT_THAT(all_notes(pi3), HasSubstr("all of points taken, whatever their confidence"));
}

TEST(NpzCloud, BatchDimensions) {
  const auto one = read({{"world_points", points("(1, 2, 1, 3, 3)", 6)},
                         {"images", npy_text("'<f4'", "(1, 2, 3, 1, 3)", planes<float>(2, 3, 1.0 / 255))}});
  expect_samples(one, 6, true);
  EXPECT_THAT(all_notes(one), HasSubstr("the batch dimension of 1"));
  expect_samples(read({{"points", points("(1, 6, 3)", 6)}, {"colors", colors("(1, 6, 3)", 6)}}), 6, true);
  EXPECT_THAT(refused({{"world_points", points("(2, 1, 1, 3, 3)", 6)}}), HasSubstr("a batch of 2 scenes"));
}

TEST(NpzCloud, RecordsAndColumns) {
  std::string records;
  for (std::size_t i = 0; i < 4; ++i) {
    records += point_bytes<float>(4).substr(12 * i, 12) + color_bytes<U8>(4).substr(3 * i, 3);
  }
  const std::string descr =
      "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('red', '|u1'), ('green', '|u1'), ('blue', '|u1')]";
  // As pyntcloud writes it: two arrays of records.
  const auto file = read({{"points", npy_text(descr, "(4,)", records)},
                          {"mesh", npy_text("[('v1', '<i4'), ('v2', '<i4'), ('v3', '<i4')]", "(0,)", "")}});
  expect_samples(file, 4, true);
  EXPECT_THAT(all_notes(file), HasSubstr("arrays not used: mesh"));
  Members columns{{"intensity", npy_text("'<f4'", "(4,)", std::string(16, '\0'))}};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<float> axis;
    std::string channel;
    for (std::size_t i = 0; i < 4; ++i) {
      axis.push_back(static_cast<float>(sample_point(i)[static_cast<Eigen::Index>(k)]));
      channel.push_back(static_cast<char>(sample_color(i)[k]));
    }
    columns.emplace_back(std::string(1, "xyz"[k]), npy_text("'<f4'", "(4,)", raw(axis)));
    columns.emplace_back(std::array{"red", "green", "blue"}[k], npy_text("'|u1'", "(4, 1)", channel));
  }
  const auto of_columns = read(columns);
  expect_samples(of_columns, 4, true);
  EXPECT_THAT(all_notes(of_columns), HasSubstr("intensity"));
  columns[1].second = npy_text("'<f4'", "(3,)", std::string(12, '\0'));
  EXPECT_THAT(refused(columns), HasSubstr("x holds 3 numbers, but y 4"));
  // Beside an array of points, too.
  columns[1] = {"xyz", points("(4, 3)", 4)};
  expect_samples(read(columns), 4, true);
}

TEST(NpzCloud, MasksAreApplied) {
  const std::string mask("\1\0\1\0\1\0", 6);
  for (const char* type : {"'|b1'", "'|u1'"}) {
    const auto file = read({{"pointcloud", points("(2, 3, 3)", 6)},
                            {"mask", npy_text(type, "(2, 3)", mask)},
                            {"color", npy_text("'|u1'", "(3, 2, 3)", planes<U8>(1, 6, 1))}});
    EXPECT_EQ(file.info.format, "NPZ VGGT-SLAM point map");
    expect_samples(file, 3, true, 2);
    EXPECT_THAT(all_notes(file), HasSubstr("3 of 6 points left out: masked"));
  }
  const auto labels = read({{"points", points("(6, 3)", 6)}, {"mask", npy_text("'|u1'", "(6,)", {"\0\1\2\3\1\2", 6})}});
  expect_samples(labels, 6, false);
  EXPECT_THAT(all_notes(labels), HasSubstr("mask not applied"));
  EXPECT_THAT(refused({{"pointcloud", points("(2, 3, 3)", 6)}, {"mask", npy_text("'|b1'", "(3, 2)", mask)}}),
              HasSubstr("mask has the shape (3, 2), but pointcloud holds 6 points (shape (2, 3))"));
}

TEST(NpzCloud, TheArrayIsFoundByItsShape) {
  const std::string matrix = npy_text("'<f4'", "(4, 4)", std::string(64, '\0'));
  expect_samples(read({{"arr_0", points("(6, 3)", 6)}}), 6, false);
  const auto lone = read({{"my_map", points("(6, 3)", 6)}, {"normals", points("(6, 3)", 6)}, {"T", matrix}});
  expect_samples(lone, 6, false);
  EXPECT_THAT(all_notes(lone),
              AllOf(HasSubstr("the array my_map taken as the points"), HasSubstr("not used: normals, T")));
  EXPECT_THAT(refused({{"a", points("(6, 3)", 6)}, {"b", points("(5, 3)", 5)}}),
              AllOf(HasSubstr("several arrays may be the points"), HasSubstr("a (6, 3) <f4, b (5, 3) <f4")));
  // A usual name with another shape is passed over, where another has both.
  expect_samples(read({{"points", npy_text("'<f4'", "(6, 2)", std::string(48, '\0'))}, {"xyz", points("(6, 3)", 6)}}),
                 6, false);
  EXPECT_THAT(refused({{"points", npy_text("'<f4'", "(6, 2)", std::string(48, '\0'))}, {"T", matrix}}),
              HasSubstr("points.npy: has the shape (6, 2), without a z"));
}

TEST(NpzCloud, SavedWithoutNames) {
  const auto file = read({{"arr_0", points("(6, 3)", 6)}, {"arr_1", colors("(6, 3)", 6)}});
  expect_samples(file, 6, true);
  EXPECT_THAT(all_notes(file), HasSubstr("arr_1"));
  const auto floats =
      read({{"arr_0", points("(6, 3)", 6)}, {"arr_1", npy_text("'<f4'", "(6, 3)", color_bytes<float>(6, 1.0 / 255))}});
  expect_samples(floats, 6, false);
  EXPECT_THAT(all_notes(floats), HasSubstr("arrays not used: arr_1"));
}

TEST(NpzCloud, ColorsOfAnotherCountAreRefused) {
  const std::string six = points("(6, 3)", 6);
  EXPECT_THAT(refused({{"points", six}, {"colors", colors("(5, 3)", 5)}}),
              HasSubstr("a.npz: colors has the shape (5, 3), but points holds 6 points (shape (6,)); a color a point"));
  EXPECT_THAT(refused({{"xyz", six}, {"rgb", npy_text("'|u1'", "(3, 7)", std::string(21, 'a'))}}),
              HasSubstr("rgb has the shape (3, 7)"));
  // Height and width exchanged.
  EXPECT_THAT(refused({{"world_points", points("(1, 2, 5, 3)", 10)}, {"images", colors("(1, 5, 2, 3)", 10)}}),
              HasSubstr("images has the shape (1, 5, 2, 3), but world_points holds 10 points (shape (1, 2, 5))"));
  // Pictures beside a list of points need not be theirs; numbers that are no colors are said.
  const auto pictures = read({{"points", six}, {"images", colors("(1, 5, 3)", 5)}});
  EXPECT_THAT(all_notes(pictures), HasSubstr("arrays not used: images"));
  const auto gray = read({{"points", six}, {"colors", npy_text("'|u1'", "(6,)", "abcdef")}});
  EXPECT_FALSE(gray.cloud.has_color());
  EXPECT_THAT(all_notes(gray), HasSubstr("no color taken from colors: its shape is (6,)"));
}

TEST(NpzCloud, SaysWhatItHolds) {
  EXPECT_THAT(refused({{"depth", points("(2, 3)", 2)}}), HasSubstr("a session for cmap_recon"));
  EXPECT_THAT(refused({{"points", npy_text("'|O'", "()", "\x80\x04N.")}, {"a", colors("(2, 3)", 2)}}),
              AllOf(HasSubstr("points.npy"), HasSubstr("pickled Python objects")));
  EXPECT_THAT(refusal("a.zip", (ZipText{false, false, {{"a.txt", "x"}, {"b.txt", "y"}}}.str())),
              HasSubstr("its first member is 'a.txt'"));
  EXPECT_THAT(refusal("a.npz", "PK\x03\x04...."), HasSubstr("truncated, or no ZIP file"));
  Members many{{"points", points("(2, 3)", 2)}};
  for (int i = 0; i < 13; ++i) many.emplace_back(fmt::format("more{}", i), colors("(2, 3)", 2));
  EXPECT_THAT(all_notes(read(many)), AllOf(HasSubstr("more9 and 3 more"), Not(HasSubstr("more10"))));
}

/// Every member cut at every length: refused by name, or not used.
TEST(NpzCloud, TruncatedMembers) {
  const std::string xyz = points("(2, 3)", 2), rgb = colors("(2, 3)", 2);
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    EXPECT_THAT(refused({{"points", xyz.substr(0, i)}, {"colors", rgb}}), HasSubstr("points.npy: ")) << i;
  }
  for (std::size_t i = rgb.size() - 6; i < rgb.size(); ++i) {
    EXPECT_THAT(refused({{"points", xyz}, {"colors", rgb.substr(0, i)}}), HasSubstr("colors.npy: truncated")) << i;
  }
}

}  // namespace npz_reader_test
}  // namespace cmap::testing
