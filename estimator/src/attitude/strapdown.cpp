// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/strapdown.hpp"

#include <cmath>

#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {
constexpr double kForceMin_m_s2 = 1e-6;
}  // namespace

Strapdown::Strapdown(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status Strapdown::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  Eigen::Quaterniond q_WI;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
        !bad.ok())
      return bad;
    q_WI = (state.q_WI * so3::exp(sample.angular_velocity_rad_s * dt_s)).normalized();
  } else if (const Status bad = inclination_from_force(sample.specific_force_m_s2, q_WI); !bad.ok()) {
    return bad;
  }
  state = {q_WI, sample.time_ns, true};
  return {};
}

/// See attitude.md (A1).
Status inclination_from_force(const Eigen::Vector3d& specific_force_m_s2, Eigen::Quaterniond& q_WI) {
  const Eigen::Vector3d& f = specific_force_m_s2;
  if (!f.allFinite()) return {ErrorCode::non_finite, "specific_force_m_s2", f.sum(), kForceMin_m_s2};
  const double length = f.stableNorm();
  if (length < kForceMin_m_s2) return {ErrorCode::degenerate, "specific_force_m_s2", length, kForceMin_m_s2};
  const double across_x = std::hypot(f.y(), f.z());
  const double roll = across_x > 0.0 ? std::atan2(f.y(), f.z()) : 0.0;
  const double pitch = std::atan2(-f.x(), across_x);
  q_WI = so3::exp({0.0, pitch, 0.0}) * so3::exp({roll, 0.0, 0.0});
  return {};
}

}  // namespace tumble
