// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rail_detector.hpp"
#include "tumble/angular_velocity/detail/rail_planes.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct SaturationLevels {
  RailDetector::State axis_aligned_rails;       ///< limits detected from equal readings, and limits from the data sheet
  RailPlanes planes;                            ///< planes of the gyro's saturated readings; empty if not observed
  RailPlanes accel_planes;                      ///< planes of the accelerometer's saturated readings
  bool gyro_clips_after_compensation = false;   ///< the gyro clips after misalignment compensation, axis by axis
  bool accel_clips_after_compensation = false;  ///< the accelerometer clips after misalignment compensation

  /// Returns the planes of saturated readings that classify readings as clipped. If the device clips after misalignment
  /// compensation, planes are returned only for sensing elements without a known saturation limit.
  RailPlanes planes_in_use(Triad triad = Triad::gyro) const;
  /// `unknown_sigma` is the standard deviation of a cross-axis sensitivity that no plane of saturated readings
  /// determines.
  SensingDirections rows(Triad triad, double unknown_sigma) const;
  bool operator==(const SaturationLevels&) const = default;
};

enum class ElementReading : std::uint8_t {
  measured,
  clipped_high,  ///< the true component is at or above the saturation limit
  clipped_low,
  unreadable  ///< invalid reading
};
ElementReading element_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis);

std::uint8_t clip_flags(const Clipping& clipping);

/// ConfirmedSaturation contains the saturation limits that a frozen sensor cannot imitate. Limits from equal readings
/// are excluded, because a frozen sensor also causes equal readings.
struct ConfirmedSaturation {
  RailPlanes gyro, accel;                                 ///< planes of saturated readings used to classify readings
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< range from the data sheet; 0: unknown
  std::uint8_t flags(const ImuSample& sample, const Clipping& judged) const;
};

/// Finds the clipped readings of a recording from the device's clip flags, from equal readings (RailDetector) and from
/// tilted planes of saturated readings (RailPlaneFinder).
class ClippingFinder {
 public:
  struct Params {
    RailDetector::Params axis_aligned_rails = {};
    RailPlaneFinder::Params planes = {};  ///< if no range is stated here, the range of `axis_aligned_rails` applies
    RailPlaneFinder::Params accel_planes = RailPlaneFinder::Params::for_accelerometer();
    /// If `tilted` is false, ClippingFinder uses only clip flags and equal readings.
    bool tilted = true;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("planes_", p.planes);
      visit.group("accel_planes_", p.accel_planes);
      visit(p.tilted,
            switch_field(
                "tilted",
                "1: also detect tilted saturation limits; 0: use only upright saturation limits and the device's clip "
                "flags"));
    }
  };
  struct Found {
    SaturationLevels rails;
    std::vector<Clipping> clippings;  ///< one entry per sample
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit ClippingFinder(const Params& params);

  /// The samples must be finite and in time order. Cost: O(N), plus RailPlaneFinder::find().
  Found find(std::span<const ImuSample> samples) const;

  const RailDetector& axis_aligned_rails() const { return axis_aligned_rails_; }

 private:
  RailPlanes find_planes(std::span<const ImuSample> samples, Triad triad, const RailDetector::State& axis_aligned_rails,
                         bool& clips_after_compensation) const;

  RailDetector axis_aligned_rails_;
  // The first index is 0 for the gyro and 1 for the accelerometer.
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;
  bool tilted_;
};

}  // namespace tumble
