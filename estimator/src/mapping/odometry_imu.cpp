// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "odometry_impl.hpp"

namespace tumble {

namespace {

constexpr std::uint8_t kAllAxes = 7;
constexpr TimeNs kArcStep_ns = 5'000'000;

TimeNs middle_of(const MotionSample& sample) {
  return sample.from_ns + (sample.time_ns - sample.from_ns) / 2;
}

}  // namespace

/// Adds a checked sample to those that wait for the next sweep.
void LidarInertialOdometry::Impl::take(const ImuSample& sample, const RateState& rate) {
  const bool follows = started || !samples.empty();
  const TimeNs last_ns = !samples.empty() ? samples.back().time_ns : state.time_ns;
  // the first window's length is that of the second
  if (!started && samples.size() == 1) samples[0].from_ns = 2 * last_ns - sample.time_ns;
  MotionSample next;
  next.from_ns = follows ? last_ns : sample.time_ns;
  next.time_ns = sample.time_ns;
  next.at_rest = rest.take(params, rate.w_WI_I_rad_s, sample.specific_force_m_s2);
  if (!next.at_rest) next.w_WI_I_rad_s = rate.w_WI_I_rad_s - rest.rate_bias_rad_s();
  next.f_I_m_s2 = sample.specific_force_m_s2;
  next.rate_sigma_rad_s = mapping::believed_rate_sigma(params, rate, next.time_ns - next.from_ns);
  next.clipped_axes = static_cast<std::uint8_t>(rate.clipped_axes & kAllAxes);
  for (int axis = 0; axis < 3; ++axis) {
    const bool railed = std::abs(next.f_I_m_s2[axis]) >= params.accel_rail_m_s2 ||
                        (sample.device_clip_flags & (kClipAccelX << axis)) != 0;
    if (railed) next.railed_axes |= static_cast<std::uint8_t>(1 << axis);
  }
  next.bridges_gap = next.time_ns - next.from_ns > mapping::kGap_ns;
  const bool in_flight = params.body && !samples.empty() && settle_force(next);
  before_newest = newest;
  newest = {next.w_WI_I_rad_s, middle_of(next), true};
  std::vector<MotionSample> arc;
  if (in_flight && next.bridges_gap &&
      flight_arc(*params.body, samples.back().w_WI_I_rad_s, next.from_ns, next.time_ns, kArcStep_ns, arc).ok()) {
    for (MotionSample& part : arc) {
      part.rate_sigma_rad_s = next.rate_sigma_rad_s;
      part.in_flight = true;
      samples.push_back(part);
    }
    return;
  }
  samples.push_back(next);
}

/// Now that the rates on both sides of the newest sample are known, tells whether it belongs to a flight: before a gap
/// by the rate that flight itself would change. flight_arc.md (A3), (A4), (A5).
bool LidarInertialOdometry::Impl::settle_force(const MotionSample& next) {
  MotionSample& now = samples.back();
  if (now.in_flight) return true;
  const double span_s = seconds(middle_of(next) - before_newest.middle_ns);
  if (now.at_rest || now.bridges_gap || !before_newest.known || span_s <= 0.0) return false;
  const Eigen::Vector3d acceleration = next.bridges_gap
                                           ? torque_free_acceleration(*params.body, now.w_WI_I_rad_s)
                                           : Eigen::Vector3d((next.w_WI_I_rad_s - before_newest.rate_rad_s) / span_s);
  const Eigen::Vector3d force = flight_force(*params.body, now.w_WI_I_rad_s, acceleration);
  if ((now.f_I_m_s2 - force).norm() > params.flight_force_m_s2) return false;
  now.f_I_m_s2 = force;
  now.in_flight = true;
  return true;
}

}  // namespace tumble
