// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "scenarios/methods/method.hpp"

/// chosen_method.hpp selects and runs one method on a recording, without the truth.
namespace tumble::tools {

/// Returns the method `name`. Throws BadInput if it does not exist, or cannot process this recording without the truth.
scenarios::MethodPointer chosen_method(const std::string& name, const scenarios::Subject& subject);

/// Runs the method on the sensor data of a recording. A failure of an external command becomes a BadInput. `on_sweep`
/// is that of scenarios::OracleInput.
scenarios::Estimate run_method(const scenarios::Method& method, const sim::Sensors& sensors,
                               std::function<void(std::size_t done, std::size_t all)> on_sweep = {});

/// Explains why a run failed. If the recording lacks sensors, the text names the required sensors.
std::string failure_reason(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
