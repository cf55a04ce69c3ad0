// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// What a verb declares of its command line. CLI11 reads it; its headers cost each source that includes them seconds,
/// so that they stand in verb_options.cpp and program.cpp alone.
namespace tumble::tools {

/// One option or argument, just declared: what else holds of it.
class VerbOption {
 public:
  explicit VerbOption(CLI::Option& option) : option_(&option) {}

  /// Has to be given.
  VerbOption required();
  /// A number from `low` to `high`; what is no number is not within.
  VerbOption within(double low, double high);
  /// A whole number from `low` to `high`.
  VerbOption whole(int low, int high);
  /// Looked at before CLI11 looks for what is missing: `refuse` throws BadInput with its one line.
  VerbOption check(std::function<void(const std::string&)> refuse);
  /// An empty word is refused.
  VerbOption filled();
  /// So many words follow it.
  VerbOption words(int count);
  /// One word follows it each time that it is named; the next is not another one of it.
  VerbOption one_at_a_time();
  /// One word holds several, with this between them.
  VerbOption separated_by(char separator);
  /// `--help` shows what the target held when it was declared.
  VerbOption shows_default();

 private:
  CLI::Option* option_;
};

/// The options of one verb.
class VerbOptions {
 public:
  explicit VerbOptions(CLI::App& app) : app_(&app) {}

  /// `names` as "--seed", "-o,--output", or "SCENARIO" for an argument by its place. `Value` is one of those at the end
  /// of verb_options.cpp; the target outlives the reading.
  template <class Value>
  VerbOption add(const std::string& names, Value& target, const std::string& doc);
  void add_flag(const std::string& name, bool& target, const std::string& doc);
  /// The last line of `--help`.
  void footer(const std::string& line);

 private:
  CLI::App* app_;
};

}  // namespace tumble::tools
