#pragma once

// The options of an evaluation as command-line options.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cmap/core/error.hpp"
#include "cmap/eval/options.hpp"

namespace cmap {

class EvaluationArguments {
 public:
  /// Adds the options for which `wanted(name)` holds to the program's help, under Metrics.
  template <class Wanted>
  void add_to(CLI::App& app, Wanted&& wanted) {
    for (const OptionSpec& spec : evaluation_option_specs()) {
      if (wanted(std::string_view(spec.name))) add(app, spec);
    }
  }

  /// Sets what was given. Throws UsageError that names the option.
  void apply_to(EvaluationOptions& options) const {
    for (const auto& [spec, text] : texts_) {
      const CLI::Option& option = *options_.at(spec);
      if (option.count() == 0) continue;
      try {
        set_option(options, *spec, text);
      } catch (const UsageError& error) {
        throw UsageError(fmt::format("--{}", error.what()));
      }
    }
  }

 private:
  void add(CLI::App& app, const OptionSpec& spec) {
    std::string& text = texts_[&spec];
    const std::string flag = std::string("--") + spec.name;
    if (spec.kind == OptionKind::kFlag) {
      options_[&spec] = app.add_flag_callback(
                               flag, [&text] { text = "true"; }, spec.help)
                            ->group("Metrics");
      return;
    }
    std::string help = spec.help;
    const std::string value = command_line_text(spec.get(EvaluationOptions{}));
    if (!value.empty()) help += fmt::format(" [{}]", value);
    options_[&spec] = app.add_option(flag, text, help)->type_name(spec.placeholder)->group("Metrics");
  }

  std::map<const OptionSpec*, std::string> texts_;
  std::map<const OptionSpec*, CLI::Option*> options_;
};

}  // namespace cmap
