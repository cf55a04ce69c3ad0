// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// DoubleIntegration computes the position of an IMU from the specific force and a given attitude: it subtracts gravity
/// and integrates twice. The integration is second order in the sample period, and exact if the force in world axes is
/// constant during each sample. The drift is unbounded: a tilt error of 0.1 deg causes an acceleration error of 1.7
/// cm/s^2, and thus a position error of 1 m after 11 s.
class DoubleIntegration {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    double gap_max_s = 1.0;

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-9, 100.0, "strength of gravity"});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };
  struct State {
    Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d v_WI_m_s = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();  ///< attitude at the last sample
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit DoubleIntegration(const Params& params);

  /// Updates velocity and position with one IMU sample. The parameter `q_WI` is the attitude at the end of the sample's
  /// averaging window. The integration starts at rest at the origin with the first sample. On error, `state` keeps its
  /// content. The cost is O(1), without allocation.
  Status step(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const;

 private:
  Params params_;
};

}  // namespace tumble::baselines
