// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/external/external_method.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

std::vector<Method> all_methods() {
  std::vector<Method> all = {
      rate_raw(),
      rate_interpolate(),
      rate_saave(),
      rate_tumble(),
      rate_tumble_lag(),
      rate_oracle(),
      attitude_integrate(),
      attitude_madgwick(),
      attitude_complementary(),
      attitude_autogain(),
      attitude_vqf(),
      attitude_tumble(),
      attitude_tumble_lag(),
      attitude_tumble_batch(),
      position_rolling(),  // first, as reference without baseline
      position_autogain_fusion(),
      position_tumble(),
      position_tumble_lag(),
      position_tumble_live(),
      position_oracle(),
      slam_published(),
      slam_icp(),
      slam_icp_raw(),
      slam_tumble(),
      slam_tumble_lag(),
      slam_tumble_live(),
      slam_oracle(),
      slam_poses_rolling(),
      slam_poses_autogain_fusion(),
      slam_poses_tumble(),
      slam_rolling_prior(),
  };
  std::stable_sort(all.begin(), all.end(), [](const Method& a, const Method& b) { return a.info.kind < b.info.kind; });
  return all;
}

MethodPointer method_of_file(const std::string& file, double time_limit_s) {
  auto method = std::make_shared<const Method>(external_method(file, time_limit_s));
  for (const Method& own : methods()) {
    if (full_name(own.info) == full_name(method->info))
      throw BadInput(fmt::format("{}: the method name {} belongs to a built-in method; choose another name", file,
                                 full_name(own.info)));
  }
  return method;
}

std::vector<MethodPointer> find_within(const std::string& name, double time_limit_s) {
  if (is_method_file(name)) return {method_of_file(name, time_limit_s)};
  std::vector<MethodPointer> found;
  std::vector<std::string> known;
  for (const Method& method : methods()) {
    if (name == method.info.name || name == full_name(method.info)) found.push_back(unowned(method));
    known.push_back(method.info.name);
    known.push_back(full_name(method.info));
  }
  if (found.empty()) {
    const std::string near = sim::did_you_mean(name, known);
    throw BadInput("unknown method '" + name + "'; " + (near.empty() ? "see 'tumble list methods'" : near));
  }
  return found;
}

}  // namespace

RunMethod with_settings(const MethodInfo& info, RunMethod run) {
  return [place = "method " + full_name(info), settings = info.settings, run = std::move(run)](
             const sim::Sensors& sensors, const sim::Values& given, const OracleInput& oracle) {
    try {
      return run(sensors, resolve_settings(place, given, settings), oracle);
    } catch (const sim::InvalidSituation& error) {
      throw BadInput(error.what());
    } catch (const InvalidParams& error) {
      throw BadInput(place + ": " + error.what());
    }
  };
}

Method make_method(MethodInfo info, RunCore run) {
  if (info.ours && info.source.empty()) info.source = "ours";
  const auto parameters =
      std::make_shared<const std::vector<sim::Parameter>>(joined_rows(info.settings, info.parameters_first));
  info.parameters = *parameters;
  RunMethod wrapped = [name = full_name(info), parameters, needs_truth = info.needs_truth,
                       resolved = with_settings(info, run)](const sim::Sensors& sensors, const sim::Values& given,
                                                            const OracleInput& oracle) {
    if (needs_truth && oracle.truth == nullptr) {
      throw BadInput(fmt::format("method {} needs the truth, but this recording has none", name));
    }
    return resolved(sensors, given, {.truth = needs_truth ? oracle.truth : nullptr, .on_sweep = oracle.on_sweep});
  };
  return {std::move(info), std::move(wrapped)};
}

std::span<const Method> methods() {
  static const std::vector<Method> all = all_methods();
  return all;
}

bool is_method_file(const std::string& name) {
  return name.ends_with(".yaml") || name.ends_with(".py");
}

