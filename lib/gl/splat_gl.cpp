#include "cmap/gl/splat_gl.hpp"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkOpenGLBufferObject.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLVertexArrayObject.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtk_glew.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "cmap/core/error.hpp"
#include "egl_window.hpp"
#include "worker.hpp"

namespace cmap {
namespace {

/// Points that travel to the device at once: 12 MB.
constexpr std::size_t kBatch = std::size_t{1} << 20;
constexpr int kMostTile_px = 8192;

/// splat.cpp's project() and draw_square() for one point. The square begins and ends on pixel edges, so that the
/// device has nothing to round; its depth orders as the float it comes from, scaled by a power of two below 1.
constexpr const char* kVertexShader = R"glsl(#version 400
in vec3 offset;
uniform vec3 right_axis, down_axis, forward_axis, translation;
uniform vec2 center_px;       // of the picture
uniform vec2 tile_px;         // the tile's first pixel
uniform vec2 viewport_px;     // with a margin about the tile, as OpenGL drops points whose middle is outside
uniform float margin_px;
uniform vec3 size;            // m, least and most pixels
uniform float focal, depth_scale;
uniform int orthographic, first_slot;
flat out uvec2 cell;

void main() {
  precise float right = right_axis.x * offset.x + right_axis.y * offset.y + right_axis.z * offset.z + translation.x;
  precise float down = down_axis.x * offset.x + down_axis.y * offset.y + down_axis.z * offset.z + translation.y;
  precise float depth =
      forward_axis.x * offset.x + forward_axis.y * offset.y + forward_axis.z * offset.z + translation.z;
  precise float scale = orthographic != 0 ? focal : focal / depth;
  precise vec2 middle = center_px + vec2(right * scale, down * scale);
  precise float side = clamp(size.x * scale, size.y, size.z);
  precise vec2 corner = floor(middle - 0.5 * side + 0.5);
  float side_px = max(1.0, floor(side + 0.5));
  cell = uvec2(uint(first_slot + gl_VertexID), floatBitsToUint(depth));
  vec2 at = (corner - tile_px + 0.5 * side_px + margin_px) / viewport_px;
  gl_Position = depth > 0.0 ? vec4(2.0 * at - 1.0, depth * depth_scale, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = side_px;
}
)glsl";

constexpr const char* kFragmentShader = R"glsl(#version 400
flat in uvec2 cell;
layout(location = 0) out uvec2 nearest;
void main() { nearest = cell; }
)glsl";

struct Tile {
  int x, y, width, height;
};

/// Pixel maps are read straight from the device: a cell is (slot, depth) as OpenGL writes them.
static_assert(std::endian::native == std::endian::little);

/// What a tile is drawn into: (slot, bits of depth) for every pixel, and the float depths that are compared.
class Target {
 public:
  Target(vtkOpenGLRenderWindow& window, int width, int height) {
    const auto w = static_cast<unsigned>(width), h = static_cast<unsigned>(height);
    cells_->SetContext(&window);
    cells_->SetInternalFormat(GL_RG32UI);
    cells_->SetFormat(GL_RG_INTEGER);
    cells_->SetDataType(GL_UNSIGNED_INT);
    cells_->Allocate2D(w, h, 2, VTK_UNSIGNED_INT);
    depths_->SetContext(&window);
    depths_->AllocateDepth(w, h, vtkTextureObject::Float32);
    frame_->SetContext(&window);
    frame_->SaveCurrentBindingsAndBuffers();
    frame_->Bind();
    frame_->AddColorAttachment(0, cells_);
    frame_->AddDepthAttachment(depths_);
    frame_->ActivateDrawBuffer(0);
    frame_->ActivateReadBuffer(0);
    const char* reason = nullptr;
    if (!vtkOpenGLFramebufferObject::GetFrameBufferStatus(vtkOpenGLFramebufferObject::GetBothMode(), reason)) {
      throw UsageError(fmt::format("the OpenGL device cannot draw into integer pictures: {}", reason));
    }
  }
  ~Target() { frame_->RestorePreviousBindingsAndBuffers(); }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  void clear() {
    const GLuint empty[] = {~0u, ~0u, ~0u, ~0u};
    const GLfloat farthest = 1.0f;
    glClearBufferuiv(GL_COLOR, 0, empty);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
  }

