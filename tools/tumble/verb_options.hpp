// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// verb_options.hpp declares the options of a verb. Only verb_options.cpp and program.cpp include CLI11, whose headers
/// add seconds of compile time to each source.
namespace tumble::tools {

/// VerbOption sets further properties of the option or argument that was just declared.
class VerbOption {
 public:
  explicit VerbOption(CLI::Option& option) : option_(&option) {}

  /// Makes the option mandatory.
  VerbOption required();
  /// Accepts numbers from `low` to `high`; rejects NaN.
  VerbOption within(double low, double high);
  /// Accepts whole numbers from `low` to `high`.
  VerbOption whole(int low, int high);
  /// Adds a check that runs before CLI11 reports missing options. `refuse` throws BadInput with a one-line message.
  VerbOption check(std::function<void(const std::string&)> refuse);
  /// Rejects an empty word.
  VerbOption filled();
  /// Makes the option take exactly `count` words.
  VerbOption words(int count);
  /// Makes the option take one word per occurrence; the next word is not part of it.
  VerbOption one_at_a_time();
  /// Splits one word into several words at `separator`.
  VerbOption separated_by(char separator);
  /// Shows the current value of the target as default in `--help`.
  VerbOption shows_default();

 private:
  CLI::Option* option_;
};

/// VerbOptions contains the options of one verb.
class VerbOptions {
 public:
  explicit VerbOptions(CLI::App& app) : app_(&app) {}

  /// Declares an option ("--seed", "-o,--output") or a positional argument ("SCENARIO"). `Value` is one of the types
  /// instantiated in verb_options.cpp. The target must exist while the command line is parsed.
  template <class Value>
  VerbOption add(const std::string& names, Value& target, const std::string& doc);
  void add_flag(const std::string& name, bool& target, const std::string& doc);
  /// Sets the last line of `--help`.
  void footer(const std::string& line);

 private:
  CLI::App* app_;
};

}  // namespace tumble::tools
