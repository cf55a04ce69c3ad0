// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/mahony.hpp"

#include "scenarios/baselines/attitude/force_min.hpp"
#include "tumble/attitude/detail/timing.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::baselines {

Mahony::Mahony(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status Mahony::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (!state.started) {
    if (const Status bad = level(sample.specific_force_m_s2, state.q_WI); !bad.ok()) return bad;
    state.last_time_ns = sample.time_ns;
    state.started = true;
    return {};
  }
  double dt_s = 0.0;
  if (const Status bad = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok()) return bad;
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  if (const double force = sample.specific_force_m_s2.norm(); force >= kForceMin_m_s2) {
    error = (sample.specific_force_m_s2 / force).cross(state.q_WI.conjugate() * Eigen::Vector3d::UnitZ());
  }
  state.integral_rad_s += params_.integral_rad_s2 * dt_s * error;
  const Eigen::Vector3d rate =
      sample.angular_velocity_rad_s + params_.proportional_rad_s * error + state.integral_rad_s;
  state.q_WI = (state.q_WI * so3::exp(rate * dt_s)).normalized();
  state.last_time_ns = sample.time_ns;
  return {};
}

}  // namespace tumble::baselines
