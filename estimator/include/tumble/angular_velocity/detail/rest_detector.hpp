// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Detects when an IMU is stationary. The mean rate must be a plausible gyro bias, the specific force must be a
/// plausible gravity, and both must be constant up to noise.
///
/// RestDetector first averages the readings over `reading_s` (CallerSettings), so that the parameters do not depend on
/// the sample rate. White noise of density n [unit/sqrt(Hz)] has the standard deviation n / sqrt(reading_s) after
/// averaging. Set `rate_spread_rad_s` and `force_spread_m_s2` to at least five standard deviations of the averaged
/// noise. A steady rotation about the vertical slower than `rate_max_rad_s` also counts as rest.
class RestDetector {
 public:
  /// Values that the calling estimator sets; they are not parameters for users.
  struct CallerSettings {
    double force_min_m_s2 = 5.0;  ///< minimum specific force at rest; excludes free flight
    double force_max_m_s2 = 1e3;  ///< maximum specific force at rest; excludes impacts
    double reading_s = 0.01;      ///< averaging time of a reading; 0: each sample is a reading
    double memory_s = 600.0;      ///< time constant of the mean reading, which follows a drifting bias
  };
  struct Params {
    double rate_max_rad_s = 0.05;     ///< maximum difference between mean rate and bias, per axis
    double rate_spread_rad_s = 0.03;  ///< maximum distance of a reading from the mean reading, per axis
    double force_spread_m_s2 = 0.15;  ///< maximum distance of a reading from the mean reading, per axis
    double rest_s = 0.4;
    CallerSettings caller_settings = {};

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.rate_max_rad_s,
            {"rate_max_rad_s", "rad/s", 1e-6, 10.0, "maximum mean rate at rest; must exceed the gyro bias"});
      visit(p.rate_spread_rad_s,
            {"rate_spread_rad_s", "rad/s", 1e-6, 10.0,
             "maximum difference between a rate reading and the mean rate during the rest, per axis"});
      visit(p.force_spread_m_s2,
            {"force_spread_m_s2", "m/s^2", 1e-6, 100.0,
             "maximum difference between a force reading and the mean force during the rest, per axis"});
      visit(p.rest_s, {"rest_s", "s", 0.0, 1e4, "minimum duration of a rest"});
    }
  };
  struct State {
    // sums of the latest consecutive readings that stay close to their mean
    Eigen::Vector3d rate_sum_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_sum_m_s2 = Eigen::Vector3d::Zero();
    double weight = 0.0;
    TimeNs first_ns = 0;
    TimeNs last_averaged_reading_ns = 0;
    TimeNs small_rate_since_ns = 0;  ///< time since which the mean rate is a plausible bias
    bool is_stationary = false;
    // sums of the samples since the last averaged reading
    Eigen::Vector3d pending_rate_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d pending_force_m_s2 = Eigen::Vector3d::Zero();
    std::size_t pending_samples = 0;
    TimeNs pending_first_ns = 0, last_reading_ns = 0, last_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;

    Eigen::Vector3d mean_rate_rad_s() const;
    Eigen::Vector3d mean_force_m_s2() const;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RestDetector(const Params& params);

  /// Processes a finite sample, and returns true if the IMU is at rest. `bias_rad_s` is the known gyro bias [rad/s].
  /// Cost: O(1), no allocation.
  bool detect_stationary(const ImuSample& sample, State& state,
                         const Eigen::Vector3d& bias_rad_s = Eigen::Vector3d::Zero()) const;

  /// Processes the mean rate and specific force over a time span as one reading, independent of `reading_s`.
  bool detect_stationary_from_mean(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2, TimeNs from_ns,
                                   TimeNs to_ns, const Eigen::Vector3d& bias_rad_s, State& state) const;

  /// Returns for each sample of a recording whether the IMU is at rest. Cost: O(N).
  std::vector<bool> find(std::span<const ImuSample> samples,
                         const Eigen::Vector3d& bias_rad_s = Eigen::Vector3d::Zero()) const;

 private:
  Params params_;
};

/// Estimates a large zero offset of a gyro from the rest at the start of a run. The zero offset of a consumer gyro may
/// exceed 0.05 rad/s, the default limit of RestDetector for the mean rate at rest. GyroOffset mistakes a steady
/// rotation about the vertical for an offset.
class GyroOffset {
 public:
  static constexpr double kOffsetMin_rad_s = 0.05, kOffsetMax_rad_s = 0.15;
  static constexpr double kInitialRestLatestEnd_s = 2.0;  ///< latest end of the initial rest, after the first sample

  struct State {
    RestDetector::State stationary_state;
    std::optional<TimeNs> first_ns;
    bool offset_decided = false;
  };

  GyroOffset();

  /// Returns the gyro's zero offset for the sample at which the initial rest is detected, if the offset is large, and
  /// nothing otherwise. The sample must be finite. Cost: O(1), no allocation.
  std::optional<Eigen::Vector3d> detect_initial_offset(const ImuSample& sample, State& state) const;
  /// Returns the gyro's zero offset in a recording, or zero if the offset is small.
  Eigen::Vector3d find(std::span<const ImuSample> samples) const;

 private:
  RestDetector rest_detector_;
};

}  // namespace tumble
