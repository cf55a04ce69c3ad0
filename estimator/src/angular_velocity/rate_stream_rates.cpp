// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "rate_stream_impl.hpp"
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"

namespace tumble {

bool AngularRateStream::Impl::in_long_flight(std::size_t at, const State& state) const {
  const std::vector<Knot>& window = state.window;
  const auto needed = params.expert.kFlightRunMin;
  const auto flies = [&](std::size_t k) { return window[k].estimate.flight_weight >= 0.5; };
  if (!flies(at)) return false;
  std::size_t first = at, last = at;
  while (first > 0 && last - first < needed && flies(first - 1)) --first;
  while (last + 1 < window.size() && last - first < needed && flies(last + 1)) ++last;
  return last - first + 1 + (first > 0 ? 0 : state.consecutive_flight_samples) >= needed;
}

// See rate_stream.md (R99).
double AngularRateStream::Impl::saturation_deficit_from_slopes_rad_s(std::size_t at, int axis,
                                                                     const State& state) const {
  const std::vector<Knot>& window = state.window;
  const auto hidden = [&](std::size_t k) {
    const AngularRateObservation& o = window[k].observation;
    return ((o.clipping.gyro | o.partly_saturated_axes()) >> axis & 1) != 0 && !in_long_flight(k, state);
  };
  std::size_t first = at, last = at;
  while (first > 0 && hidden(first - 1)) --first;
  while (last + 1 < window.size() && hidden(last + 1)) ++last;
  const bool from_flight = state.consecutive_flight_samples >= params.expert.kFlightRunMin;
  const double before = static_cast<double>(at - first) + 0.5 +
                        (first > 0 || from_flight ? 0.0 : state.samples_since_clipping_start[axis]);
  // If a run of clipped readings has not ended, the run is assumed to continue for at least as long as the run has
  // lasted.
  const double left = static_cast<double>(last - at) + 0.5,
               after = last + 1 < window.size() ? left : std::max(before, left);
  const double slope = plateau_slope(axis, first, last, state);
  return slope * before * after / (before + after);
}

// See rate_stream.md (R98), (R99).
Eigen::Matrix3d AngularRateStream::Impl::inflated_rate_covariance(std::size_t at, const State& state) const {
  const Knot& knot = state.window[at];
  Eigen::Matrix3d out = knot.covariance_rad2_s2;
  if (knot.estimate.flight_weight >= 0.5) return out;
  const double samples = static_cast<double>(state.calibration_samples) * model.independent_sample_fraction() /
                         params.expert.inflation.kSamples;
  const double share = params.model.calibration ? 0.0 : params.expert.inflation.contact / (1.0 + samples);
  for (int j = 0; j < 3; ++j) {
    if ((knot.observation.unmeasured_axes() & knot.observation.clipping.gyro & 1u << j) == 0) continue;
    const double read = std::abs(knot.observation.sample.angular_velocity_rad_s[j]);
    const double beyond = std::max(0.0, std::abs(knot.estimate.knot.rate_rad_s[j]) - read);
    const double least = std::max(
        share * beyond, params.expert.inflation.slopes * (saturation_deficit_from_slopes_rad_s(at, j, state) - beyond));
    out(j, j) = std::max(out(j, j), least * least);
  }
  return out;
}

// If the log repeats gyro readings, the rate of a sample also depends on the next reading that differs from the
// repeated reading.
bool AngularRateStream::Impl::is_possibly_saturated(std::size_t at, const State& state) const {
  const std::vector<Knot>& window = state.window;
  if (window[at].possibly_clipped_axes != 0) return true;
  if (!window[at].repeated.is_slower_than_samples()) return false;
  std::size_t next = at + 1;
  while (next < window.size() && window[next].repeats_reading) ++next;
  if (next == window.size()) return false;
  const AngularRateObservation& after = window[next].observation;
  return (window[next].possibly_clipped_axes | after.clipping.gyro | after.possibly_saturated_axes()) != 0;
}

// See rate_stream.md (R108). After the newest sample, the angular acceleration is assumed constant.
void AngularRateStream::Impl::extrapolate_estimate(std::size_t at, double late_s, const State& state,
                                                   AngularRateState& out) const {
  const auto reported = [&](std::size_t k) {
    const Knot& knot = state.window[k];
    return model.output_covariance(inflated_rate_covariance(k, state), knot.observation, knot.estimate);
  };
  for (; at + 1 < state.window.size(); ++at) {
    const Knot &from = state.window[at], &to = state.window[at + 1];
    const double dt_s = seconds(to.observation.sample.time_ns - from.observation.sample.time_ns);
    if (late_s >= dt_s) {
      late_s -= dt_s;
      continue;
    }
    const AngularRateKnot &a = from.estimate.knot, &b = to.estimate.knot;
    const double u = late_s / dt_s, v = 1.0 - u;
    out.w_WI_I_rad_s = v * v * (1.0 + 2.0 * u) * a.rate_rad_s + u * u * (3.0 - 2.0 * u) * b.rate_rad_s +
                       u * v * dt_s * (v * a.acceleration_rad_s2 - u * b.acceleration_rad_s2);
    out.covariance_rad2_s2 = v * reported(at) + u * reported(at + 1);
    return;
  }
  const AngularRateKnot& last = state.window[at].estimate.knot;
  const Eigen::Vector3d moved = late_s * last.acceleration_rad_s2;
  out.w_WI_I_rad_s = last.rate_rad_s + moved;
  out.covariance_rad2_s2 = reported(at) + moved * moved.transpose();
}

AngularRateState AngularRateStream::Impl::rate_state_of_knot(std::size_t at, const State& state) const {
  const Knot& knot = state.window[at];
  const Eigen::Matrix3d covariance = inflated_rate_covariance(at, state);
  AngularRateState out;
  out.time_ns = knot.observation.sample.time_ns;
  out.w_WI_I_rad_s = knot.estimate.knot.rate_rad_s;
  out.covariance_rad2_s2 = model.output_covariance(covariance, knot.observation, knot.estimate);
  const double gyro_late_s = -state.sensor_errors.front().accel_delay_state.applied_delay_s;
  if (gyro_late_s > 0.0) {
    extrapolate_estimate(at, gyro_late_s, state, out);
    out.covariance_rad2_s2.diagonal() += knot.repeated.change_since_new_reading().cwiseAbs2();
  } else if (const std::optional<InterpolatedRate> own = rate_between_readings(state.window, at, params.period_s)) {
    out.w_WI_I_rad_s = own->rate_rad_s - state.rig.gyro_bias_rad_s;
    out.covariance_rad2_s2.diagonal() += own->variance_rad2_s2;
  } else {
    out.covariance_rad2_s2.diagonal() += knot.repeated.change_since_new_reading().cwiseAbs2();
  }
  out.covariance_rad2_s2.diagonal() += frozen_axes.rate_variance_rad2_s2(out.time_ns, state.frozen_axes);
  out.clipped_axes = knot.observation.clipping.gyro | knot.observation.clipping.unusable_gyro;
  out.source = rate_source_of(knot.observation, knot.estimate, covariance);
  if (out.source == AngularRateSource::measured && is_possibly_saturated(at, state))
    out.source = AngularRateSource::lower_bound_only;
  return out;
}

std::optional<AngularRateState> AngularRateStream::newest(const State& state) const {
  if (state.window.empty()) return std::nullopt;
  return impl_->rate_state_of_knot(state.window.size() - 1, state);
}

void AngularRateStream::flush(const State& state, std::vector<AngularRateState>& out) const {
  const std::size_t given = state.window.size() + 1 - std::min(impl_->window_knots, state.window.size() + 1);
  for (std::size_t k = given; k < state.window.size(); ++k) out.push_back(impl_->rate_state_of_knot(k, state));
}

}  // namespace tumble
