// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "scenarios/baselines/attitude/autogain.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

/// AutogainFusion estimates the position of a rolling sphere on a flat floor (Zevering et al., IEEE MFI 2021, eqs
/// 6-13). AutogainFusion combines the rolling velocity with the integrated acceleration. The limit on the integrated
/// acceleration can make the estimated path of a sphere without slip too short, by up to one half.
class AutogainFusion {
 public:
  struct Params {
    double radius_m = 0.145;
    double gravity_m_s2 = 9.80665;
    double limiter = 1.2;              ///< maximum of |v_acc| / |v_rot|; 1.1 in the authors' code
    double rotation_weight = 0.5;      ///< eq 13
    double acceleration_weight = 0.5;  ///< eq 13
    Autogain::Params autogain = {};

    // The MFI 2021 paper differs from the code of its authors in several details, and each following option selects one
    // detail. The defaults follow the paper.
    bool integrate_in_body = true;    ///< eq 7 in the rotating frame
    bool direction_only = false;      ///< as in the authors' code: ignores |f|
    bool recursive_coupling = false;  ///< as in the authors' code
    bool limit_per_axis = true;       ///< false: limits the horizontal vector
    bool shrink_per_axis = true;      ///< false: eq 12 shortens the horizontal vector
    bool vertical_by_norm = false;    ///< as in the authors' code: |v_z| <= |v_rot|

    double gap_max_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.radius_m, {"radius_m", "m", 1e-9, 10.0, "radius of the sphere"});
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-9, 100.0, "strength of gravity"});
      visit(p.limiter,
            {"limiter", "1", 0.0, 100.0,
             "maximum ratio of the integrated velocity to the rolling velocity; 1.1 in the code of the MFI 2021 paper",
             ParameterAudience::common_use});
      visit(p.rotation_weight, {"rotation_weight", "1", 0.0, 10.0, "weight of the rolling velocity (eq. 13)",
                                ParameterAudience::common_use});
      visit(p.acceleration_weight, {"acceleration_weight", "1", 0.0, 10.0,
                                    "weight of the integrated acceleration (eq. 13)", ParameterAudience::common_use});
      visit.group("autogain_", p.autogain);
      visit(p.integrate_in_body,
            boolean_parameter(
                "integrate_in_body",
                "true: integrate the acceleration (eq. 7) in the rotating body frame, without the term w x v; "
                "false: in the world frame",
                ParameterAudience::common_use));
      visit(p.direction_only,
            boolean_parameter(
                "direction_only",
                "true, as in the code of the MFI 2021 paper: subtract gravity of length 1 from the direction of the "
                "specific force, without multiplying by g",
                ParameterAudience::common_use));
      visit(p.recursive_coupling,
            boolean_parameter(
                "recursive_coupling",
                "true, as in the code of the MFI 2021 paper: eq. 8 scales the integrated velocity again at each sample",
                ParameterAudience::common_use));
      visit(p.limit_per_axis, boolean_parameter("limit_per_axis",
                                                "true: limit the integrated velocity along each horizontal axis of the "
                                                "world; false: limit its horizontal norm",
                                                ParameterAudience::common_use));
      visit(p.shrink_per_axis,
            boolean_parameter(
                "shrink_per_axis",
                "true: eq. 12 subtracts v_z^2 from the square of each horizontal velocity; false: once from "
                "the squared horizontal speed",
                ParameterAudience::common_use));
      visit(p.vertical_by_norm,
            boolean_parameter(
                "vertical_by_norm",
                "true, as in the code of the MFI 2021 paper: limit the vertical speed by the horizontal rolling speed; "
                "false: by the mean of the rolling speeds along x and y"));
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    }
  };
  struct State {
    Eigen::Vector3d p_WG_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d v_WG_m_s = Eigen::Vector3d::Zero();        ///< fused velocity at the last sample
    Eigen::Vector3d v_integral_m_s = Eigen::Vector3d::Zero();  ///< in IMU or world axes, see `integrate_in_body`
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit AutogainFusion(const Params& params);

  Status step(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const;

 private:
  Eigen::Vector3d accelerated(const ImuSample& sample, const Eigen::Quaterniond& q_WI, double dt_s, State& state) const;
  Eigen::Vector3d fuse(const Eigen::Vector3d& v_acc_W, const Eigen::Vector3d& v_rot_W) const;

  Params params_;
  Autogain autogain_;
};

}  // namespace tumble::baselines
