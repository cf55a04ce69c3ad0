// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Detects single gyro or accelerometer axes that have stopped updating, sample by sample. An axis is frozen if it
/// repeats one reading for 0.5 s, and for ten times the longest earlier repetition, while another axis of the sensor
/// changes. FrozenAxes cannot detect a frozen axis whose readings never changed, or often repeat at rest due to coarse
/// quantisation.
///
/// A saturated axis repeats one reading, but does not count as frozen.
class FrozenAxes {
 public:
  struct ImuRanges {
    double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< ranges from the data sheet; 0: unknown
  };
  struct Axis {
    double reading = 0.0;
    TimeNs since_ns = 0;
    double repeated_s = 0.0;  ///< time since the current reading first appeared
    bool flagged_by_device = false;
    bool is_frozen = false;
    double longest_s = 0.0;  ///< longest earlier repetition while the axis was not frozen
    double changing_readings_duration_s = 0.0;
    double smallest_reading_change = 0.0;  ///< smallest change between two readings so far; 0: none yet
    double min_reading = 0.0, max_reading = 0.0;
    /// minimum, maximum and number of changes of the sensor's two other axes during the repetition
    std::array<double, 2> other_axes_min{}, other_axes_max{}, other_axes_changes{};
    double samples = 0.0;
    bool operator==(const Axis&) const = default;
  };
  struct State {
    std::array<Axis, 6> axes;  ///< gyro x, y, z; accelerometer x, y, z
    std::array<double, 6> previous_readings{};
    TimeNs last_time_ns = 0;
    double rate_max_so_far_rad_s = 0.0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a range is negative or not finite.
  explicit FrozenAxes(const ImuRanges& imu_ranges);

  /// Processes one sample. Samples that are not finite or out of order are ignored. Cost: O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  static const Axis& axis(Triad triad, int axis, const State& state);

  static bool any_frozen(const State& state);
  /// Adds a finding for each currently frozen axis.
  void add_findings(HealthFinding::Kind kind, const std::string& sensor, const State& state,
                    SensorHealth& health) const;

  /// Returns the additional variance of each rate component at `time_ns` because of frozen gyro axes. The standard
  /// deviation of a frozen axis is the largest rate measured so far.
  Eigen::Vector3d rate_variance_rad2_s2(TimeNs time_ns, const State& state) const;

 private:
  void track_repeated_reading(std::size_t channel, const std::array<double, 6>& now, double dt_s, std::uint8_t flags,
                              State& state) const;
  bool is_at_saturation_limit(std::size_t channel, const Axis& axis) const;
  static bool other_axes_change(std::size_t channel, const Axis& axis);

  ImuRanges imu_ranges_;
};

struct FrozenAxis {
  Triad triad = Triad::gyro;
  int axis = 0;
  TimeNs from_ns = 0, to_ns = 0;
};

void add_finding(HealthFinding::Kind kind, const std::string& sensor, const FrozenAxis& interval, SensorHealth& health);

/// Returns the intervals with frozen axes, sorted by axis and time. Cost: O(N).
std::vector<FrozenAxis> find_frozen_axes(const FrozenAxes& detector, std::span<const ImuSample> samples);

}  // namespace tumble
