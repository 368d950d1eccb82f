#pragma once

#include <filesystem>

#include "cmap/core/drawing.hpp"
#include "cmap/eval/evaluation.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

struct AlignmentPicture;

/// What module render gives those that load it.
struct FigureTable {
  static constexpr const char* kModule = "figure";
  static constexpr int kTable = 2;
  void (*check_name)(const std::filesystem::path& name);
  void (*write)(const EvaluatedPair& evaluation, const std::filesystem::path& name, OutputFile& file);
  void (*write_alignment)(const AlignmentPicture& picture, const std::filesystem::path& name, OutputFile& file);
  void (*write_drawing)(const Drawing& drawing, const std::filesystem::path& name, OutputFile& file);
};

/// The module render, loaded when a figure is asked for: programs that may draw start without VTK.
class FigureModule {
 public:
  /// Throws UnsupportedError where cmap was built without figures.
  FigureModule();

  /// Throws UsageError for a name that is no picture's.
  void check_name(const std::filesystem::path& name) const { table_.check_name(name); }

  /// write_standard_figure of module render.
  void write(const EvaluatedPair& evaluation, const std::filesystem::path& name, OutputFile& file) const {
    table_.write(evaluation, name, file);
  }

  /// write_alignment_figure of module render.
  void write(const AlignmentPicture& picture, const std::filesystem::path& name, OutputFile& file) const {
    table_.write_alignment(picture, name, file);
  }

  /// The drawing as a picture of the name's format.
  void write(const Drawing& drawing, const std::filesystem::path& name, OutputFile& file) const {
    table_.write_drawing(drawing, name, file);
  }

 private:
  const FigureTable& table_;
};

}  // namespace cmap
