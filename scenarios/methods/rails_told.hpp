// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Reports the known saturation limits of the primary gyro in `health` (ESTIMATE.md, "Rails"): the level of each axis
/// whose limit was observed, and the plane parameters of a tilted limit. Omits levels taken from another axis or a data
/// sheet.
void tell_rails(const KnownRails& rails, std::map<std::string, double>& health);

/// Reports the saturation limits found by a run of the smoother.
void tell_rails(const RateReport& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
