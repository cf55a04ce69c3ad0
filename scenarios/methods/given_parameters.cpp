// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/given_parameters.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

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
