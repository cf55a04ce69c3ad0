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
  std::uint8_t gyro = 0;  ///< bit j: gyro axis j is saturated; the true rate is at least the reading
  std::uint8_t accel = 0;
  std::uint8_t unusable_gyro = 0;  ///< bit j: gyro axis j overflowed and changed its sign
  bool operator==(const Clipping&) const = default;
};

struct SaturationLimitDetectorParams {
  /// Range of the gyro [rad/s], in (0, 1000], and of the accelerometer [m/s^2], in (0, 1e5], from the data sheet or the
  /// user.
  std::optional<double> stated_gyro_range_rad_s = std::nullopt;
  std::optional<double> stated_accel_range_m_s2 = std::nullopt;

  /// Saturation limits from an earlier run of the IMU, for gyro x, y, z and accelerometer x, y, z; 0: unknown. A known
  /// limit is used until a reading exceeds the limit.
  std::array<double, 6> known = {};
};

/// Detects the saturation limit of each gyro and accelerometer axis from the readings of the axis. The saturation limit
/// of a sensor may differ from the range in its data sheet.
///
/// A plateau is a run of readings of one sign that differ by less than the sensor noise. A plateau determines the
/// saturation limit. Until a plateau is found, the range in the data sheet is the limit, unless a reading exceeds this
/// range. Readings that the IMU flags as clipped also count as clipped. SaturationLimitDetector assumes constant
/// saturation limits that are equal for both signs of an axis.
class SaturationLimitDetector {
 public:
  using Params = SaturationLimitDetectorParams;

  /// State of one axis; the order of the axes is gyro x, y, z, accelerometer x, y, z.
  struct Channel {
    double plateau_limit = 0.0;  ///< saturation limit from a plateau; 0: no plateau yet
    double peak = 0.0;
    double plateau_first_reading = 0.0;
    int run_length = 0;
    double previous_reading = 0.0;
    double entry_change =
        0.0;  ///< last change of the reading before the current run of equal readings; 0: no change yet
    double min_reading_change = 0.0;  ///< smallest change between two readings so far; 0: none yet
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
  /// Finds the clipped axes of all samples, with the saturation limits of the whole recording. Cost: O(N).
  void classify_clipping_of_all(std::span<const ImuSample> samples, State& state, std::span<Clipping> out) const;

  /// Adds to `clipping` the axes that are near the saturation limit in `sample` and clipped in the next sample `next`.
  void add_rising_edge_at_limit(const ImuSample& sample, const ImuSample& next, const Clipping& of_next,
                                const State& state, Clipping& clipping) const;

  /// Returns the saturation limit of axis c (gyro x, y, z, accelerometer x, y, z). The limit is from a plateau of the
  /// axis, the largest plateau of another axis of the sensor, or the data sheet. The last two apply only while all
  /// readings of the axis are below the limit.
  std::optional<double> saturation_limit(const State& state, int c) const;
  /// Returns true if a plateau or a larger reading contradicts the stated range of axis c.
  bool disagrees(const State& state, int c) const;

 private:
  std::optional<double> stated_saturation_limit(int c) const;
  bool plateau(int c, const Channel& channel, double jump) const;
  Params params_;
};

}  // namespace tumble
