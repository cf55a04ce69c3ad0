// SPDX-License-Identifier: BSD-3-Clause
// Classification of a recording's samples for RateSmoother.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sample_hold.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble {

/// A recording as input of the model, with the prior calibration including information from saturation planes.
struct RateReadings {
  std::vector<RateObservation> observations;  ///< one per sample
  RateModelParams known;
  RailPlanes planes;  ///< of the gyro's elements, in use
  std::optional<RepeatedReadings> gyro_repeated;
};

/// Classifies at least two samples with the detected saturation levels: clipped elements, partly saturated axes,
/// suspect axes, rest, and repeated readings. Sets levels, units and repetitions in `health`. Cost: O(N).
RateReadings read_samples(const RateSmoother::Params& params, const ClippingFinder& rails,
                          const ClippingFinder::Found& found, const std::vector<bool>& rest,
                          std::span<const ImuSample> samples,
                          std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, RateReport& health);

}  // namespace tumble
