// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/case_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenarios/draw/yaml_text.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kFails = "fails";
constexpr const char* kHolds = "holds";

Expectation expectation_from(const YamlNode& node) {
  static const std::array<std::string, 3> kRequired = {"method", "run", "status"};
  static const std::array<std::string, 4> kOptional = {"metric", "worse_than", "drawn", "value"};
  const auto fields = node.fields(kRequired, kOptional);
  Expectation out;
  out.method = fields.at("method").text();
  const std::string run = fields.at("run").text();
  if (run != kFails && run != kHolds) {
    fields.at("run").fail(fmt::format("the value is '{}'; it must be '{}' or '{}'", run, kFails, kHolds));
  }
  out.fails = run == kFails;
  out.status = fields.at("status").identifier();
  if (fields.contains("metric")) out.metric = fields.at("metric").text();
  const auto number = [&](const std::string& key, std::optional<double>& value) {
    if (!fields.contains(key)) return;
    if (out.metric.empty())
      fields.at(key).fail(
          "this value needs the key 'metric' in the same entry; 'metric' is the name of the value's metric");
    value = fields.at(key).number();
  };
  number("worse_than", out.worse_than);
  number("drawn", out.drawn);
  number("value", out.value);
  return out;
}

std::string to_yaml(const Expectation& expected) {
  std::string out = "    - {method: " + yaml_word(expected.method) + ", run: " + (expected.fails ? kFails : kHolds) +
                    ", status: " + yaml_word(expected.status);
  if (!expected.metric.empty()) out += ", metric: " + yaml_word(expected.metric);
  const auto number = [&](const char* key, const std::optional<double>& value) {
    if (value) out += std::string(", ") + key + ": " + yaml_number(*value, key);
  };
  number("worse_than", expected.worse_than);
  number("drawn", expected.drawn);
  number("value", expected.value);
  return out + "}\n";
}

}  // namespace

NamedCase case_from_yaml(const YamlNode& node) {
  static const std::array<std::string, 5> kKeys = {"scenario", "seed", "version", "command", "expect"};
  const auto fields = node.fields(kKeys);
  NamedCase out;
  out.scenario = fields.at("scenario").text();
  out.seed = fields.at("seed").unsigned_integer();
  out.version = fields.at("version").text();
  out.command = fields.at("command").text();
  for (const YamlNode& item : fields.at("expect").items()) {
    Expectation expected = expectation_from(item);
    const auto same = [&](const Expectation& other) { return other.method == expected.method; };
    if (std::any_of(out.expected.begin(), out.expected.end(), same)) {
      item.fail("method '" + expected.method + "' occurs twice");
    }
    out.expected.push_back(std::move(expected));
  }
  if (out.expected.empty())
    fields.at("expect").fail(
        "the list of expected results is empty; a named case must contain the expected result of at least one method");
  return out;
}

std::string to_yaml(const NamedCase& named) {
  std::string out = "case:\n  scenario: " + yaml_word(named.scenario) + "\n  seed: " + std::to_string(named.seed) +
                    "\n  version: " + yaml_word(named.version) + "\n  command: " + yaml_word(named.command) +
                    "\n  expect:\n";
  for (const Expectation& expected : named.expected) out += to_yaml(expected);
  return out;
}

}  // namespace tumble::scenarios
