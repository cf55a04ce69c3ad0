// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

namespace tumble::scenarios {

/// Adds the observed saturation limits of the primary gyro to `health` (ESTIMATE.md, "Rails"): the limit of each axis,
/// and the plane parameters of tilted limits. Limits that were copied from another axis or from a data sheet are
/// omitted.
void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health);

/// Adds the saturation levels that the rate smoother found to `health`.
void report_rails(const RateReport& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
