// The numbers of two maps, by the library: g++ -std=c++20 library_example.cpp $(pkg-config --static --cflags --libs
// cmap)
#include <cmap/core/error.hpp>
#include <cmap/eval/evaluation.hpp>
#include <cmap/io/point_cloud_file.hpp>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: library_example REFERENCE ESTIMATE\n";
    return 2;
  }
  cmap::EvaluationOptions options;
  options.thresholds_m = {0.1, 0.05};
  const cmap::Evaluation found =
      cmap::evaluate(cmap::read_point_cloud(argv[1]).cloud, cmap::read_point_cloud(argv[2]).cloud, options);
  std::cout << "Chamfer " << *found.metrics.at("chamfer").value << " m\n";
  for (const cmap::Record& level : found.metrics.at("fitness").list("per_threshold")) {
    std::cout << "fitness within " << *level.threshold_m << " m: " << *level.value << "\n";
  }
  for (const cmap::Warning& warning : found.warnings) std::cout << warning.id << ": " << warning.message << "\n";
} catch (const cmap::Error& error) {
  std::cerr << error.what() << "\n";
  return static_cast<int>(error.exit_code());
}
