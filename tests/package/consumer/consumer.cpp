// Evaluates a map against itself with the installed library and prints the table.

#include <cmap/report/report.hpp>
#include <iostream>

int main() {
  cmap::PointCloud map;
  map.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  map.colors = cmap::Array<cmap::Rgb8>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};

  cmap::FileInfo info;
  info.path = "map";
  info.format = "memory";
  info.points = info.finite_points = map.size();
  info.sha256 = std::string(64, '0');
  const cmap::InputDescription input = cmap::describe({map, info});
  const cmap::Evaluation evaluation = cmap::evaluate(map, map, cmap::EvaluationOptions{});
  std::cout << cmap::format_table(cmap::make_report(input, input, evaluation, {"consumer", "", 0.0, {}, 1, "plain"}));
}
