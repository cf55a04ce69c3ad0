// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/complementary.hpp"

#include <cmath>

#include "scenarios/baselines/attitude/force_min.hpp"
#include "scenarios/baselines/attitude/tilt_correction.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

Complementary::Complementary(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status Complementary::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  Eigen::Quaterniond q_WI;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
        !bad.ok())
      return bad;
    q_WI = state.q_WI * so3::exp(sample.angular_velocity_rad_s * dt_s);
    if (const double force = sample.specific_force_m_s2.norm(); force >= kForceMin_m_s2) {
      const double share = -std::expm1(-dt_s / params_.tau_s);
      q_WI = tilt_correction(q_WI * (sample.specific_force_m_s2 / force), share) * q_WI;
    }
    q_WI.normalize();
  } else if (const Status bad = inclination_from_force(sample.specific_force_m_s2, q_WI); !bad.ok()) {
    return bad;
  }
  state = {q_WI, sample.time_ns, true};
  return {};
}

}  // namespace tumble::baselines
