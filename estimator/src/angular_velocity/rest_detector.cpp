// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rest_detector.hpp"

#include "tumble/common/status.hpp"

namespace tumble {

RestDetector::RestDetector(const Params& params) : params_(params) {
  require_fields(params);
}

bool RestDetector::observe(const ImuSample& sample, State& state) const {
  if (state.open++ == 0) {
    state.rate_open_rad_s.setZero();
    state.force_open_m_s2.setZero();
    state.open_first_ns = sample.time_ns;
  }
  state.rate_open_rad_s += sample.angular_velocity_rad_s;
  state.force_open_m_s2 += sample.specific_force_m_s2;
  // a reading ends with the sample that lies nearest to its length
  const double half_s = 0.5 * seconds(sample.time_ns - state.last_ns);
  const bool whole = !state.started || seconds(sample.time_ns - state.last_reading_ns) >= params_.reading_s - half_s;
  state.started = true;
  state.last_ns = sample.time_ns;
  if (!whole) return state.rests;
  const double share = 1.0 / static_cast<double>(state.open);
  state.open = 0;
  state.last_reading_ns = sample.time_ns;
  read(share * state.rate_open_rad_s, share * state.force_open_m_s2, sample.time_ns, state);
  return state.rests;
}

void RestDetector::read(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2, TimeNs time_ns,
                        State& state) const {
  state.rests = false;
  if (state.count > 0) {
    const double share = 1.0 / static_cast<double>(state.count);
    const double rate_off = (rate_rad_s - share * state.rate_sum_rad_s).cwiseAbs().maxCoeff();
    const double force_off = (force_m_s2 - share * state.force_sum_m_s2).cwiseAbs().maxCoeff();
    if (rate_off > params_.rate_spread_rad_s || force_off > params_.force_spread_m_s2) state.count = 0;
  }
  if (rate_rad_s.cwiseAbs().maxCoeff() > params_.rate_max_rad_s + params_.rate_spread_rad_s ||
      force_m_s2.norm() < params_.force_min_m_s2) {
    state.count = 0;
    return;
  }
  if (state.count == 0) {
    state.first_ns = state.open_first_ns;
    state.rate_sum_rad_s.setZero();
    state.force_sum_m_s2.setZero();
  }
  state.rate_sum_rad_s += rate_rad_s;
  state.force_sum_m_s2 += force_m_s2;
  ++state.count;
  const double mean = state.rate_sum_rad_s.cwiseAbs().maxCoeff() / static_cast<double>(state.count);
  state.rests = seconds(time_ns - state.first_ns) >= params_.rest_s && mean <= params_.rate_max_rad_s;
}

std::vector<bool> RestDetector::find(std::span<const ImuSample> samples) const {
  std::vector<bool> rest(samples.size(), false);
  State state;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!observe(samples[k], state)) continue;
    // the samples of the run so far are rest with it
    for (std::size_t i = k + 1; i-- > 0 && samples[i].time_ns >= state.first_ns && !rest[i];) rest[i] = true;
  }
  return rest;
}

}  // namespace tumble
