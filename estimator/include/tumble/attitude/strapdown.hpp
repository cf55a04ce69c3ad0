// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Integrates the gyro to an attitude, q <- q Exp(w dt), from a start levelled by the accelerometer. The integration is
/// exact if the rate is constant in body axes during each sample. Strapdown estimates no bias and makes no correction,
/// so the attitude drifts.
class Strapdown {
 public:
  struct Params {
    double gap_max_s = 1.0;  ///< a longer time between samples is a `gap`

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State& other) const {
      return q_WI.coeffs() == other.q_WI.coeffs() && last_time_ns == other.last_time_ns && started == other.started;
    }
  };

  explicit Strapdown(const Params& params);

  /// Processes one sample and updates the attitude. Cost: O(1), no allocation. The first sample levels the attitude
  /// (yaw 0) by its specific force. On error the state is unchanged.
  Status step(const ImuSample& sample, State& state) const;

 private:
  Params params_;
};

/// Computes the attitude with yaw 0 whose z axis (up) agrees with a specific force measured at rest, in sensor axes.
/// Returns `degenerate` if the force is below 1e-6 m/s^2.
Status level(const Eigen::Vector3d& specific_force_m_s2, Eigen::Quaterniond& q_WI);

}  // namespace tumble