  /// Rows go from the top in both: the vertex shader's y points down.
  void read(const Tile& tile, PixelMap& pixels) {
    const std::size_t first =
        static_cast<std::size_t>(tile.y) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(tile.x);
    glPixelStorei(GL_PACK_ALIGNMENT, 8);
    glPixelStorei(GL_PACK_ROW_LENGTH, pixels.width);
    glReadPixels(0, 0, tile.width, tile.height, GL_RG_INTEGER, GL_UNSIGNED_INT, pixels.cells.data() + first);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  }

 private:
  vtkNew<vtkTextureObject> cells_, depths_;
  vtkNew<vtkOpenGLFramebufferObject> frame_;
};

/// Farther than any point can be, a power of two.
float farthest_m(const PointBlocks& points, const Projection& projection) {
  float most = 0.0f;
  for (const PointBlock& block : points.blocks) {
    for (const float* axis : {block.x, block.y, block.z}) {
      for (std::size_t k = 0; k < kBlockSize; ++k) most = std::max(most, std::abs(axis[k]));
    }
  }
  const double reach = 1.75 * static_cast<double>(most) + (points.origin - projection.position).norm();
  return static_cast<float>(std::exp2(std::ceil(std::log2(std::max(reach, 1e-30))) + 1.0));
}

void set_axes(vtkShaderProgram& program, const PointBlocks& points, const Projection& projection) {
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes = projection.axes.cast<float>();
  const Eigen::Vector3f translation = (projection.axes * (points.origin - projection.position)).cast<float>();
  const char* names[] = {"right_axis", "down_axis", "forward_axis"};
  for (int i = 0; i < 3; ++i) program.SetUniform3f(names[i], axes.row(i).eval().data());
  program.SetUniform3f("translation", translation.data());
  program.SetUniformf("focal", static_cast<float>(projection.focal_px));
  program.SetUniformi("orthographic", projection.orthographic ? 1 : 0);
  program.SetUniformf("depth_scale", 1.0f / farthest_m(points, projection));
}

void set_tile(vtkShaderProgram& program, const Tile& tile, const Projection& projection, int margin_px) {
  const float center[] = {0.5f * static_cast<float>(projection.width_px),
                          0.5f * static_cast<float>(projection.height_px)};
  const float first[] = {static_cast<float>(tile.x), static_cast<float>(tile.y)};
  const int width = tile.width + 2 * margin_px, height = tile.height + 2 * margin_px;
  const float viewport[] = {static_cast<float>(width), static_cast<float>(height)};
  glViewport(-margin_px, -margin_px, width, height);
  program.SetUniform2f("center_px", center);
  program.SetUniform2f("tile_px", first);
  program.SetUniform2f("viewport_px", viewport);
  program.SetUniformf("margin_px", static_cast<float>(margin_px));
}

void set_state() {
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_MULTISAMPLE);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);  // of equally near points the first drawn stays: the lower slot
  // Depths from 0 to 1 keep all bits of the float; -1 to 1 would round them.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

}  // namespace

struct GlSplatter::Device {
  Device() {
    window->use(context);
    window->Initialize();
    window->MakeCurrent();
    window->OpenGLInit();
    if (!GLEW_VERSION_4_5 && !GLEW_ARB_clip_control) {
      throw UsageError(fmt::format("OpenGL 4.5 or ARB_clip_control is needed; this is {}", text(GL_VERSION)));
    }
  }

  static std::string text(GLenum name) {
    const GLubyte* value = glGetString(name);
    return value == nullptr ? "unknown" : reinterpret_cast<const char*>(value);
  }

  void splat(const PointBlocks& points, const Projection& projection, const SplatOptions& options, PixelMap& pixels);

