// Pictures of the town: our splatter, the same squares by OpenGL, and VTK's own point mapper, which draws fixed sizes
// and has no shading. Sorting and colors are known beforehand; VTK's first frame, which uploads the points, is not
// timed.

#include <benchmark/benchmark.h>

#include <list>

#include "cmap/render/figure.hpp"
#include "town_pair.hpp"

#ifdef CMAP_WITH_GL
#include <vtkActor.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "cmap/gl/splat_gl.hpp"
#include "egl_window.hpp"

VTK_MODULE_INIT(vtkRenderingOpenGL2)
#endif

namespace {

/// Both maps of a town, each drawn in two of the four panels.
struct Maps {
  explicit Maps(long points) {
    const auto& town = cmap::benchmarks::town(points, false);
    for (const cmap::PointCloud* cloud : {&town.reference, &town.estimate}) maps.emplace_back(*cloud);
    for (const cmap::IndexedMap& map : maps) {
      for (const char* title : {"colors", "colors again"}) layers.push_back(cmap::make_layer(map, title));
    }
  }

  std::list<cmap::IndexedMap> maps;
  std::vector<cmap::Layer> layers;
};

const Maps& maps_of(long points) {
  static std::map<long, Maps> loaded;
  if (!loaded.contains(points)) {
    loaded.clear();
    loaded.try_emplace(points, points);
  }
  return loaded.at(points);
}

cmap::Camera camera_on(const cmap::PointBlocks& points) {
  return cmap::camera_for(cmap::View::kOblique, points, 1.6, false);
}

void picture(benchmark::State& state, const cmap::Splatter& splatter) {
  const cmap::PointBlocks& points = *maps_of(state.range(0)).layers[0].points;
  const cmap::Projection projection(camera_on(points), 1600, 1000);
  for (auto _ : state) benchmark::DoNotOptimize(splatter(points, projection, {0.0, 3.0, 3.0}).cells.data());
}

/// 1600 x 1000: the reference alone, or four panels.
void figure(benchmark::State& state, const cmap::Splatter& splatter) {
  const Maps& maps = maps_of(state.range(0));
  const std::span layers(maps.layers.data(), static_cast<std::size_t>(state.range(1)));
  cmap::FigureOptions options;
  options.splatter = splatter;
  const cmap::Camera camera =
      cmap::camera_for(cmap::View::kOblique, *layers[0].points, cmap::panel_aspect(layers.size(), options), false);
  for (auto _ : state) benchmark::DoNotOptimize(cmap::draw_figure(layers, camera, options).pixels.data());
}

void picture_splat(benchmark::State& state) { picture(state, cmap::splat); }
void figure_splat(benchmark::State& state) { figure(state, cmap::splat); }

#ifdef CMAP_WITH_GL

cmap::PixelMap splat_by_gl(const cmap::PointBlocks& points, const cmap::Projection& projection,
                           const cmap::SplatOptions& options) {
  static cmap::GlSplatter splatter;
  cmap::PixelMap pixels{projection.width_px, projection.height_px, {}};
  pixels.cells.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
  splatter.splat(points, projection, options, pixels);
  return pixels;
}

void picture_gl(benchmark::State& state) { picture(state, splat_by_gl); }
void figure_gl(benchmark::State& state) { figure(state, splat_by_gl); }

vtkNew<vtkPolyData> vtk_points(const cmap::Layer& layer) {
  const cmap::PointBlocks& points = *layer.points;
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(static_cast<vtkIdType>(points.size));
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(static_cast<vtkIdType>(points.size));
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    coordinates->SetTypedTuple(static_cast<vtkIdType>(slot), points.offset(slot).data());
    colors->SetTypedTuple(static_cast<vtkIdType>(slot), layer.colors[slot].data());
  }
  vtkNew<vtkPoints> vertices;
  vertices->SetData(coordinates);
  vtkNew<vtkPolyData> data;
  data->SetPoints(vertices);
  data->GetPointData()->SetScalars(colors);
  return data;
}

void picture_vtk(benchmark::State& state) {
  const cmap::Layer& layer = maps_of(state.range(0)).layers[0];
  const cmap::Camera camera = camera_on(*layer.points);
  cmap::EglContext context;
  vtkNew<cmap::EglWindow> window;
  window->use(context);
  window->SetSize(1600, 1000);
  window->SetMultiSamples(0);
  vtkNew<vtkPointGaussianMapper> mapper;
  mapper->SetInputData(vtk_points(layer));
  mapper->SetScaleFactor(0.0);
  mapper->EmissiveOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetPointSize(3.0f);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  window->AddRenderer(renderer);
  const Eigen::Vector3d position = camera.position - layer.points->origin,
                        target = camera.target - layer.points->origin;
  renderer->GetActiveCamera()->SetPosition(position.data());
  renderer->GetActiveCamera()->SetFocalPoint(target.data());
  renderer->GetActiveCamera()->SetViewUp(camera.up.data());
  renderer->GetActiveCamera()->SetViewAngle(camera.field_of_view_deg);
  renderer->ResetCameraClippingRange();
  vtkNew<vtkUnsignedCharArray> pixels;
  const auto frame = [&] {
    window->Render();
    window->GetRGBACharPixelData(0, 0, 1599, 999, 0, pixels);
  };
  frame();
  for (auto _ : state) frame();
  std::size_t n_drawn = 0;
  for (vtkIdType i = 0; i < pixels->GetNumberOfTuples(); ++i) n_drawn += pixels->GetTypedComponent(i, 1) != 0 ? 1 : 0;
  if (n_drawn < 400'000) throw std::runtime_error("VTK has drawn nothing to speak of");
}

#endif

void settings(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

void sizes(benchmark::internal::Benchmark* b) { settings(b->ArgNames({"points"})->Arg(1'000'000)->Arg(10'000'000)); }

void sizes_and_panels(benchmark::internal::Benchmark* b) {
  settings(b->ArgNames({"points", "panels"})->ArgsProduct({{1'000'000, 10'000'000}, {1, 4}}));
}

BENCHMARK(picture_splat)->Apply(sizes);
BENCHMARK(figure_splat)->Apply(sizes_and_panels);
#ifdef CMAP_WITH_GL
BENCHMARK(picture_gl)->Apply(sizes);
BENCHMARK(figure_gl)->Apply(sizes_and_panels);
BENCHMARK(picture_vtk)->Apply(sizes);
#endif

}  // namespace

BENCHMARK_MAIN();
