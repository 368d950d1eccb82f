#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cctype>

#include "cmap/core/error.hpp"
#include "cmap/render/image.hpp"

namespace cmap {
namespace {

std::string lower_case_extension(const std::filesystem::path& name) {
  std::string extension = name.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

bool is_png(const std::filesystem::path& name) { return lower_case_extension(name) == ".png"; }

bool is_jpeg(const std::filesystem::path& name) {
  const std::string extension = lower_case_extension(name);
  return extension == ".jpg" || extension == ".jpeg";
}

/// VTK's rows go from the bottom.
vtkNew<vtkImageData> to_vtk(const Image& image, int channels) {
  vtkNew<vtkImageData> result;
  result->SetDimensions(image.width, image.height, 1);
  result->AllocateScalars(VTK_UNSIGNED_CHAR, channels);
  for (int y = 0; y < image.height; ++y) {
    auto* out = static_cast<std::uint8_t*>(result->GetScalarPointer(0, image.height - 1 - y, 0));
    for (int x = 0; x < image.width; ++x, out += channels) std::copy_n(image.at(x, y).data(), channels, out);
  }
  return result;
}

template <class Writer>
void write_with(Writer& writer, vtkImageData* image, OutputFile& file) {
  writer.SetInputData(image);
  writer.WriteToMemoryOn();
  writer.Write();
  vtkUnsignedCharArray* bytes = writer.GetResult();
  file.write(bytes->GetPointer(0), static_cast<std::size_t>(bytes->GetNumberOfValues()));
}

}  // namespace

void check_image_name(const std::filesystem::path& name) {
  if (!is_png(name) && !is_jpeg(name)) throw UsageError(fmt::format("{}: pictures are .png or .jpg", name.string()));
}

void write_image(const Image& image, const std::filesystem::path& name, OutputFile& file) {
  check_image_name(name);
  if (is_png(name)) {
    vtkNew<vtkPNGWriter> writer;
    write_with(*writer, to_vtk(image, 4), file);
  } else {
    constexpr int kQuality = 92;
    Image opaque(image.width, image.height, {255, 255, 255, 255});
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) blend(opaque, x, y, image.at(x, y));
    }
    vtkNew<vtkJPEGWriter> writer;
    writer->SetQuality(kQuality);
    write_with(*writer, to_vtk(opaque, 3), file);
  }
}

}  // namespace cmap
