// Reads two maps and checks a requirement, with the installed library.

#include <cmap/eval/configuration.hpp>
#include <cmap/eval/requirement.hpp>
#include <cmap/io/point_cloud_file.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  cmap::EvaluationOptions options;
  cmap::apply_preset(options, "indoor");
  const auto evaluation =
      cmap::evaluate(cmap::read_point_cloud(argv[1]).cloud, cmap::read_point_cloud(argv[2]).cloud, options);
  return cmap::check(cmap::parse_requirement("chamfer<=0", options), evaluation).holds ? 0 : 1;
}
