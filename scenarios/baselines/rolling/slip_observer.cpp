// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/slip_observer.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/baselines/rolling/attitude_check.hpp"
#include "tumble/attitude/detail/timing.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::baselines {

namespace {

/// Returns the mean measured acceleration over the window minus the derivative of the rolling velocity, which is fitted
/// by least squares.
Eigen::Vector2d residual(const SlipObserver::State& state) {
  constexpr int kSize = SlipObserver::kWindow;
  double t = 0.0, t_mean = 0.0;
  std::array<double, kSize> times{};
  Eigen::Vector2d a_mean = Eigen::Vector2d::Zero(), roll_mean = Eigen::Vector2d::Zero();
  for (int k = 0; k < kSize; ++k) {  // oldest first
    const auto slot = static_cast<std::size_t>((state.count + k) % kSize);
    t += state.dt_s[slot];
    times[static_cast<std::size_t>(k)] = t;
    t_mean += t / kSize;
    a_mean += state.a_W_m_s2[slot] / kSize;
    roll_mean += state.roll_W_m_s[slot] / kSize;
  }
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double spread = 0.0;
  for (int k = 0; k < kSize; ++k) {
    const auto slot = static_cast<std::size_t>((state.count + k) % kSize);
    const double offset = times[static_cast<std::size_t>(k)] - t_mean;
    moment += offset * (state.roll_W_m_s[slot] - roll_mean);
    spread += offset * offset;
  }
  return a_mean - moment / spread;
}

}  // namespace

SlipObserver::State::State() {
  a_W_m_s2.fill(Eigen::Vector2d::Zero());
  roll_W_m_s.fill(Eigen::Vector2d::Zero());
  e_W_m_s2.fill(Eigen::Vector2d::Zero());
}

SlipObserver::SlipObserver(const Params& p) : params_(p) {
  require_valid_fields(p);
  require_within("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
}

Status SlipObserver::step(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (const Status bad = check_attitude(q_WI); !bad.ok()) return bad;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok()) return bad;
    observe(sample, q_WI, dt_s, state);
    const Eigen::Vector3d w_W = q_WI * sample.angular_velocity_rad_s;
    state.v_WG_m_s = params_.radius_m * Eigen::Vector2d(w_W.y(), -w_W.x()) + state.contact_velocity_W_m_s;
    const Eigen::Vector2d blended = state.pending_m * -std::expm1(-dt_s / params_.blend_tau_s);
    state.pending_m -= blended;
    state.p_WG_m += dt_s * state.v_WG_m_s + blended;
  }
  state.last_rate_rad_s = sample.angular_velocity_rad_s;
  state.last_time_ns = sample.time_ns;
  state.started = true;
  return {};
}

void SlipObserver::observe(const ImuSample& sample, const Eigen::Quaterniond& q_WI, double dt_s, State& state) const {
  const Eigen::Vector3d& w = sample.angular_velocity_rad_s;
  const Eigen::Vector3d turning = (w - state.last_rate_rad_s) / dt_s;
  // The rotation accelerates the IMU relative to the sphere's centre by equation (I1) of imu_merge.md.
  const Eigen::Vector3d lever = turning.cross(params_.lever_arm_m) + w.cross(w.cross(params_.lever_arm_m));
  // The specific force is a mean over the averaging window, so it is rotated by the attitude in the middle of the
  // window.
  const Eigen::Quaterniond q_mid = q_WI * so3::exp(-0.5 * dt_s * w);
  const Eigen::Vector3d a_W = q_mid * (sample.specific_force_m_s2 - lever);
  const Eigen::Vector3d w_W = q_WI * w;
  const auto slot = static_cast<std::size_t>(state.count % kWindow);
  state.a_W_m_s2[slot] = a_W.head<2>();
  state.roll_W_m_s[slot] = params_.radius_m * Eigen::Vector2d(w_W.y(), -w_W.x());
  state.dt_s[slot] = dt_s;
  if (++state.count < kWindow) return;

  const Eigen::Vector2d e = residual(state) - state.bias_m_s2;
  const auto place = static_cast<std::size_t>(state.residuals++ % kHistory);
  state.e_W_m_s2[place] = e;
  state.e_dt_s[place] = dt_s;
  state.quiet_s = e.norm() < params_.quiet_m_s2 ? state.quiet_s + dt_s : 0.0;
  if (state.open) {
    advance_open(e, dt_s, state);
  } else {
    advance_closed(e, dt_s, state);
  }
}

void SlipObserver::advance_closed(const Eigen::Vector2d& e, double dt_s, State& state) const {
  state.contact_velocity_W_m_s *= std::exp(-params_.closed_decay_per_s * dt_s);
  if (state.quiet_s > 0.0) state.bias_m_s2 += -std::expm1(-dt_s / params_.bias_tau_s) * e;
  if (state.ignoring && state.quiet_s >= params_.ignore_time_s) state.ignoring = false;
  if (!state.ignoring && e.norm() > params_.open_m_s2) open_event(e, state);
}

/// Starts a slip event. The residuals before the event determine the initial slip velocity and displacement.
void SlipObserver::open_event(const Eigen::Vector2d& e, State& state) const {
  state.open = true;
  state.event_s = 0.0;
  Eigen::Vector2d u = Eigen::Vector2d::Zero(), path = Eigen::Vector2d::Zero();
  const std::int64_t known = std::min<std::int64_t>(state.residuals, kHistory);
  for (std::int64_t back = 1; back <= known; ++back) {  // newest first
    const auto place = static_cast<std::size_t>((state.residuals - back) % kHistory);
    if (state.e_W_m_s2[place].dot(e) <= 0.0) break;
    const double dt_s = state.e_dt_s[place];
    u += dt_s * state.e_W_m_s2[place];
    path += dt_s * state.event_s * state.e_W_m_s2[place];  // displacement due to the residual `event_s` seconds ago
    state.event_s += dt_s;
  }
  state.contact_velocity_W_m_s = u;
  state.event_m = path;
  state.pending_m += path;
}

void SlipObserver::advance_open(const Eigen::Vector2d& e, double dt_s, State& state) const {
  state.contact_velocity_W_m_s += dt_s * e;
  state.event_m += dt_s * state.contact_velocity_W_m_s;
  state.event_s += dt_s;
  if (state.event_s > params_.timeout_s) {
    state.pending_m -= state.event_m;
    state.open = false;
    state.ignoring = true;
  } else if (state.quiet_s >= params_.quiet_time_s && state.contact_velocity_W_m_s.norm() < params_.closing_speed_m_s) {
    state.pending_m -= 0.5 * state.event_s * state.contact_velocity_W_m_s;
    state.open = false;
  }
  if (!state.open) {
    state.contact_velocity_W_m_s.setZero();
    state.event_m.setZero();
    state.event_s = 0.0;
  }
}

}  // namespace tumble::baselines
