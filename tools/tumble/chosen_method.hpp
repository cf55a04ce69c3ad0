// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"
#include "tumble/common/status.hpp"

namespace tumble::tools {

scenarios::MethodPointer chosen_method(const std::string& name, const scenarios::Subject& subject);

/// `on_sweep` is that of scenarios::OracleInput.
scenarios::Estimate run_method(const scenarios::Method& method, const sim::Sensors& sensors,
                               std::function<void(std::size_t done, std::size_t all)> on_sweep = {});

std::string failure_reason(const Status& status, const sim::Sensors& sensors);

std::string trouble_place(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
