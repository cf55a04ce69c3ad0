// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Integrates the gyro to an attitude, starting with the tilt that the accelerometer measures. Strapdown assumes a
/// constant rate in body axes between two samples. The attitude drifts, because Strapdown does not estimate the gyro
/// bias. After the first sample, Strapdown does not use the accelerometer.
class Strapdown {
 public:
  struct Params {
    double gap_max_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit Strapdown(const Params& params);

  /// The specific force of the first sample determines the initial tilt; the initial yaw is 0. On error, the state is
  /// unchanged. Cost: O(1), no allocation.
  Status step(const ImuSample& sample, State& state) const;

 private:
  Params params_;
};

/// Computes the attitude with yaw 0 from the specific force at rest, given in sensor axes [m/s^2]. Returns `degenerate`
/// if the magnitude of the specific force is below 1e-6 m/s^2.
Status inclination_from_force(const Eigen::Vector3d& specific_force_m_s2, Eigen::Quaterniond& q_WI);

}  // namespace tumble
