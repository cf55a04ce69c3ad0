// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_visitor.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"

namespace tumble {

template <StateOf<ImuSample> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sample.time_ns", s.time_ns);
  visit("angular_velocity_rad_s", s.angular_velocity_rad_s);
  visit("specific_force_m_s2", s.specific_force_m_s2);
  visit("device_clip_flags", s.device_clip_flags);
}

template <StateOf<ImuAverage> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("average.mean", s.mean);
  visit("average.length_s", s.length_s);
  visit("average.rate_peak_rad_s", s.rate_peak_rad_s);
  visit("average.force_peak_m_s2", s.force_peak_m_s2);
  visit("average.readings", s.readings);
}

template <StateOf<PoseState> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("pose.time_ns", s.time_ns);
  visit("pose.p_WA_m", s.p_WA_m);
  visit("pose.q_WA", s.q_WA);
  visit("pose.v_WA_m_s", s.v_WA_m_s);
  visit("pose.covariance", s.covariance);
}

}  // namespace tumble
