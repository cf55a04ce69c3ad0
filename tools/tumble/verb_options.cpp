// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verb_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace tumble::tools {

VerbOption VerbOption::required() {
  option_->required();
  return *this;
}

VerbOption VerbOption::within(double low, double high) {
  const std::string range = fmt::format("{:g} to {:g}", low, high);
  option_->check(CLI::Validator(
      [low, high, range](std::string& text) {
        double value = 0.0;
        const bool read = CLI::detail::lexical_cast(text, value);
        return read && value >= low && value <= high
                   ? std::string()
                   : fmt::format("the number {} is out of range; it must be from {}", text, range);
      },
      range));
  return *this;
}

VerbOption VerbOption::whole(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

VerbOption VerbOption::check(std::function<void(const std::string&)> refuse) {
  option_->check(CLI::Validator(
      [refuse = std::move(refuse)](std::string& text) {
        refuse(text);
        return std::string();
      },
      ""));
  return *this;
}

VerbOption VerbOption::filled() {
  option_->check(
      CLI::Validator([](std::string& text) { return text.empty() ? std::string("is empty") : std::string(); }, ""));
  return *this;
}

VerbOption VerbOption::words(int count) {
  option_->expected(count);
  return *this;
}

VerbOption VerbOption::one_at_a_time() {
  option_->allow_extra_args(false);
  return *this;
}

VerbOption VerbOption::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

VerbOption VerbOption::shows_default() {
  option_->capture_default_str();
  return *this;
}

template <class Value>
VerbOption VerbOptions::add(const std::string& names, Value& target, const std::string& doc) {
  return VerbOption(*app_->add_option(names, target, doc));
}

void VerbOptions::add_flag(const std::string& name, bool& target, const std::string& doc) {
  app_->add_flag(name, target, doc);
}

void VerbOptions::footer(const std::string& line) {
  app_->footer(line);
}

template VerbOption VerbOptions::add(const std::string&, std::string&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::filesystem::path&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, int&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::size_t&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, double&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::optional<std::size_t>&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::optional<int>&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::optional<double>&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::vector<double>&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::vector<std::string>&, const std::string&);
template VerbOption VerbOptions::add(const std::string&, std::vector<std::filesystem::path>&, const std::string&);

}  // namespace tumble::tools
