// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tumble::tools {

class VerbOption {
 public:
  explicit VerbOption(CLI::Option& option) : option_(&option) {}

  VerbOption required();
  VerbOption within(double low, double high);
  VerbOption whole(int low, int high);
  /// The check runs before CLI11 reports missing options; `refuse` throws BadInput with a one-line message.
  VerbOption check(std::function<void(const std::string&)> refuse);
  VerbOption filled();
  VerbOption words(int count);
  VerbOption one_at_a_time();
  VerbOption separated_by(char separator);
  VerbOption shows_default();

 private:
  CLI::Option* option_;
};

class VerbOptions {
 public:
  explicit VerbOptions(CLI::App& app) : app_(&app) {}

  /// The target variable of an option must exist while the command line is parsed.
  template <class Value>
  VerbOption add(const std::string& names, Value& target, const std::string& doc);
  void add_flag(const std::string& name, bool& target, const std::string& doc);
  void footer(const std::string& line);

 private:
  CLI::App* app_;
};

}  // namespace tumble::tools
