// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/variation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scenarios/draw/fixed_number.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/sweep/given_errors.hpp"

namespace tumble::scenarios {

namespace {

const std::string kGiven = "given.";

std::vector<std::string> keys_of(const std::string& joined) {
  std::vector<std::string> keys;
  std::stringstream stream(joined);
  for (std::string key; std::getline(stream, key, '+');) keys.push_back(key);
  return keys;
}

Reach reach_of(const std::string& key) {
  if (key.empty()) return Reach::nothing;
  if (key.starts_with(kGiven)) return Reach::input;
  return key.find('/') == std::string::npos ? Reach::simulation : Reach::method;
}

const char* words(Reach reach) {
  switch (reach) {
    case Reach::nothing:
      return "nothing";
    case Reach::simulation:
      return "a scenario parameter";
    case Reach::input:
      return "an input error";
    case Reach::method:
      return "a method parameter";
  }
  return "";
}

const GivenError& given_error(const std::string& key) {
  const std::string name = key.substr(kGiven.size());
  const GivenError* const error = find_given_error(name);
  if (error != nullptr) return *error;
  std::vector<std::string> known;
  for (const GivenError& each : given_errors()) known.emplace_back(each.parameter.name);
  throw BadInput("'" + key + "': unknown input error" + suggestion(name, known));
}

std::pair<std::string, std::string> method_and_parameter(const std::string& key) {
  const std::size_t dot = key.find('.');
  return {key.substr(0, dot), dot == std::string::npos ? "" : key.substr(dot + 1)};
}

void require_settable(const std::string& key, const sim::Parameter& parameter, double value) {
  if (value >= parameter.low && value <= parameter.high) return;
  throw BadInput(fmt::format("the value of key '{}' is {:g} {}; it must be within [{:g}, {:g}]", key, value,
                             parameter.unit, parameter.low, parameter.high));
}

void check_parameter(const std::string& key, std::span<const double> values) {
  const auto [name, number] = method_and_parameter(key);
  const Method& method = *find_methods(name).front();
  const sim::Parameter* const parameter = find_parameter(method.info.parameters, number);
  if (parameter == nullptr) {
    throw BadInput(fmt::format("key '{}': unknown parameter '{}' of method {}{}", key, number, name,
                               suggestion(number, names_of(method.info.parameters))));
  }
  const auto is_whole = [&](const SettingsTable* stage) { return stage->is_whole(parameter->name); };
  const bool whole = std::any_of(method.info.settings.begin(), method.info.settings.end(), is_whole);
  for (const double value : values) {
    require_settable(key, *parameter, value);
    if (whole && value != std::floor(value))
      throw BadInput(fmt::format("the value of key '{}' must be a whole number", key));
  }
}

void check_given(const std::string& key, std::span<const double> values, const Scenario& scenario) {
  const GivenError& error = given_error(key);
  for (const double value : values) require_settable(key, error.parameter, value);
  if (scenario.sensors.empty() || scenario.sensors.front().kind != "imu") {
    throw BadInput(
        fmt::format("key '{}' sets an error of the primary IMU, but the first sensor of scenario {} is not an IMU", key,
                    scenario.name));
  }
  const bool lidar = std::any_of(scenario.sensors.begin(), scenario.sensors.end(),
                                 [](const Scenario::Sensor& sensor) { return sensor.kind.ends_with("lidar"); });
  if (error.needs_lidar && !lidar)
    throw BadInput(
        fmt::format("key '{}' sets an error of the lidar, but scenario {} has no lidar", key, scenario.name));
}

}  // namespace

std::string Variation::key() const {
  std::string joined;
  for (const std::string& key : keys) joined += (joined.empty() ? "" : "+") + key;
  return joined;
}

std::vector<Setting> Variation::settings() const {
  std::vector<Setting> all;
  for (const double value : values) all.push_back({key(), value});
  return all;
}

Reach reach(const Setting& setting) {
  return reach_of(setting.key);
}

bool needs_lidar(const Setting& setting) {
  const std::vector<std::string> keys = keys_of(setting.key);
  return std::any_of(keys.begin(), keys.end(), [](const std::string& key) {
    return reach_of(key) == Reach::input && given_error(key).needs_lidar;
  });
}

void check(const Variation& variation, const DataRoot& data, std::span<const std::string> scenarios,
           std::uint64_t seed) {
  for (const std::string& key : variation.keys) {
    const Reach own = reach_of(key), first = reach_of(variation.keys.front());
    if (own != first) {
      throw BadInput(fmt::format("key '{}' is {}, and key '{}' is {}; keys of different kinds cannot vary together",
                                 key, words(own), variation.keys.front(), words(first)));
    }
    if (own == Reach::method) check_parameter(key, variation.values);
    for (const std::string& name : scenarios) {
      if (own == Reach::input) check_given(key, variation.values, load_scenario(data, name));
    }
  }
  if (reach_of(variation.keys.front()) != Reach::simulation) return;
  for (const std::string& name : scenarios) {
    const Scenario scenario = load_scenario(data, name);
    for (const Setting& setting : variation.settings()) draw(data, with_setting(scenario, setting), seed);
  }
}

Scenario with_setting(Scenario scenario, const Setting& setting) {
  if (reach(setting) == Reach::simulation) {
    for (const std::string& key : keys_of(setting.key)) fix_number(scenario, key, setting.value);
  }
  return scenario;
}

SimulatedDraw with_setting(const SimulatedDraw& draw, const Setting& setting) {
  SimulatedDraw changed = draw;
  if (reach(setting) == Reach::input) {
    if (!draw.built)
      throw BadInput(
          fmt::format("{} applies only to simulated runs, but {} is a recording", setting.key, draw.scenario));
    for (const std::string& key : keys_of(setting.key)) {
      given_error(key).put_in(changed.recording.sensors, changed.recording.truth, changed.built->situation(),
                              setting.value);
    }
  }
  return changed;
}

Method with_setting(const Method& method, const Setting& setting) {
  sim::Values values;
  for (const std::string& key : keys_of(setting.key)) {
    if (reach_of(key) == Reach::method && method_and_parameter(key).first == full_name(method.info)) {
      values.set(method_and_parameter(key).second, setting.value);
    }
    if (reach_of(key) != Reach::input) continue;
    const GivenError& error = given_error(key);
    if (error.tune != nullptr) error.tune(method.info.parameters, setting.value, values);
  }
  Method changed = method;
  if (values.all().empty()) return changed;
  changed.run = [run = method.run, values](const sim::Sensors& sensors, const sim::Values& given,
                                           const OracleInput& oracle) {
    sim::Values all = values;
    for (const auto& [name, value] : given.all()) all.set(name, value);
    return run(sensors, all, oracle);
  };
  return changed;
}

bool concerns(const Setting& setting, const MethodInfo& method) {
  if (reach(setting) != Reach::method) return true;
  const std::vector<std::string> keys = keys_of(setting.key);
  return std::any_of(keys.begin(), keys.end(),
                     [&](const std::string& key) { return method_and_parameter(key).first == full_name(method); });
}

}  // namespace tumble::scenarios
