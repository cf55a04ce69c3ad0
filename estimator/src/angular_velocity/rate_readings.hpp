// SPDX-License-Identifier: BSD-3-Clause
// What the samples of a recording are worth to RateSmoother.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sample_hold.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble {

/// A recording as the model sees it, and what is known of the rig with what its rails tell.
struct RateReadings {
  std::vector<RateObservation> observations;  ///< one per sample
  RateModelParams known;                      ///< with a calibration
  RailPlanes planes;                          ///< of the gyro's elements, in use
  std::optional<HeldReadings> gyro_held;      ///< of a gyro that is slower than the log
};

/// Judges each sample of at least two by the rails that were found: which elements clip, which axes are read in a part,
/// which may hide that they clip, where the body is at rest, which readings repeat. Fills what `health` says of rails,
/// units and repeats. O(N).
RateReadings read_samples(const RateSmoother::Params& params, const ClippingFinder& rails,
                          const ClippingFinder::Found& found, const std::vector<bool>& rest,
                          std::span<const ImuSample> samples,
                          std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, RateReport& health);

}  // namespace tumble
