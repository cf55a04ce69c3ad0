// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "scenarios/methods/method.hpp"

/// chosen_method.hpp selects and runs one method on a recording, without the truth.
namespace tumble::tools {

/// Returns the method with this name that can run on this recording without the truth. Throws BadInput.
scenarios::MethodPointer chosen_method(const std::string& name, const scenarios::Subject& subject);

/// Runs the method on the sensor data. A failure of an external command becomes a BadInput. `on_sweep` is that of
/// scenarios::OracleInput.
scenarios::Estimate run_method(const scenarios::Method& method, const sim::Sensors& sensors,
                               std::function<void(std::size_t done, std::size_t all)> on_sweep = {});

/// Returns why a run failed; names the required sensors if the recording lacks sensors.
std::string failure_reason(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
