#include <vtkAutoInit.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "cmap/render/image.hpp"

VTK_MODULE_INIT(vtkRenderingFreeType)

namespace cmap {
namespace {

/// The built-in font of VTK lacks Greek.
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/// Coverage of a line of text, rows from the top.
struct TextMask {
  int width = 0, height = 0;
  vtkSmartPointer<vtkImageData> image;

  std::uint8_t coverage(int x, int y) const {
    const auto* pixel = static_cast<const std::uint8_t*>(image->GetScalarPointer(x, height - 1 - y, 0));
    return pixel[3];
  }
};

TextMask render_text(std::string_view utf8, int size_px) {
  constexpr int kDotsPerInch = 72;  // so that points are pixels
  vtkNew<vtkTextProperty> property;
  if (std::filesystem::exists(kFont)) {
    property->SetFontFamily(VTK_FONT_FILE);
    property->SetFontFile(kFont);
  }
  property->SetFontSize(size_px);
  property->SetColor(1.0, 1.0, 1.0);
  TextMask mask;
  mask.image = vtkSmartPointer<vtkImageData>::New();
  int dimensions[2] = {0, 0};
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  if (renderer == nullptr || !renderer->RenderString(property.Get(), std::string(utf8), mask.image.Get(), dimensions,
                                                     kDotsPerInch, vtkTextRenderer::FreeType)) {
    throw std::runtime_error("VTK cannot draw text");
  }
  mask.width = dimensions[0];
  mask.height = dimensions[1];
  return mask;
}

}  // namespace

int text_width(std::string_view utf8, int size_px) { return utf8.empty() ? 0 : render_text(utf8, size_px).width; }

void draw_text(Image& image, int x, int y, std::string_view utf8, int size_px, Rgba8 color, TextAnchor anchor) {
  if (utf8.empty()) return;
  const TextMask mask = render_text(utf8, size_px);
  const int left = anchor == TextAnchor::kLeft     ? x
                   : anchor == TextAnchor::kCenter ? x - mask.width / 2
                                                   : x - mask.width;
  const int top = y - mask.height / 2;
  for (int row = 0; row < mask.height; ++row) {
    for (int column = 0; column < mask.width; ++column) {
      const int alpha = mask.coverage(column, row) * color[3] / 255;
      blend(image, left + column, top + row, {color[0], color[1], color[2], static_cast<std::uint8_t>(alpha)});
    }
  }
}

}  // namespace cmap
