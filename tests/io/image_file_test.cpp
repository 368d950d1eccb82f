#include "cmap/io/image_file.hpp"

#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace image_file_test {

using ::testing::HasSubstr;

RgbImage gradient(int width, int height) {
  RgbImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.pixels.push_back({static_cast<U8>(4 * x), static_cast<U8>(5 * y), 200});
  }
  return image;
}

TEST(ImageFile, PngReadsBackIdentical) {
  const TempFolder folder;
  const RgbImage image = gradient(40, 30);
  write_image(image, folder / "a.png");
  const RgbImage copy = read_image(folder / "a.png");
  EXPECT_EQ(copy.width, 40);
  EXPECT_EQ(copy.height, 30);
  EXPECT_EQ(copy.pixels, image.pixels);
  EXPECT_EQ(copy.at(3, 2), (Rgb8{12, 10, 200})) << "red, green, blue";
}

TEST(ImageFile, JpegReadsBackNearly) {
  const TempFolder folder;
  const RgbImage image = gradient(40, 30);
  write_image(image, folder / "a.JPG");
  const RgbImage copy = read_image(folder / "a.JPG");
  ASSERT_EQ(copy.pixels.size(), image.pixels.size());
  int worst = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(image.pixels[i][k] - copy.pixels[i][k]));
  }
  EXPECT_LE(worst, 16) << "quality 95 quantizes in small steps; exchanged channels would be off by 200";
}

TEST(ImageFile, SizeIsThatOfTheCalibration) {
  const TempFolder folder;
  write_image(gradient(40, 30), folder / "a.png");
  CameraModel camera{CameraProjection::kPinhole, 40, 30, 20, 20, 20, 15, {}};
  EXPECT_EQ(read_image(folder / "a.png", camera).width, 40);
  camera.width = 41;
  EXPECT_THAT(input_error([&] { read_image(folder / "a.png", camera); }),
              HasSubstr("a.png: 40 x 30 pixels; the calibration is of a camera of 41 x 30"));
}

TEST(ImageFile, SaysWhatIsWrong) {
  const TempFolder folder;
  EXPECT_THAT(input_error([&] { read_image(folder / "a.png"); }), HasSubstr("a.png: no such file"));
  folder.write("a.png", "no image");
  EXPECT_THAT(input_error([&] { read_image(folder / "a.png"); }), HasSubstr("a.png: is no image that can be decoded"));
  write_image(gradient(40, 30), folder / "b.png");
  folder.write("c.png", read_bytes(folder / "b.png").substr(0, 20));
  EXPECT_THAT(input_error([&] { read_image(folder / "c.png"); }), HasSubstr("c.png: is no image"));
  const std::string png = read_bytes(folder / "b.png");
  folder.write("d.png", png.substr(0, png.size() * 3 / 4));
  EXPECT_THAT(input_error([&] { read_image(folder / "d.png"); }), HasSubstr("d.png: is no image"));
  write_image(gradient(40, 30), folder / "b.jpg");
  const std::string jpeg = read_bytes(folder / "b.jpg");
  folder.write("c.jpg", jpeg.substr(0, jpeg.size() * 3 / 4));
  EXPECT_THAT(input_error([&] { read_image(folder / "c.jpg"); }), HasSubstr("c.jpg: truncated"));
  folder.write("d.jpg", jpeg + "what some cameras append");
  EXPECT_EQ(read_image(folder / "d.jpg").pixels, read_image(folder / "b.jpg").pixels);
  EXPECT_THROW(write_image(gradient(40, 30), folder / "a.tiff"), UsageError);
  EXPECT_THROW(write_image(gradient(40, 30), folder / "no/such/a.png"), OutputError);
  EXPECT_THROW(write_image({40, 30, {}}, folder / "e.png"), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "e.png"));
}

}  // namespace image_file_test
}  // namespace cmap::testing
