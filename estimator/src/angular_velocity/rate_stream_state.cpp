// SPDX-License-Identifier: BSD-3-Clause
// rate_stream_state.cpp checks and compares states of a RateStream.
#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

SensorHealth RateStream::health(const State& state) const {
  SensorHealth out;
  frozen_.add_findings(HealthFinding::Kind::frozen_axis, "imu", state.frozen, out);
  out.add(HealthFinding::Kind::flight_forces, flight_sign_check_.current_verdict(state.sense), "imu");
  return out;
}

Status RateStream::check_state(const State& state) const {
  const std::size_t most = capacity_ + samples_per_step_;
  if (state.window.size() > most)
    return {ErrorCode::out_of_range, "rate.window", double(state.window.size()), double(most)};
  if (state.samples_since_step > samples_per_step_)
    return {ErrorCode::out_of_range, "rate.waiting", double(state.samples_since_step), double(samples_per_step_)};
  if (!rails_.has_room_for(state.rails)) return {ErrorCode::out_of_range, "rails.readings", 1.0, 0.0};
  const double most_s = std::abs(prior_delay_s_) + 2.0 * delay_reach_s(),
               delay_s = state.device.front().delay.applied_delay_s;
  if (std::abs(delay_s) > most_s) return {ErrorCode::out_of_range, "delay.in_use_s", delay_s, most_s};
  for (std::size_t k = 1; k < state.window.size(); ++k) {
    const TimeNs before_ns = state.window[k - 1].observation.sample.time_ns;
    const Status status = check_stamp_order(state.window[k].observation.sample.time_ns, before_ns, params_.gap_max_s);
    if (!status.ok()) return status;
  }
  return {};
}

bool RateStream::equal(const State& a, const State& b) {
  const auto alike = [](const RateStreamDevice& x, const RateStreamDevice& y) {
    return x.prior == y.prior && x.corner == y.corner &&
           x.evidence.linearisation_point == y.evidence.linearisation_point &&
           x.evidence.information == y.evidence.information && x.evidence.gradient == y.evidence.gradient &&
           x.posterior.covariance == y.posterior.covariance &&
           x.posterior.uncalibrated_probability == y.posterior.uncalibrated_probability &&
           x.updated_ns == y.updated_ns && x.delay == y.delay;
  };
  const auto same = [](const Knot& x, const Knot& y) {
    const ImuSample &p = x.observation.sample, &q = y.observation.sample;
    const RateEstimate &e = x.estimate, &f = y.estimate;
    return p.time_ns == q.time_ns && p.angular_velocity_rad_s == q.angular_velocity_rad_s &&
           p.specific_force_m_s2 == q.specific_force_m_s2 && p.device_clip_flags == q.device_clip_flags &&
           x.observation.clipping == y.observation.clipping && x.by_axis_aligned_rails == y.by_axis_aligned_rails &&
           x.observation.at_rest == y.observation.at_rest &&
           x.observation.subsample_saturated == y.observation.subsample_saturated &&
           x.observation.isolated_high_axes == y.observation.isolated_high_axes &&
           x.observation.suspect == y.observation.suspect && x.read == y.read &&
           x.observation.accel_age_s == y.observation.accel_age_s && x.repeats == y.repeats &&
           x.repeated == y.repeated && x.near == y.near &&
           x.observation.expected_deficit_rad_s == y.observation.expected_deficit_rad_s &&
           x.observation.expected_deficit_sigma_rad_s == y.observation.expected_deficit_sigma_rad_s &&
           e.knot == f.knot && e.flight_weight == f.flight_weight && e.contact_force_m_s2 == f.contact_force_m_s2 &&
           e.bound_precision == f.bound_precision && e.bound_shift == f.bound_shift && e.soft_bounds == f.soft_bounds &&
           x.covariance_rad2_s2 == y.covariance_rad2_s2 && x.age == y.age &&
           x.reading_growth_rad_s == y.reading_growth_rad_s &&
           std::equal(x.observation.auxiliary_imus.begin(), x.observation.auxiliary_imus.end(),
                      y.observation.auxiliary_imus.begin(),
                      [](const AuxiliaryReading& r, const AuxiliaryReading& s) { return r.same(s); });
  };
  return StreamingClippingFinder::equal(a.rails, b.rails) && a.rests == b.rests && a.repeat_state == b.repeat_state &&
         a.frozen == b.frozen && a.sense == b.sense &&
         std::equal(a.window.begin(), a.window.end(), b.window.begin(), b.window.end(), same) && a.rig == b.rig &&
         a.rig_covariance == b.rig_covariance && a.prior.diagonal == b.prior.diagonal &&
         a.prior.border == b.prior.border && a.prior.gradient == b.prior.gradient &&
         a.prior_corner.matrix == b.prior_corner.matrix && a.prior_corner.gradient == b.prior_corner.gradient &&
         alike(a.device.front(), b.device.front()) && a.extremes == b.extremes && a.min_levels == b.min_levels &&
         a.slope_before_clipping_rad_s == b.slope_before_clipping_rad_s && a.entry_samples == b.entry_samples &&
         a.last_marginalised == b.last_marginalised && a.last_marginalised_ns == b.last_marginalised_ns &&
         a.prior_knot == b.prior_knot && a.prior_rig == b.prior_rig && a.samples == b.samples &&
         a.rig_resets == b.rig_resets && a.flight_run == b.flight_run && a.samples_since_step == b.samples_since_step &&
         a.calibration_samples == b.calibration_samples && a.failures == b.failures;
}

}  // namespace tumble
