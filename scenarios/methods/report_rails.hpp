// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Reports the known saturation limits of the primary gyro in `health` (ESTIMATE.md, "Rails"). The report contains the
/// level of each axis with an observed limit, and the plane parameters of a tilted limit. Levels that were copied from
/// another axis or from a data sheet are omitted.
void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health);

/// Reports the saturation levels that the smoother found in a run.
void report_rails(const RateReport& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
