// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct AuxiliaryRecording {
  AuxiliaryImu imu;  ///< the sensing directions are ignored and estimated by align()
  SaturationLimitDetector::Params stated_saturation_limits;
  std::vector<ImuSample> samples;
};

/// Interpolates the readings of additional IMUs at the time stamps of the primary IMU. Appends each additional IMU,
/// with estimated sensing directions, to `model.auxiliary_imus`, and the interpolated readings to `out`. Recordings
/// beyond the first kAuxiliaryImusMax are ignored. Returns `ok`, or the first error of align() for a single IMU. Cost:
/// O(N), plus ClippingFinder::find().
Status align(std::span<const AuxiliaryRecording> recordings, std::span<const ImuSample> primary, double gap_max_s,
             AngularRateModelParams& model, std::vector<std::vector<AuxiliaryReading>>& out);

}  // namespace tumble
