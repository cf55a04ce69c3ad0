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
      axis_limit_state;                         ///< limits detected from equal readings, and limits from the data sheet
  SaturationPlanes gyro_planes;                 ///< planes of the gyro's saturated readings; empty if not observed
  SaturationPlanes accel_saturation_planes;     ///< planes of the accelerometer's saturated readings
  bool gyro_clips_after_compensation = false;   ///< the gyro clips after misalignment compensation, axis by axis
  bool accel_clips_after_compensation = false;  ///< the accelerometer clips after misalignment compensation

  /// Returns the planes of saturated readings that classify readings as clipped. If the device clips after misalignment
  /// compensation, planes are returned only for sensing elements without a known saturation limit.
  SaturationPlanes saturation_planes_in_use(Triad triad = Triad::gyro) const;
  /// `unknown_sigma` is the standard deviation of a cross-axis sensitivity that no plane of saturated readings
  /// determines.
  SensingDirections rows(Triad triad, double unknown_sigma) const;
  bool operator==(const SaturationLevels&) const = default;
};

enum class SensingAxisReading : std::uint8_t {
  not_clipped,
  clipped_high,  ///< the true component is at or above the saturation limit
  clipped_low,
  invalid_reading  ///< invalid reading
};
SensingAxisReading sensing_axis_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis);

std::uint8_t clip_flags(const Clipping& clipping);

/// ConfirmedSaturation contains the saturation limits that a frozen sensor cannot imitate. Limits from equal readings
/// are excluded, because a frozen sensor also causes equal readings.
struct ConfirmedSaturation {
  SaturationPlanes gyro, accel;                           ///< planes of saturated readings used to classify readings
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< range from the data sheet; 0: unknown
  std::uint8_t flags(const ImuSample& sample, const Clipping& judged) const;
};

/// Finds the clipped readings of a recording from the device's clip flags, from equal readings
/// (SaturationLimitDetector) and from tilted planes of saturated readings (SaturationPlaneFinder).
class ClippingFinder {
 public:
  struct Params {
    SaturationLimitDetector::Params axis_limit_params = {};
    SaturationPlaneFinder::Params gyro_planes =
        {};  ///< if no range is stated here, the range of `axis_aligned_rails` applies
    SaturationPlaneFinder::Params accel_saturation_planes = SaturationPlaneFinder::Params::defaults_for_accelerometer();

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("planes_", p.gyro_planes);
      visit.group("accel_planes_", p.accel_saturation_planes);
    }
  };
  struct ClippingSearchResult {
    SaturationLevels saturation_levels;
    std::vector<Clipping> clipping_per_sample;  ///< one entry per sample
  };

  /// If `use_tilted_planes` is false, ClippingFinder uses only clip flags and equal readings. Throws InvalidParams if a
  /// parameter is out of bounds.
  explicit ClippingFinder(const Params& params, bool use_tilted_planes = true);

  /// The samples must be finite and in time order. Cost: O(N), plus SaturationPlaneFinder::find().
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
