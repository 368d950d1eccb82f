#include "cmap/io/image_file.hpp"

#include <algorithm>
#include <cctype>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "cmap/core/spelling.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {
namespace {

/// What OpenCV makes of the bytes; empty if nothing.
cv::Mat decoded(const Array<unsigned char>& bytes) {
  const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8U, const_cast<unsigned char*>(bytes.data()));
  try {
    return cv::imdecode(buffer, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

/// Whether a JPEG file lacks its end, which decoders paint over in gray. The marker of the end cannot stand in
/// compressed data; a thumbnail's own comes before the picture starts.
bool is_cut_jpeg(const Array<unsigned char>& bytes) {
  constexpr std::string_view kStart = "\xff\xd8\xff", kScan = "\xff\xda", kEnd = "\xff\xd9";
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(kStart)) return false;
  const std::size_t end = text.rfind(kEnd), scan = text.rfind(kScan);
  return end == std::string_view::npos || scan == std::string_view::npos || end < scan;
}

}  // namespace

RgbImage read_image(const std::filesystem::path& path) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
  ByteSource source(path);
  if (source.size() > kMostBytes) source.fail("{} bytes are too many for an image", source.size());
  Array<unsigned char> bytes(source.size());
  source.read(std::as_writable_bytes(std::span(bytes)), "the file");
  if (is_cut_jpeg(bytes)) source.fail("truncated: the JPEG data do not end");
  const cv::Mat bgr = decoded(bytes);
  if (bgr.empty()) source.fail("is no image that can be decoded, or is damaged");
  RgbImage image{bgr.cols, bgr.rows, Array<Rgb8>(bgr.total())};
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.pixels.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}

RgbImage read_image(const std::filesystem::path& path, const CameraModel& camera) {
  RgbImage image = read_image(path);
  if (image.width != camera.width || image.height != camera.height) {
    throw InputError(fmt::format("{}: {} x {} pixels; the calibration is of a camera of {} x {}", path.string(),
                                 image.width, image.height, camera.width, camera.height));
  }
  return image;
}

void write_image(const RgbImage& image, const std::filesystem::path& path) {
  const bool right =
      image.width > 0 && image.height > 0 &&
      image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!right) throw std::invalid_argument("write_image: width * height pixels expected");
  const std::string extension = lower_case(path.extension().string());
  if (extension != ".jpg" && extension != ".jpeg" && extension != ".png") {
    throw UsageError(fmt::format("{}: an image is written as .jpg or .png", path.string()));
  }
  const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<Rgb8*>(image.pixels.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> bytes;
  OutputFile file(path);
  if (!cv::imencode(extension, bgr, bytes)) throw OutputError(path.string() + ": the image could not be encoded");
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace cmap
