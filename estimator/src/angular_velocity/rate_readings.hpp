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

/// `known` contains the prior calibration, with cross-axis sensitivities from the planes of saturated readings.
struct RateReadings {
  std::vector<RateObservation> observations;  ///< one per sample
  RateModelParams known;
  RailPlanes planes;  ///< planes of saturated readings of the gyro that are used
  std::optional<RepeatedReadings> gyro_repeated;
};

/// Classifies at least two samples. Cost: O(N).
RateReadings read_samples(const RateSmoother::Params& params, const ClippingFinder& rails,
                          const ClippingFinder::Found& found, const std::vector<bool>& rest,
                          std::span<const ImuSample> samples,
                          std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, RateReport& health);

}  // namespace tumble
