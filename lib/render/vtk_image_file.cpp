#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkTIFFWriter.h>
#include <vtkUnsignedCharArray.h>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/render/image.hpp"
#include "file_extension.hpp"

namespace cmap {
namespace {

enum class Format { kPng, kJpeg, kTiff };

Format format_of(const std::filesystem::path& name) {
  const std::string extension = lower_case_extension(name);
  if (extension == ".png" || name == kStandardStream) return Format::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return Format::kJpeg;
  if (extension == ".tif" || extension == ".tiff") return Format::kTiff;
  throw UsageError(fmt::format("{}: pictures are .png, .jpg or .tif", name.string()));
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

void write_jpeg(const Image& image, OutputFile& file) {
  constexpr int kQuality = 92;
  Image opaque = image;
  for (Rgba8& pixel : opaque.pixels) pixel = over_white(pixel);
  vtkNew<vtkJPEGWriter> writer;
  writer->SetQuality(kQuality);
  write_with(*writer, to_vtk(opaque, 3), file);
}

/// VTK writes TIFF only by name.
void write_tiff(const Image& image, const std::filesystem::path& name, OutputFile& file) {
  vtkNew<vtkTIFFWriter> writer;
  writer->SetInputData(to_vtk(image, 4));
  writer->SetCompressionToPackBits();
  writer->SetFileName(file.path_for_writer().c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw OutputError(fmt::format("{}: cannot be written as TIFF", name.string()));
}

}  // namespace

void check_image_name(const std::filesystem::path& name) { format_of(name); }

void write_image(const Image& image, const std::filesystem::path& name, OutputFile& file) {
  switch (format_of(name)) {
    case Format::kPng:
      return write_with(*vtkNew<vtkPNGWriter>(), to_vtk(image, 4), file);
    case Format::kJpeg:
      return write_jpeg(image, file);
    case Format::kTiff:
      return write_tiff(image, name, file);
  }
}

}  // namespace cmap
