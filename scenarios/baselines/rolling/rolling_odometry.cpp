// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/rolling_odometry.hpp"

#include <cmath>

#include "scenarios/baselines/rolling/attitude_check.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble::baselines {

namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kRateLargest_rad_s = 1e6;

Status check_input(const Eigen::Vector3d& w_I_rad_s, const Eigen::Quaterniond& q_WI) {
  if (!w_I_rad_s.allFinite()) return {ErrorCode::non_finite, "w_I_rad_s", w_I_rad_s.sum(), kRateLargest_rad_s};
  const double rate = w_I_rad_s.stableNorm();
  if (rate > kRateLargest_rad_s) return {ErrorCode::out_of_range, "w_I_rad_s", rate, kRateLargest_rad_s};
  return check_attitude(q_WI);
}

}  // namespace

RollingOdometry::RollingOdometry(const Params& params) : params_(params) {
  require_valid_fields(params);
  require_in_interval("normal_W length", params.normal_W.norm(), 1.0 - kUnitTolerance, 1.0 + kUnitTolerance);
}

Status RollingOdometry::step(TimeNs time_ns, const Eigen::Vector3d& w_I_rad_s, const Eigen::Quaterniond& q_WI,
                             State& state) const {
  if (const Status bad = check_input(w_I_rad_s, q_WI); !bad.ok()) return bad;
  double dt_s = 0.0;
  if (state.started) {
    if (const Status bad = elapsed_time_since_last(time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok())
      return bad;
  }
  const Eigen::Vector3d w_W_rad_s = q_WI * w_I_rad_s;
  const Eigen::Vector3d v_WG_m_s = params_.radius_m * w_W_rad_s.cross(params_.normal_W);
  state.p_WG_m += 0.5 * dt_s * (state.v_WG_m_s + v_WG_m_s);
  state.v_WG_m_s = v_WG_m_s;
  state.last_time_ns = time_ns;
  state.started = true;
  return {};
}

}  // namespace tumble::baselines