  vtkShaderProgram& ready_program() {
    vtkShaderProgram* ready = window->GetShaderCache()->ReadyShaderProgram(kVertexShader, kFragmentShader, "");
    if (ready == nullptr) throw UsageError("the OpenGL device cannot compile the program that draws points");
    return *ready;
  }

  /// The offsets of these points, from the device's side.
  void draw_points(vtkShaderProgram& program, const PointBlocks& points) {
    vtkNew<vtkOpenGLVertexArrayObject> arrays;
    vtkNew<vtkOpenGLBufferObject> buffer;
    buffer->SetType(vtkOpenGLBufferObject::ArrayBuffer);
    for (std::size_t first = 0; first < points.size; first += kBatch) {
      const std::size_t n = std::min(kBatch, points.size - first);
      offsets.resize(n);
      for (std::size_t i = 0; i < n; ++i) offsets[i] = points.offset(first + i);
      buffer->Upload(offsets.front().data(), 3 * n, vtkOpenGLBufferObject::ArrayBuffer);
      arrays->Bind();
      arrays->AddAttributeArray(&program, buffer, "offset", 0, sizeof(Eigen::Vector3f), VTK_FLOAT, 3, false);
      program.SetUniformi("first_slot", static_cast<int>(first));
      glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(n));
      arrays->Release();
    }
    arrays->ReleaseGraphicsResources();
  }

  EglContext context;
  vtkNew<EglWindow> window;
  Array<Eigen::Vector3f> offsets;  ///< of one batch
};

void GlSplatter::Device::splat(const PointBlocks& points, const Projection& projection, const SplatOptions& options,
                               PixelMap& pixels) {
  GLfloat sizes_px[2] = {1.0f, 1.0f};
  GLint most_texture_px = 0, most_viewport_px[2] = {0, 0};
  glGetFloatv(GL_POINT_SIZE_RANGE, sizes_px);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_texture_px);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, most_viewport_px);
  if (options.max_size_px > static_cast<double>(sizes_px[1])) {
    throw UsageError(fmt::format("the OpenGL device draws points of at most {} pixels", sizes_px[1]));
  }
  const int margin_px = static_cast<int>(std::ceil(options.max_size_px));
  const int side_px =
      std::min({kMostTile_px, most_texture_px, std::min(most_viewport_px[0], most_viewport_px[1]) - 2 * margin_px});
  set_state();
  vtkShaderProgram& program = ready_program();
  set_axes(program, points, projection);
  const float size[] = {static_cast<float>(options.point_size_m), static_cast<float>(options.min_size_px),
                        static_cast<float>(options.max_size_px)};
  program.SetUniform3f("size", size);
  Target target(*window, std::min(side_px, pixels.width), std::min(side_px, pixels.height));
  for (int y = 0; y < pixels.height; y += side_px) {
    for (int x = 0; x < pixels.width; x += side_px) {
      const Tile tile{x, y, std::min(side_px, pixels.width - x), std::min(side_px, pixels.height - y)};
      set_tile(program, tile, projection, margin_px);
      target.clear();
      draw_points(program, points);
      target.read(tile, pixels);
    }
  }
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw UsageError(fmt::format("the OpenGL device refuses: error {:#x}, perhaps out of memory", error));
  }
}

GlSplatter::GlSplatter() : worker_(std::make_unique<Worker>()) {
  worker_->run([this] { device_ = std::make_unique<Device>(); });
}

GlSplatter::~GlSplatter() {
  worker_->run([this] { device_.reset(); });
}

std::string GlSplatter::device() const {
  std::string name;
  worker_->run([&] { name = fmt::format("{}, OpenGL {}", Device::text(GL_RENDERER), Device::text(GL_VERSION)); });
  return name;
}

void GlSplatter::splat(const PointBlocks& points, const Projection& projection, const SplatOptions& options,
                       PixelMap& pixels) {
  worker_->run([&] { device_->splat(points, projection, options, pixels); });
}

}  // namespace cmap
