// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/types.hpp"

namespace tumble {

struct Clipping {
  std::uint8_t gyro = 0;           ///< bit j: gyro axis j is saturated; the true magnitude is at least the reading
  std::uint8_t accel = 0;          ///< bit j: accelerometer axis j is saturated
  std::uint8_t unusable_gyro = 0;  ///< bit j: gyro axis j overflowed, with flipped sign, and is unusable
  bool operator==(const Clipping&) const = default;
};

struct SaturationLimitDetectorParams {
  /// Measuring range of the gyro [rad/s], in (0, 1000], and of the accelerometer [m/s^2], in (0, 1e5], according to the
  /// data sheet or the user.
  std::optional<double> stated_gyro_range_rad_s = std::nullopt;
  std::optional<double> stated_accel_range_m_s2 = std::nullopt;

  /// Saturation limits of an earlier run of the device, in the order of SaturationLimitDetector::State::channels; 0:
  /// none. SaturationLimitDetector uses known limits from the start of a run until readings exceed the limits.
  std::array<double, 6> known = {};
};

/// Detects the saturation limit of each gyro and accelerometer axis from the readings of the axis. The saturation limit
/// of a device may differ from the stated range in its data sheet.
///
/// A plateau is a run of readings of one sign that are closer together than sensor noise allows.
/// SaturationLimitDetector uses the stated range until a plateau is found or a reading exceeds the stated range.
/// Readings that the device flags as clipped also count as clipped. SaturationLimitDetector assumes constant saturation
/// limits that are equal for both signs of an axis.
class SaturationLimitDetector {
 public:
  using Params = SaturationLimitDetectorParams;

  /// The channels are gyro x, y, z, then accelerometer x, y, z.
  struct Channel {
    double plateau_limit = 0.0;  ///< saturation limit from a plateau; 0: none found
    double peak = 0.0;           ///< largest magnitude so far
    double plateau_first_reading = 0.0;
    int run_length = 0;
    double previous_reading = 0.0;    ///< previous reading
    double entry_change = 0.0;        ///< change of the reading before the current equal readings; 0: no change yet
    double min_reading_change = 0.0;  ///< smallest observed change between two readings; 0: none yet
    double last = 0.0;
    bool is_clipped = false;
    bool operator==(const Channel&) const = default;
  };
  struct State {
    std::array<Channel, 6> channels;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit SaturationLimitDetector(const Params& params);

  State start() const;
  /// The sample must be finite. Cost: O(1).
  void observe_reading(const ImuSample& sample, State& state) const;
  /// The sample must be finite. Cost: O(1).
  Clipping classify_clipping(const ImuSample& sample, State& state) const;
  /// Classifies all samples of a recording with the saturation limits of the whole recording. Cost: O(N).
  void classify_clipping_of_all(std::span<const ImuSample> samples, State& state, std::span<Clipping> out) const;

  /// Adds the axes to `clipping` that are near the saturation limit in `sample` and clipped in the next sample `next`.
  void add_rising_edge_at_limit(const ImuSample& sample, const ImuSample& next, const Clipping& of_next,
                                const State& state, Clipping& clipping) const;

  /// Returns the saturation limit of channel c (0-5): from a plateau of channel c, the largest plateau on another axis,
  /// or the stated range. A limit from another axis or from the stated range applies only while all readings of channel
  /// c are below the limit.
  std::optional<double> saturation_limit(const State& state, int c) const;
  /// Returns true if a plateau or a larger reading contradicts the stated range of channel c.
  bool disagrees(const State& state, int c) const;

 private:
  std::optional<double> stated_saturation_limit(int c) const;
  bool plateau(int c, const Channel& channel, double jump) const;
  Params params_;
};

}  // namespace tumble
