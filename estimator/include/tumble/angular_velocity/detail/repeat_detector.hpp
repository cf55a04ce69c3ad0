// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// If a sensor repeats a reading for more than kSlowest samples, the cause is rest, saturation or a frozen axis.
namespace sample_hold {
inline constexpr double kMoving_rad_s = 0.3, kRepeatsMin = 0.05, kSlowest = 10.0, kAgreementMin = 0.9;
inline constexpr std::size_t kMovingMin = 30, kMovingMax = 1000;
}  // namespace sample_hold

/// RepeatedReadings describes a gyro or accelerometer whose readings repeat in the log (sample and hold), because its
/// sample rate is lower than the rate of the log.
struct RepeatedReadings {
  double period_s = 0.0;  ///< time between two readings
  /// fraction of samples for which a clock with constant period predicts correctly whether the reading is repeated
  double regular_clock_fraction = 0.0;
  std::vector<double> age_s;             ///< per sample: age of its reading in addition to window_lag_s
  std::vector<bool> repeats_per_sample;  ///< per sample: whether the reading equals the previous sample's reading
  /// A gyro averages over its sample period. An accelerometer averages over an unknown part of its sample period:
  /// carried.md (C11), (C12).
  double window_lag_s = 0.0;

  bool has_regular_clock() const { return regular_clock_fraction >= sample_hold::kAgreementMin; }
  /// Returns the time from the middle of the sensor's averaging window to the middle of the sample period.
  double reading_age_s(std::size_t sample) const { return age_s[sample] + window_lag_s; }
};

/// Detects whether the log repeats readings of a sensor, and estimates period and phase of the sensor's clock from the
/// repetitions. Cost: O(N), plus a test of about 5000 candidate clocks on at most 1000 samples. Returns nothing if
/// fewer than 30 gyro readings exceed 0.3 rad/s, or if less than 5 % of the readings above 0.3 rad/s are repeated.
/// `age_s` is zero if no clock with constant period predicts the repetitions of 90 % of the samples.
std::optional<RepeatedReadings> find_repeated(std::span<const ImuSample> samples, Triad triad);

struct Neighbours {
  const ImuSample *previous_sample = nullptr, *next_sample = nullptr;
};
/// Returns for each sample the nearest earlier and later samples with a different reading. All samples of a run of
/// equal readings (repetition, rest, saturation) get the same earlier and later sample.
std::vector<Neighbours> neighbouring_readings(std::span<const ImuSample> samples, Triad triad);

/// Repetition of a reading in consecutive samples (sample and hold), which occurs if the sensor updates more slowly
/// than the log.
struct RepeatedReading {
  bool repeats_reading = false;
  double age_samples = 0.0;             ///< mean age of the reading at the sample's time stamp
  double reading_period_samples = 1.0;  ///< number of samples per new reading; 1: no repetition
  Eigen::Vector3d reading_change =
      Eigen::Vector3d::Zero();  ///< new reading minus previous reading [unit of the reading]

  bool is_slower_than_samples() const { return reading_period_samples > 1.0; }
  /// Returns the time from the middle of the reading's averaging window to the middle of the sample's averaging window,
  /// in samples.
  double delay_samples() const {
    return is_slower_than_samples() ? age_samples + 0.5 * (reading_period_samples - 1.0) : 0.0;
  }
  /// Returns the extrapolated change of the signal since the last new reading, with the slope between the last two
  /// readings.
  Eigen::Vector3d change_since_new_reading() const;
  bool operator==(const RepeatedReading&) const = default;
};

/// Detects, sample by sample, whether a log has a higher sample rate than the sensor and repeats readings:
/// rate_stream.md (R95). The age of a new reading is 0.5 +- 0.29 samples, because the phase of the sensor's clock is
/// unknown.
class RepeatDetector {
 public:
  struct RepetitionMemory {
    Eigen::Vector3d reading = Eigen::Vector3d::Zero();
    double equal_samples = 0.0;
    double moving = 0.0,
           repeated = 0.0;  ///< number of samples in motion, and of repetitions among them; both decay slowly
    RepeatedReading now;
    bool operator==(const RepetitionMemory&) const = default;
  };
  struct State {
    std::array<RepetitionMemory, 2> repetition;  ///< indexed by Triad
    const RepeatedReading& for_triad(Triad triad) const { return repetition[static_cast<std::size_t>(triad)].now; }
    bool operator==(const State&) const = default;
  };

  /// Processes a finite sample. Samples with `clipped` are ignored, because a clipped gyro repeats its reading at any
  /// update rate. Cost: O(1), no allocation.
  void observe_reading(const ImuSample& sample, bool clipped, State& state) const;
};

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
