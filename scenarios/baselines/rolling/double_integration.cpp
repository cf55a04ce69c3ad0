// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/double_integration.hpp"

#include "scenarios/baselines/rolling/attitude_check.hpp"
#include "tumble/attitude/detail/timing.hpp"

namespace tumble::baselines {

DoubleIntegration::DoubleIntegration(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status DoubleIntegration::step(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (const Status bad = check_attitude(q_WI); !bad.ok()) return bad;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok()) return bad;
    const Eigen::Quaterniond q_mid = state.q_WI.slerp(0.5, q_WI);
    const Eigen::Vector3d a_W = q_mid * sample.specific_force_m_s2 - params_.gravity_m_s2 * Eigen::Vector3d::UnitZ();
    state.p_WI_m += dt_s * (state.v_WI_m_s + 0.5 * dt_s * a_W);
    state.v_WI_m_s += dt_s * a_W;
  }
  state.q_WI = q_WI;
  state.last_time_ns = sample.time_ns;
  state.started = true;
  return {};
}

}  // namespace tumble::baselines
