// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/chosen_method.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/external_method.hpp"
#include "tools/tumble/trouble_place.hpp"

namespace tumble::tools {

using scenarios::BadInput;

std::string failure_reason(const Status& status, const sim::Sensors& sensors) {
  const std::string field = status.field;
  if (status.error_code == ErrorCode::empty && field == "imus")
    return "the method needs an IMU, but the recording contains no IMU";
  const std::string place = trouble_place(status, sensors);
  return status.message() + (place.empty() ? "" : ": " + place);
}

scenarios::MethodPointer chosen_method(const std::string& name, const scenarios::Subject& subject) {
  std::vector<scenarios::MethodPointer> fitting;
  std::string refused;
  for (const scenarios::MethodPointer& method : scenarios::find_methods(name)) {
    if (method->info.needs_truth) {
      refused = fmt::format("method '{}' needs the truth, which this verb never reads; use 'tumble run' instead",
                            full_name(method->info));
    } else if (const std::string why = method->info.why_not(subject); !why.empty()) {
      refused = "method '" + full_name(method->info) + "': it " + why;
    } else {
      fitting.push_back(method);
    }
  }
  if (fitting.empty()) throw BadInput(refused);
  if (fitting.size() > 1) {
    std::string line = fmt::format("--method {} is the name of several methods; choose one of:", name);
    for (const scenarios::MethodPointer& method : fitting) line += " " + full_name(method->info);
    throw BadInput(line);
  }
  return fitting.front();
}

scenarios::Estimate run_method(const scenarios::Method& method, const sim::Sensors& sensors,
                               std::function<void(std::size_t done, std::size_t all)> on_sweep) {
  try {
    return method.run(sensors, {}, {.truth = nullptr, .on_sweep = std::move(on_sweep)});
  } catch (const scenarios::NoAnswer& error) {
    throw BadInput(full_name(method.info) + ": " + error.what());
  }
}

}  // namespace tumble::tools
