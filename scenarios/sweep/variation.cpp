// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/variation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "sim/random/stream.hpp"

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
      throw BadInput(
          fmt::format("key '{}' sets {}, but key '{}' sets {}; keys that vary together must be of the same kind", key,
                      words(own), variation.keys.front(), words(first)));
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

namespace {

Eigen::Vector3d direction(sim::Stream& stream) {
  const double z = stream.normal(), y = stream.normal(), x = stream.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

Eigen::Vector3d direction(const sim::Situation& situation, const char* name) {
  sim::Stream stream(situation.seed, std::string("given.") + name);
  return direction(stream);
}

sim::ImuRecord& primary(sim::Sensors& sensors, const sim::Truth& truth) {
  if (sensors.imus.empty() || truth.imus.empty())
    throw BadInput("the recording has no IMU, so this error cannot be applied");
  return sensors.imus.front();
}

/// Adds an error to the calibrated centre of mass, which changes the lever arm of every sensor.
void lever_arm(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const Eigen::Vector3d given_m = primary(sensors, truth).T_BI.translation();
  const Eigen::Vector3d shift_m =
      truth.imus.front().T_BI.translation() + size * direction(situation, "lever_arm") - given_m;
  for (sim::ImuRecord& imu : sensors.imus) imu.T_BI.translation() += shift_m;
  for (sim::LidarRecord& lidar : sensors.lidars) lidar.T_BL.translation() += shift_m;
  for (sim::SeriesRecord& series : sensors.series) series.T_BX.translation() += shift_m;
}

void extrinsic_rotation(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const Eigen::Matrix3d R_BI_given = primary(sensors, truth).T_BI.linear();
  if (sensors.lidars.empty() || truth.lidars.empty())
    throw BadInput("the recording has no lidar, so this error cannot be applied");
  const Eigen::Matrix3d R_IL_true = truth.imus.front().T_BI.linear().transpose() * truth.lidars.front().T_BL.linear();
  const Eigen::AngleAxisd error(size, direction(situation, "extrinsic_rotation"));
  sensors.lidars.front().T_BL.linear() = R_BI_given * R_IL_true * error.toRotationMatrix();
}

void time_offset(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const double own_s = situation.sensors.front().values.at("time_offset_s");
  const auto shift_ns = static_cast<std::int64_t>(std::llround((size - own_s) * 1e9));
  for (std::int64_t& time_ns : primary(sensors, truth).time_ns) time_ns += shift_ns;
}

void radius(sim::Sensors& sensors, const sim::Truth&, const sim::Situation&, double size) {
  if (!(sensors.sphere_radius_m > 0.0))
    throw BadInput("the recording states no sphere radius, but this error needs a recording of a sphere");
  if (!(sensors.sphere_radius_m + size > 0.0))
    throw BadInput("radius_error_m makes the radius zero or negative; choose a smaller error");
  sensors.sphere_radius_m += size;
}

void state_no_rail(sim::ImuRecord& imu) {
  double largest = 0.0;
  for (const Eigen::Vector3d& reading : imu.gyro_rad_s) largest = std::max(largest, reading.lpNorm<Eigen::Infinity>());
  imu.stated_gyro_range_rad_s = std::max(imu.stated_gyro_range_rad_s, 1.1 * largest);
  for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kGyroClipFlags);
}

/// Simulates the output of a rate estimator with a given error. Each clipped reading becomes the unclipped reading plus
/// an error, which is constant within a clipping interval.
void rate_error(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const ClippingTruth clipping(sensors, truth);
  sim::ImuRecord& imu = primary(sensors, truth);
  sim::Stream stream(situation.seed, "given.rate_error");
  std::vector<std::uint8_t> axes(clipping.size());
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = clipping.clipped_axes(i);
  Eigen::Vector3d error_rad_s = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i] == 0) continue;
    if (i == 0 || axes[i - 1] == 0) error_rad_s = size * direction(stream);
    imu.gyro_rad_s[i] = truth.imus.front().gyro_unclipped_rad_s[i] + error_rad_s;
  }
  state_no_rail(imu);
}

void stated_rail(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  sim::ImuRecord& imu = primary(sensors, truth);
  imu.stated_gyro_range_rad_s = situation.sensors.front().values.at("gyro_rail_rad_s") * (1.0 + size);
  for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kGyroClipFlags);
}

void report_rail(std::span<const sim::Parameter> known, double size, sim::Values& given) {
  for (const sim::Parameter& parameter : known) {
    if (parameter.name != "saturation_point_rad_s") continue;
    given.set(std::string(parameter.name), parameter.default_value * (1.0 + size));
  }
}

}  // namespace

std::span<const GivenError> given_errors() {
  static const std::array kErrors = {
      GivenError{{"lever_arm_error_m", 0.0, 0.0, 1.0, "m",
                  "error of the stated lever arm (0: exact lever arm); each simulated run has a random direction of "
                  "the error"},
                 false,
                 lever_arm},
      GivenError{{"extrinsic_rotation_rad", 0.0, 0.0, 3.14, "rad",
                  "error of the stated rotation between IMU and lidar, about a random axis for each simulated run"},
                 true,
                 extrinsic_rotation},
      GivenError{{"time_offset_s", 0.0, -1.0, 1.0, "s", "delay added to the time stamps of the primary IMU"},
                 false,
                 time_offset},
      GivenError{{"radius_error_m", 0.0, -1.0, 1.0, "m",
                  "error of the stated radius of the sphere; positive: the stated radius is too large"},
                 false,
                 radius},
      GivenError{{"rate_error_rad_s", 0.0, 0.0, 1000.0, "rad/s",
                  "error of clipped gyro readings: replaces each clipped reading by the unclipped reading plus an "
                  "error of this magnitude. The error is constant in each clipped segment. Methods receive the new "
                  "readings as unclipped"},
                 false,
                 rate_error},
      GivenError{{"stated_rail_error", 0.0, -0.9, 9.0, "1",
                  "error of the stated gyro range, as a share of the true saturation limit. With this error, methods "
                  "receive no saturation flags from the device"},
                 false,
                 stated_rail,
                 report_rail},
  };
  return kErrors;
}

const GivenError* find_given_error(const std::string& name) {
  const auto all = given_errors();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const GivenError& e) { return e.parameter.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace tumble::scenarios
