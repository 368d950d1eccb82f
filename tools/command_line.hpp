#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "cmap/core/options.hpp"

// The command line of a program. CLI11 stays in the source: it costs whoever includes it four seconds to compile.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace cmap {

/// One option or positional argument, to say more about it.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument& required();
  /// An unset variable of a script must not silently mean the default.
  Argument& not_empty();
  Argument& between(double least, double most);
  Argument& between(int least, int most);
  /// Values of a list may stand in one argument, between commas.
  Argument& with_commas();
  /// How many values a list has.
  Argument& values(int least, int most);
  /// A list takes one argument each time that it is given.
  Argument& one_at_a_time();
  /// The same, and --help shows no dots.
  Argument& repeatable();
  /// What --help shows of it, in place of placeholder and number of values.
  Argument& shown_as(const char* text);

 private:
  CLI::Option* option_;
};

/// Options that were given, by their names without dashes.
using OptionTexts = std::map<std::string, std::string>;

/// Sets the fields that were given. Throws UsageError "--name: value and rule".
void set_given(const OptionFields& fields, const OptionTexts& given);

/// Names are "MAP" for a positional argument, "--output" or "-o,--output". Variables must outlive it.
class CommandLine {
 public:
  /// The footer stands after the options in --help, and after it what is true of all programs.
  CommandLine(const std::string& name, const std::string& description, const std::string& footer);
  ~CommandLine();

  template <class Value>
  Argument add(const char* name, Value& value, const char* placeholder, const char* help);
  void add_flag(const char* name, bool& value, const char* help);
  Argument add_word(const char* name, std::string& value, std::vector<std::string> words, const char* placeholder,
                    const char* help);
  /// One of some values by its name.
  template <class Value>
  Argument add_choice(const char* name, Value& value, const EnumNames<std::type_identity_t<Value>>& names,
                      const char* placeholder, const char* help) {
    const auto set = [&value, names](const std::string& word) {
      for (const auto& [known, its_name] : names) {
        if (word == its_name) value = known;
      }
    };
    return add_checked_word(name, set, words_of(names), placeholder, help);
  }
  /// A field of a struct of options as --name, under Metrics; its value is the default that --help shows.
  void add_option(const OptionField& field, OptionTexts& given);

  /// Whether an option was on the command line.
  bool has(const char* name) const;
  std::string name() const;

  /// An exit code where that was all, as after --help. Throws UsageError for a wrong command line.
  std::optional<int> parse(int argc, char** argv);

 private:
  Argument add_checked_word(const char* name, std::function<void(const std::string&)> set,
                            std::vector<std::string> words, const char* placeholder, const char* help);

  std::unique_ptr<CLI::App> app_;
};

}  // namespace cmap