std::vector<MethodPointer> find_methods(const std::string& name) {
  return find_within(name, std::numeric_limits<double>::infinity());
}

std::vector<MethodPointer> find_methods(std::span<const std::string> names) {
  return find_methods_within(names, std::numeric_limits<double>::infinity());
}

std::vector<MethodPointer> find_methods_within(std::span<const std::string> names, double time_limit_s) {
  std::vector<MethodPointer> found;
  std::map<std::string, std::string> asked;
  for (const std::string& name : names) {
    for (MethodPointer& method : find_within(name, time_limit_s)) {
      const auto [before, is_new] = asked.emplace(full_name(method->info), name);
      if (is_new) {
        found.push_back(std::move(method));
      } else if (is_method_file(name) && before->second != name) {
        throw BadInput(fmt::format("methods '{}' and '{}' have the same name, {}; give each method its own name",
                                   before->second, name, full_name(method->info)));
      }
    }
  }
  return found;
}

std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position) {
  own.insert(own.end(), position.info.settings.begin(), position.info.settings.end());
  return own;
}

sim::Values values_of(const Method& position, const sim::Values& parameters) {
  sim::Values own;
  for (const sim::Parameter& each : position.info.parameters) {
    const std::string name(each.name);
    if (parameters.has(name)) own.set(name, parameters.at(name));
  }
  return own;
}

void count_sources(std::span<const AngularRateState> rates, std::map<std::string, double>& health) {
  for (const AngularRateState& rate : rates) health[std::string("samples_") + to_string(rate.source)] += 1.0;
}

namespace {

struct GivenParameter {
  std::string text, method, name;
  double value = 0.0;
};

GivenParameter parsed(const std::string& text) {
  const std::size_t dot = text.find('.'), equals = text.find('=');
  GivenParameter out{text, "", "", 0.0};
  bool good = dot != std::string::npos && equals != std::string::npos && 0 < dot && dot + 1 < equals;
  if (good) {
    out.method = text.substr(0, dot);
    out.name = text.substr(dot + 1, equals - dot - 1);
    good = read_number(std::string_view(text).substr(equals + 1), out.value);
  }
  if (!good)
    throw BadInput(fmt::format(
        "the parameter '{}' must have the form METHOD.PARAMETER=NUMBER, for example rate/tumble_lag.lag_s=0.5", text));
  return out;
}

Method with(const Method& method, const sim::Values& chosen) {
  Method out = method;
  out.run = [run = method.run, chosen](const sim::Sensors& sensors, const sim::Values& given,
                                       const OracleInput& oracle) {
    sim::Values all = chosen;
    for (const auto& [name, value] : given.all()) all.set(name, value);
    Estimate estimate = run(sensors, all, oracle);
    estimate.parameters = chosen.all();
    return estimate;
  };
  return out;
}

}  // namespace

std::vector<Method> with_parameters(std::span<const MethodPointer> methods, std::span<const std::string> texts) {
  std::vector<sim::Values> chosen(methods.size());
  for (const std::string& text : texts) {
    const GivenParameter given = parsed(text);
    bool concerned = false;
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const MethodInfo& info = methods[k]->info;
      if (given.method != info.name && given.method != full_name(info)) continue;
      concerned = true;
      if (chosen[k].has(given.name)) throw BadInput("'" + text + "': " + given.name + " is given twice");
      chosen[k].set(given.name, given.value);
      try {
        (void)resolve_settings("method " + full_name(info), chosen[k], info.settings);
      } catch (const sim::InvalidSituation& error) {
        throw BadInput(error.what());
      }
    }
    if (!concerned)
      throw BadInput(
          fmt::format("'{}': the parameter belongs to no method of this run; add the method '{}'", text, given.method));
  }
  std::vector<Method> out;
  for (std::size_t k = 0; k < methods.size(); ++k) out.push_back(with(*methods[k], chosen[k]));
  return out;
}

}  // namespace tumble::scenarios
