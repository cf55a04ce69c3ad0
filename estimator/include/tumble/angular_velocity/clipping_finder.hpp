// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// SaturationLevels contains the saturation levels of an IMU.
struct SaturationLevels {
  RailDetector::State axis_aligned_rails;       ///< levels found from equal readings, and stated ranges
  RailPlanes planes;                            ///< saturation planes of the gyro's sensing elements, where observed
  RailPlanes accel_planes;                      ///< saturation planes of the accelerometer
  bool gyro_clips_after_compensation = false;   ///< the gyro clips after compensation, so other axes are unaffected
  bool accel_clips_after_compensation = false;  ///< the accelerometer clips after compensation

  /// Returns the saturation planes that are used to classify readings. If the device clips its output after
  /// compensation, a run of equal readings identifies clipped samples exactly. If equal readings identify clipped
  /// samples, the function returns planes only for sensing elements without a known saturation level.
  RailPlanes planes_in_use(Triad triad = Triad::gyro) const;
  /// Returns the directions along which the sensing elements of the triad (gyro or accelerometer) measure.
  /// `unknown_sigma` is the standard deviation of a cross-axis sensitivity that no saturation plane determines.
  SensingDirections rows(Triad triad, double unknown_sigma) const;
  bool operator==(const SaturationLevels&) const = default;
};

/// ElementReading describes what information the reading of one sensing element provides.
enum class ElementReading : std::uint8_t {
  measured,
  clipped_high,  ///< lower bound: the true component is at or beyond the saturation level
  clipped_low,
  unreadable  ///< no information
};
/// Returns what information sensing element `axis` of a classified sample provides.
ElementReading element_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis);

/// Returns the ClipFlag bits of a classified sample, as a device with correct flags would set the bits.
std::uint8_t clip_flags(const Clipping& clipping);

/// ConfirmedSaturation contains the saturation levels that are certain enough for comparing several IMUs that may
/// freeze. A saturation level that is derived from equal readings alone is not certain. ConfirmedSaturation excludes
/// flat maxima of slow motion far below the stated range, and repeated readings without a stated range.
/// ConfirmedSaturation includes saturation planes, because slow motion and frozen sensors do not produce planes.
struct ConfirmedSaturation {
  RailPlanes gyro, accel;                                 ///< saturation planes that are used to classify readings
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< stated range; 0: not stated
  /// Returns the clip flags of a classified sample, in addition to the flags that the device set.
  std::uint8_t flags(const ImuSample& sample, const Clipping& judged) const;
};

/// Finds the clipped readings of a recording, for every estimator that processes whole recordings. ClippingFinder
/// combines flags of the device, saturation levels from equal readings (RailDetector) and tilted saturation planes
/// (RailPlaneFinder). StreamingClippingFinder applies the rules of ClippingFinder to the window of RateStream.
class ClippingFinder {
 public:
  struct Params {
    RailDetector::Params axis_aligned_rails = {};
    RailPlaneFinder::Params planes = {};  ///< without a stated range, the range of `axis_aligned_rails` applies
    /// Parameters of the search for saturation planes of the accelerometer.
    RailPlaneFinder::Params accel_planes = RailPlaneFinder::Params::for_accelerometer();
    /// If `tilted` is false, clipping is detected only from flags and equal readings, as in the published methods.
    bool tilted = true;

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.axis_aligned_rails);
      visit.group("planes_", p.planes);
      visit.group("accel_planes_", p.accel_planes);
      visit(
          p.tilted,
          switch_field(
              "tilted",
              "1: also search tilted saturation limits; 0: search only upright ones and use the device's clip flags"));
    }
  };
  struct Found {
    SaturationLevels rails;
    std::vector<Clipping> clippings;  ///< one per sample
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit ClippingFinder(const Params& params);

  /// Classifies all samples of a recording. Cost: O(N), plus the search of RailPlaneFinder. The samples must be finite
  /// and in time order.
  Found find(std::span<const ImuSample> samples) const;

  const RailDetector& axis_aligned_rails() const { return axis_aligned_rails_; }

 private:
  RailPlanes find_planes(std::span<const ImuSample> samples, Triad triad, const RailDetector::State& axis_aligned_rails,
                         bool& clips_after_compensation) const;

  RailDetector axis_aligned_rails_;
  // index 0: gyro, index 1: accelerometer; inner index 1: finder for readings that exceed the stated range
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;
  bool tilted_;
};

}  // namespace tumble
