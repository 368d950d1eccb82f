#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/core/version.hpp"
#include "cmap/io/option_text.hpp"

namespace cmap {
namespace {

constexpr const char* kStopCodes = "\n130 interrupted, 143 terminated: nothing half-written is left.";

CLI::Validator one_of(std::vector<std::string> words) {
  const auto reason = [words = std::move(words)](std::string& text) {
    if (std::ranges::count(words, text) > 0) return std::string();
    return fmt::format("\"{}\" {}", text, is_none_of(text, words));
  };
  return {reason, ""};
}

/// Names the arguments that no option takes, in their order, and the options that are spelled nearly like them.
std::string about_stray_arguments(const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::vector<std::string> stray = app.remaining();
  std::string text = fmt::format("not expected: {}", fmt::join(stray, " "));
  for (const std::string& argument : stray) {
    if (argument.starts_with("--")) text += did_you_mean(argument.substr(0, argument.find('=')), known);
  }
  return text;
}

}  // namespace

Argument& Argument::required() {
  option_->required();
  return *this;
}

Argument& Argument::not_empty() {
  option_->check(CLI::Validator([](std::string& text) { return std::string(text.empty() ? "is empty" : ""); }, ""));
  return *this;
}

Argument& Argument::between(double least, double most) {
  option_->check(CLI::Range(least, most).description(""));
  return *this;
}

Argument& Argument::between(int least, int most) {
  option_->check(CLI::Range(least, most).description(""));
  return *this;
}

Argument& Argument::with_commas() {
  option_->delimiter(',');
  return *this;
}

Argument& Argument::values(int least, int most) {
  least == most ? option_->expected(least) : option_->expected(least, most);
  return *this;
}

Argument& Argument::one_at_a_time() {
  option_->allow_extra_args(false);
  return *this;
}

Argument& Argument::repeatable() {
  option_->expected(1)->take_all();
  return *this;
}

Argument& Argument::shown_as(const char* text) {
  option_->option_text(text);
  return *this;
}

void set_given(const OptionFields& fields, const OptionTexts& given) {
  for (const OptionField& field : fields) {
    const auto text = given.find(field.name);
    if (text == given.end()) continue;
    try {
      set_from_text(field, text->second);
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("--{}", error.what()));
    }
  }
}

CommandLine::CommandLine(const std::string& name, const std::string& description, const std::string& footer)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->footer(footer + kStopCodes);
}

CommandLine::~CommandLine() = default;

template <class Value>
Argument CommandLine::add(const char* name, Value& value, const char* placeholder, const char* help) {
  return Argument(app_->add_option(name, value, help)->type_name(placeholder));
}
template Argument CommandLine::add(const char*, std::string&, const char*, const char*);
template Argument CommandLine::add(const char*, int&, const char*, const char*);
template Argument CommandLine::add(const char*, double&, const char*, const char*);
template Argument CommandLine::add(const char*, std::optional<int>&, const char*, const char*);
template Argument CommandLine::add(const char*, std::optional<double>&, const char*, const char*);
template Argument CommandLine::add(const char*, std::vector<std::string>&, const char*, const char*);
template Argument CommandLine::add(const char*, std::vector<double>&, const char*, const char*);
template Argument CommandLine::add(const char*, std::vector<std::uint8_t>&, const char*, const char*);

void CommandLine::add_flag(const char* name, bool& value, const char* help) { app_->add_flag(name, value, help); }

Argument CommandLine::add_word(const char* name, std::string& value, std::vector<std::string> words,
                               const char* placeholder, const char* help) {
  return add_checked_word(
      name, [&value](const std::string& word) { value = word; }, std::move(words), placeholder, help);
}

Argument CommandLine::add_checked_word(const char* name, std::function<void(const std::string&)> set,
                                       std::vector<std::string> words, const char* placeholder, const char* help) {
  return Argument(
      app_->add_option_function<std::string>(name, set, help)->type_name(placeholder)->check(one_of(std::move(words))));
}

void CommandLine::add_option(const OptionField& field, OptionTexts& given) {
  const std::string flag = fmt::format("--{}", field.name);
  const auto set = [&given, name = std::string(field.name)](const std::string& text) { given[name] = text; };
  if (is_flag(field)) {
    app_->add_flag_callback(
            flag, [set] { set("true"); }, field.help)
        ->group("Metrics");
    return;
  }
  const std::string value = value_text(field);
  const std::string help = value.empty() ? field.help : fmt::format("{} [{}]", field.help, value);
  app_->add_option_function<std::string>(flag, set, help)->type_name(field.placeholder)->group("Metrics");
}

bool CommandLine::has(const char* name) const { return app_->get_option(name)->count() > 0; }

std::string CommandLine::name() const { return app_->get_name(); }

std::optional<int> CommandLine::parse(int argc, char** argv) {
  app_->set_version_flag("--version", fmt::format("{} {}", name(), kVersion));
  const auto refuse = [&](const std::string& reason) {
    throw UsageError(fmt::format("{}\nRun {} --help for usage.", reason, name()));
  };
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    refuse(about_stray_arguments(*app_));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error);
    refuse(error.what());
  }
  return std::nullopt;
}

}  // namespace cmap
