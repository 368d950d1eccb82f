#include "recordings/images/png_file.hpp"

#include <zlib.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "cmap/io/output_file.hpp"

namespace cmap {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> static_cast<unsigned>(shift));
  return bytes;
}

void write_chunk(OutputFile& file, std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  const auto crc = ::crc32_z(0, reinterpret_cast<const Bytef*>(body.data()), body.size());
  file.write(big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(static_cast<std::uint32_t>(crc)));
}

/// Rows as differences to the pixel before (filter 1), deflated.
std::string packed_rows(const RgbImage& image) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<Bytef> rows;
  rows.reserve(height * (3 * width + 1));
  for (std::size_t y = 0; y < height; ++y) {
    rows.push_back(1);
    Rgb8 before{};
    for (std::size_t x = 0; x < width; ++x) {
      const Rgb8& pixel = image.pixels[y * width + x];
      for (std::size_t k = 0; k < 3; ++k) rows.push_back(static_cast<Bytef>(pixel[k] - before[k]));
      before = pixel;
    }
  }
  uLongf size = ::compressBound(rows.size());
  std::string packed(size, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(packed.data()), &size, rows.data(), rows.size(), 1) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace

void write_png(const RgbImage& image, const std::filesystem::path& path) {
  OutputFile file(path);
  file.write("\x89PNG\r\n\x1A\n");
  const std::string size =
      big_endian(static_cast<std::uint32_t>(image.width)) + big_endian(static_cast<std::uint32_t>(image.height));
  write_chunk(file, "IHDR", size + std::string("\x08\x02\x00\x00\x00", 5));
  write_chunk(file, "IDAT", packed_rows(image));
  write_chunk(file, "IEND", "");
  file.commit();
}

}  // namespace cmap
