// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble::scenarios {

const Settings<AngularRateSmoother::Params>& rate_tumble_settings();

const std::vector<std::string>& stated_densities();

AngularRateSmoother::Params stated_params(const sim::ImuRecord& record, AngularRateSmoother::Params params);

/// Values in `parameters` override values from the IMU record, which override the default values of `settings`.
AngularRateSmoother::Params smoother_params(const sim::ImuRecord& record,
                                            const Settings<AngularRateSmoother::Params>& settings,
                                            const sim::Values& parameters);

MotionRegimeSmoother::Params regime_params(const sim::Sensors& sensors, const AngularRateSmoother::Params& rate);

Status auxiliary_recordings(const sim::Sensors& sensors, std::vector<AuxiliaryRecording>& out);

/// Estimates the rates from the primary IMU and all auxiliary IMUs. If the data of one auxiliary IMU are invalid, only
/// the primary IMU is used.
RecoveredRates recovered_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                  ReadingsToReplace replaced, Estimate& estimate);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
