// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/autogain.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/baselines/attitude/force_min.hpp"
#include "scenarios/baselines/attitude/madgwick_step.hpp"
#include "scenarios/baselines/attitude/tilt_correction.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

namespace {

constexpr double kCodeFullRate_rad_s = 2.0;
constexpr double kCodeDeadZone = 0.1;
/// At gimbal lock (|sin(pitch)| above kGimbalLock), roll and yaw cannot be separated, so the filter skips the
/// complementary step.
constexpr double kGimbalLock = 0.999;

double current_roll(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()), 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()));
}

double current_yaw(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

/// Rotates the attitude towards the roll and pitch that the accelerometer measures, without changing the yaw: equation
/// (A25) of attitude.md.
Eigen::Quaterniond towards_roll_and_pitch(const Eigen::Quaterniond& q, const Eigen::Vector3d& f, double share,
                                          bool keep_roll) {
  const double sin_pitch = 2.0 * (q.w() * q.y() - q.x() * q.z());
  if (!keep_roll && std::abs(sin_pitch) > kGimbalLock) return q;
  const double roll = keep_roll ? current_roll(q) : std::atan2(f.y(), f.z());
  const double pitch = std::atan2(-f.x(), std::hypot(f.y(), f.z()));
  const Eigen::Quaterniond target =
      so3::exp({0.0, 0.0, current_yaw(q)}) * so3::exp({0.0, pitch, 0.0}) * so3::exp({roll, 0.0, 0.0});
  return q * so3::exp(share * so3::logarithm(q.conjugate() * target));
}

}  // namespace

Autogain::Autogain(const Params& p) : params_(p) {
  require_valid_fields(p);
  require_in_interval("upper_rad_s", p.upper_rad_s, p.lower_rad_s + 1e-9, 100.0);
}

AutogainGains Autogain::gains(const Eigen::Vector3d& w_I_rad_s, double dt_s) const {
  const double width = params_.upper_rad_s - params_.lower_rad_s;
  const auto risen = [&](double rate) { return std::clamp((rate - params_.lower_rad_s) / width, 0.0, 1.0); };
  AutogainGains out;
  switch (params_.profile) {
    case AutogainProfile::paper:
      for (int axis = 0; axis < 3; ++axis) out.factor[axis] = std::pow(risen(std::abs(w_I_rad_s[axis])), 2);
      out.beta = out.factor.maxCoeff();
      break;
    case AutogainProfile::code2021:
      out.factor = (w_I_rad_s / kCodeFullRate_rad_s).cwiseAbs2().cwiseMin(1.0);
      out.beta = out.factor.maxCoeff() < kCodeDeadZone ? 0.0 : out.factor.maxCoeff();
      break;
    case AutogainProfile::smooth: {
      const double x = risen(w_I_rad_s.norm());
      out.factor.setConstant(x * x * (3.0 - 2.0 * x));
      out.beta = out.factor.x();
      break;
    }
  }
  out.madgwick_rad_s = params_.gain_rad_s * out.beta;
  out.slerp_share = -std::expm1(-dt_s / params_.tau_s) * (1.0 - out.beta);
  return out;
}

Status Autogain::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  Eigen::Quaterniond q;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
        !bad.ok())
      return bad;
    const Eigen::Vector3d& f = sample.specific_force_m_s2;
    const AutogainGains gain = gains(sample.angular_velocity_rad_s, dt_s);
    q = madgwick_step(state.q_WI, sample.angular_velocity_rad_s, f, gain.madgwick_rad_s, dt_s);
    if (f.norm() >= kForceMin_m_s2) {
      const bool tilt_form = params_.tilt_form || params_.profile == AutogainProfile::smooth;
      q = tilt_form ? tilt_correction(q * f.normalized(), gain.slerp_share) * q
                    : towards_roll_and_pitch(q, f, gain.slerp_share, params_.roll_error_2021);
    }
    q.normalize();
  } else if (const Status bad = inclination_from_force(sample.specific_force_m_s2, q); !bad.ok()) {
    return bad;
  }
  state = {q, sample.time_ns, true};
  return {};
}

}  // namespace tumble::baselines
