#pragma once

#include <filesystem>

#include "cmap/core/drawing.hpp"
#include "cmap/eval/evaluation.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

/// The module render, loaded when a figure is asked for: programs that may draw start without VTK.
class FigureModule {
 public:
  /// Throws UnsupportedError where cmap was built without figures.
  FigureModule();

  /// Throws UsageError for a name that is no picture's.
  void check_name(const std::filesystem::path& name) const { check_name_(name); }

  /// write_standard_figure of module render.
  void write(const Evaluation& evaluation, const std::filesystem::path& name, OutputFile& file) const {
    write_(evaluation, name, file);
  }

  /// The drawing as a picture of the name's format.
  void write(const Drawing& drawing, const std::filesystem::path& name, OutputFile& file) const {
    write_drawing_(drawing, name, file);
  }

 private:
  void (*check_name_)(const std::filesystem::path&);
  void (*write_)(const Evaluation&, const std::filesystem::path&, OutputFile&);
  void (*write_drawing_)(const Drawing&, const std::filesystem::path&, OutputFile&);
};

}  // namespace cmap
