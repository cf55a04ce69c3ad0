// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

namespace tumble::scenarios {

/// Saturation limits that were copied from another axis or from a data sheet are not reported.
void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health);

void report_rails(const RateReport& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
