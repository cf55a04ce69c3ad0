// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Finds standstill in the readings of an IMU, for rates, attitude, rolling and the mapper: rates that are a known bias
/// at most and a force that is large enough to be gravity, both constant up to noise for a while. There the gyro reads
/// its bias. Everything is meant by time and at one bandwidth: readings that come faster than `reading_s` are taken
/// together first, so that white noise of density n [unit/sqrt(Hz)] is n / sqrt(reading_s) in what the bounds are
/// compared with, whatever the rate of the samples. A spread should be five of these deviations or more. What it does
/// not tell apart from standstill: a steady turn about the vertical, slower than `rate_max_rad_s`.
///
/// What differs from use to use are the Params, stated where they are used: docs/design.md.
class RestDetector {
 public:
  struct Params {
    double rate_max_rad_s = 0.05;     ///< of the mean of the run about the bias, each axis
    double rate_spread_rad_s = 0.03;  ///< largest distance of a reading from the mean of the run, per axis
    double force_min_m_s2 = 5.0;      ///< flight is no rest
    double force_max_m_s2 = 1e3;      ///< nor is a push
    double force_spread_m_s2 = 0.15;  ///< as that of the rate
    double rest_s = 0.4;              ///< the shortest run that is rest
    double reading_s = 0.01;          ///< length of what counts as a reading; 0: each sample
    double memory_s = 600.0;          ///< in which the mean of a run forgets: a bias that drifts is no motion

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.rate_max_rad_s,
            {"rate_max_rad_s", "rad/s", 1e-6, 10.0, "largest mean rate at rest, as caused by a gyro bias"});
      visit(p.rate_spread_rad_s, {"rate_spread_rad_s", "rad/s", 1e-6, 10.0,
                                  "largest distance of a reading from the mean rate of the rest, per axis"});
      visit(p.force_min_m_s2, {"force_min_m_s2", "m/s^2", 0.0, 100.0, "least force at rest; excludes free flight"});
      visit(p.force_max_m_s2,
            {"force_max_m_s2", "m/s^2", 0.0, 1e6, "largest force at rest; excludes forces beyond gravity"});
      visit(p.force_spread_m_s2, {"force_spread_m_s2", "m/s^2", 1e-6, 100.0,
                                  "largest distance of a force from the mean force of the rest, per axis"});
      visit(p.rest_s, {"rest_s", "s", 0.0, 1e4, "shortest duration of a rest"});
      visit(p.reading_s,
            {"reading_s", "s", 0.0, 1.0, "duration over which readings are averaged; 0: each sample is one reading"});
      visit(p.memory_s, {"memory_s", "s", 1e-3, 1e6, "time constant of the mean over a rest"});
    }
  };
  struct State {
    // the run: readings that stay about their mean, which are rest once they have lasted
    Eigen::Vector3d rate_sum_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_sum_m_s2 = Eigen::Vector3d::Zero();
    double weight = 0.0;      ///< of the sums: readings, but for those that are forgotten
    TimeNs first_ns = 0;      ///< of its first sample
    TimeNs last_mean_ns = 0;  ///< of its last reading
    TimeNs quiet_ns = 0;      ///< for so long the run has lasted, with a mean that is a bias at most
    bool rests = false;       ///< the run, up to the last reading
    // samples since the last reading
    Eigen::Vector3d rate_open_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_open_m_s2 = Eigen::Vector3d::Zero();
    std::size_t open = 0;
    TimeNs open_first_ns = 0, last_reading_ns = 0, last_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;

    /// Of the run; zero before one.
    Eigen::Vector3d mean_rate_rad_s() const;
    Eigen::Vector3d mean_force_m_s2() const;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RestDetector(const Params& params);

  /// Takes the next finite sample; true when it ends a run that is rest, as far as whole readings tell. `bias_rad_s` is
  /// what is known of the gyro's. O(1), no allocation.
  bool observe(const ImuSample& sample, State& state,
               const Eigen::Vector3d& bias_rad_s = Eigen::Vector3d::Zero()) const;

  /// The same of a mean over a span, which is a reading by itself, whatever `reading_s`.
  bool observe_mean(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2, TimeNs from_ns, TimeNs to_ns,
                    const Eigen::Vector3d& bias_rad_s, State& state) const;

  /// For each sample of a recording whether it belongs to a rest, also those with which one begins. O(N).
  std::vector<bool> find(std::span<const ImuSample> samples) const;

 private:
  Params params_;
};

}  // namespace tumble
