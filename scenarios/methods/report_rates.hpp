// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "scenarios/methods/method.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble::scenarios {

void report_rates(const MotionRegimeSmoother::Report& report, Estimate& result);

/// Saturation limits that were copied from another axis or from a data sheet are not reported.
void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health);

std::optional<double> carried_share(const MotionRegimeSmoother::Report& report);

void report_gaps(std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
