// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// What a method knows of the rails of the primary IMU's gyro, as numbers of `health` (ESTIMATE.md, "Rails"): of each
/// axis whose rail the readings have shown, its level, and of one that is a plane all that tells it. Nothing of levels
/// that are taken from another axis or from a sheet.
void tell_rails(const KnownRails& rails, std::map<std::string, double>& health);

/// The same of a run of the smoother.
void tell_rails(const RateReport& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
