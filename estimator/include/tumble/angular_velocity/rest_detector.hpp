// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Finds standstill in the readings of an IMU: rates that are small and force that is large enough to be gravity, both
/// constant up to noise for a while. There the gyro reads its bias. Readings that come faster than `reading_s` are
/// taken together first: noise grows with the rate of the samples, bounds do not. What it does not tell apart from
/// standstill: a steady turn about the vertical, slower than `rate_max_rad_s`.
class RestDetector {
 public:
  struct Params {
    double rate_max_rad_s = 0.05;     ///< a bias at most
    double rate_spread_rad_s = 0.03;  ///< largest distance of a reading from the mean of the run, per axis
    double force_min_m_s2 = 5.0;      ///< flight is no rest
    double force_spread_m_s2 = 0.15;  ///< likewise for the force
    double rest_s = 0.4;              ///< the shortest run that is rest
    double reading_s = 0.01;          ///< length of what counts as a reading; 0: each sample

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1e-6, 10.0, "a bias at most: faster is no rest"});
      visit(p.rate_spread_rad_s, {"rate_spread_rad_s", "rad/s", 1e-6, 10.0,
                                  "largest distance of a reading from the mean of the run, per axis"});
      visit(p.force_min_m_s2, {"force_min_m_s2", "m/s^2", 0.0, 100.0, "flight is no rest"});
      visit(p.force_spread_m_s2, {"force_spread_m_s2", "m/s^2", 1e-6, 100.0,
                                  "largest distance of a force from the mean of the run, per axis"});
      visit(p.rest_s, {"rest_s", "s", 0.0, 60.0, "the shortest run that is rest"});
      visit(p.reading_s, {"reading_s", "s", 0.0, 1.0, "length of what counts as a reading; 0: each sample"});
    }
  };
  struct State {
    Eigen::Vector3d rate_sum_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_sum_m_s2 = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    TimeNs first_ns = 0;
    bool rests = false;  ///< the run, up to the last reading
    // samples since the last reading
    Eigen::Vector3d rate_open_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_open_m_s2 = Eigen::Vector3d::Zero();
    std::size_t open = 0;
    TimeNs open_first_ns = 0, last_reading_ns = 0, last_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RestDetector(const Params& params);

  /// Takes the next finite sample; true when it ends a run that is rest, as far as whole readings tell. O(1).
  bool observe(const ImuSample& sample, State& state) const;

  /// For each sample of a recording whether it belongs to a rest, also those with which one begins. O(N).
  std::vector<bool> find(std::span<const ImuSample> samples) const;

 private:
  void read(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2, TimeNs time_ns, State& state) const;

  Params params_;
};

}  // namespace tumble
