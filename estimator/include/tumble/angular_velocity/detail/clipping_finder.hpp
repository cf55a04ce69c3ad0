// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct SaturationLevels {
  SaturationLimitDetector::State
      axis_limit_state;          ///< saturation limits per output axis, from equal readings or the data sheet
  SaturationPlanes gyro_planes;  ///< planes that contain the saturated gyro readings; empty if not observed
  SaturationPlanes accel_saturation_planes;
  bool gyro_clips_after_compensation = false;  ///< the gyro clips each output axis, after its misalignment compensation
  bool accel_clips_after_compensation = false;  ///< the accelerometer clips each output axis

  /// Returns the tilted saturation planes that are used to classify readings as clipped. If the sensor clips each
  /// output axis, the result contains only planes of axes without a known saturation limit.
  SaturationPlanes saturation_planes_in_use(Triad triad = Triad::gyro) const;
  /// Returns the sensing directions of the three sensing elements. `unknown_sigma` is the standard deviation of a
  /// cross-axis sensitivity that no saturation plane determines.
  SensingDirections rows(Triad triad, double unknown_sigma) const;
  bool operator==(const SaturationLevels&) const = default;
};

enum class SensingAxisReading : std::uint8_t {
  not_clipped,
  clipped_high,  ///< the true component is at or above the saturation limit
  clipped_low,
  invalid_reading  ///< the reading overflowed and changed its sign
};
SensingAxisReading sensing_axis_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis);

std::uint8_t clip_flags(const Clipping& clipping);

/// Saturation limits that a frozen sensor cannot imitate. Limits from equal readings are excluded, because a frozen
/// sensor also repeats one reading.
struct ConfirmedSaturation {
  SaturationPlanes gyro, accel;
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< range from the data sheet; 0: unknown
  std::uint8_t flags(const ImuSample& sample, const Clipping& judged) const;
};

/// Finds the clipped readings of a recording from clip flags of the sensor, equal readings (SaturationLimitDetector),
/// and tilted saturation planes (SaturationPlaneFinder).
class ClippingFinder {
 public:
  struct Params {
    SaturationLimitDetector::Params axis_limit_params = {};
    SaturationPlaneFinder::Params gyro_planes = {};  ///< a missing range is taken from `axis_limit_params`
    SaturationPlaneFinder::Params accel_saturation_planes = SaturationPlaneFinder::Params::defaults_for_accelerometer();

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("planes_", p.gyro_planes);
      visit.group("accel_planes_", p.accel_saturation_planes);
    }
  };
  struct ClippingSearchResult {
    SaturationLevels saturation_levels;
    std::vector<Clipping> clipping_per_sample;
  };

  /// If `use_tilted_planes` is false, ClippingFinder uses only clip flags and equal readings. Throws InvalidParams if a
  /// parameter is out of bounds.
  explicit ClippingFinder(const Params& params, bool use_tilted_planes = true);

  /// The samples must be finite and in time order. Cost: O(N) for N samples, plus SaturationPlaneFinder::find().
  ClippingSearchResult find(std::span<const ImuSample> samples) const;

  const SaturationLimitDetector& axis_limit_detector() const { return axis_limit_detector_; }

 private:
  SaturationPlanes find_planes(std::span<const ImuSample> samples, Triad triad,
                               const SaturationLimitDetector::State& axis_aligned_rails,
                               bool& clips_after_compensation) const;

  SaturationLimitDetector axis_limit_detector_;
  // The first index is 0 for the gyro and 1 for the accelerometer.
  std::array<std::array<SaturationPlaneFinder, 2>, 2> plane_finders_;
  bool use_tilted_planes_;
};

}  // namespace tumble
