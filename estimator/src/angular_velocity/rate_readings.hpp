// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sample_hold.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

namespace tumble {

/// `known_params` contains the prior calibration. The detected saturation planes (SaturationPlane) determine the priors
/// of the cross-axis sensitivities.
struct AngularRateReadings {
  std::vector<AngularRateObservation> observations;
  AngularRateModelParams known_params;
  SaturationPlanes gyro_planes;
  std::optional<RepeatedReadings> gyro_repeated;
};

/// Converts IMU samples (at least two) to observations, and marks clipped and repeated readings. Cost: O(number of
/// samples).
AngularRateReadings read_samples(const AngularRateSmoother::Params& params, const ClippingFinder& rails,
                                 const ClippingFinder::ClippingSearchResult& found, const std::vector<bool>& rest,
                                 std::span<const ImuSample> samples,
                                 std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                                 AngularRateReport& health);

}  // namespace tumble
