// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/madgwick.hpp"

#include <cmath>

#include "scenarios/baselines/attitude/force_min.hpp"
#include "scenarios/baselines/attitude/madgwick_step.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble::baselines {

namespace {

constexpr double kGradientMin = 1e-12;

/// Returns the gradient of the tilt error as a quaternion (x, y, z, w). The tilt error is half the squared distance
/// between predicted and measured vertical (docs/maths/attitude.md, equation (A24)).
Eigen::Vector4d tilt_gradient(const Eigen::Quaterniond& q, const Eigen::Vector3d& up_I) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double f1 = 2.0 * (x * z - w * y) - up_I.x();
  const double f2 = 2.0 * (w * x + y * z) - up_I.y();
  const double f3 = 1.0 - 2.0 * (x * x + y * y) - up_I.z();
  return {2.0 * z * f1 + 2.0 * w * f2 - 4.0 * x * f3, -2.0 * w * f1 + 2.0 * z * f2 - 4.0 * y * f3,
          2.0 * x * f1 + 2.0 * y * f2, -2.0 * y * f1 + 2.0 * x * f2};
}

Eigen::Vector4d correction(const Eigen::Quaterniond& q, const Eigen::Vector3d& f_I) {
  const double force = f_I.norm();
  if (force < kForceMin_m_s2) return Eigen::Vector4d::Zero();
  const Eigen::Vector4d s = tilt_gradient(q, f_I / force);
  const double length = s.norm();
  if (length < kGradientMin) return Eigen::Vector4d::Zero();
  return s / length;
}

}  // namespace

Eigen::Quaterniond madgwick_step(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_I_rad_s,
                                 const Eigen::Vector3d& f_I_m_s2, double gain_rad_s, double dt_s) {
  const Eigen::Quaterniond rate(0.0, w_I_rad_s.x(), w_I_rad_s.y(), w_I_rad_s.z());
  const Eigen::Vector4d spin = 0.5 * (q_WI * rate).coeffs();
  const Eigen::Vector4d pull = gain_rad_s * correction(q_WI, f_I_m_s2);
  Eigen::Quaterniond next;
  next.coeffs() = (q_WI.coeffs() + dt_s * (spin - pull)).normalized();
  return next;
}

Madgwick::Madgwick(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status Madgwick::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  Eigen::Quaterniond q_WI;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
        !bad.ok())
      return bad;
    q_WI =
        madgwick_step(state.q_WI, sample.angular_velocity_rad_s, sample.specific_force_m_s2, params_.gain_rad_s, dt_s);
  } else if (const Status bad = inclination_from_force(sample.specific_force_m_s2, q_WI); !bad.ok()) {
    return bad;
  }
  state = {q_WI, sample.time_ns, true};
  return {};
}

}  // namespace tumble::baselines
