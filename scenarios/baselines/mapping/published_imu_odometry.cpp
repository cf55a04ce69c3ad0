// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/published_imu_odometry.hpp"

#include <algorithm>

#include "scenarios/baselines/attitude/madgwick.hpp"

namespace tumble::baselines {

PublishedImuOdometry::PublishedImuOdometry(double madgwick_gain_rad_s, std::span<const ImuSample> samples,
                                           std::span<const AngularRateState> rates)
    : samples_(samples) {
  Madgwick::Params params;
  params.gain_rad_s = madgwick_gain_rad_s;
  const Madgwick madgwick(params);
  Madgwick::State state;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ImuSample sample = samples[k];
    sample.angular_velocity_rad_s = rates[k].w_WI_I_rad_s;
    (void)madgwick.step(sample, state);
    attitude_.push_back(state.q_WI);
  }
  p_m_.assign(1, Eigen::Vector3d::Zero());
  v_m_s_.assign(1, Eigen::Vector3d::Zero());
  gravity_m_s2_ = (attitude_[0] * samples[0].specific_force_m_s2).z();
}

void PublishedImuOdometry::advance(TimeNs to_ns) {
  while (p_m_.size() < samples_.size() && samples_[p_m_.size() - 1].time_ns < to_ns) {
    const std::size_t k = p_m_.size();
    const double step_s = seconds(samples_[k].time_ns - samples_[k - 1].time_ns);
    const Eigen::Vector3d change =
        fed_back_ ? Eigen::Vector3d(0.5 * (acceleration_m_s2(k - 1) + acceleration_m_s2(k)) * step_s)
                  : Eigen::Vector3d::Zero();
    p_m_.push_back(p_m_.back() + step_s * (velocity_m_s_ + 0.5 * change));
    velocity_m_s_ += change;
    v_m_s_.push_back(velocity_m_s_);
    changes_.push_back({samples_[k].time_ns, change});
  }
}

void PublishedImuOdometry::feed_back(const Eigen::Vector3d& velocity_m_s, TimeNs time_ns) {
  fed_back_ = true;
  velocity_m_s_ = velocity_m_s;
  for (const auto& [time, change] : changes_) {
    if (time > time_ns) velocity_m_s_ += change;
  }
  std::erase_if(changes_, [&](const auto& entry) { return entry.first <= time_ns; });
}

Eigen::Isometry3d PublishedImuOdometry::pose(TimeNs time_ns) const {
  const std::size_t k = sample_at(time_ns);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (k == 0) {
    T.linear() = attitude_[0].toRotationMatrix();
    return T;
  }
  const double share = std::clamp(static_cast<double>(time_ns - samples_[k - 1].time_ns) /
                                      static_cast<double>(samples_[k].time_ns - samples_[k - 1].time_ns),
                                  0.0, 1.0);
  T.linear() = attitude_[k - 1].slerp(share, attitude_[k]).toRotationMatrix();
  T.translation() = (1.0 - share) * p_m_[k - 1] + share * p_m_[k];
  return T;
}

const Eigen::Vector3d& PublishedImuOdometry::velocity_m_s(TimeNs time_ns) const {
  return v_m_s_[sample_at(time_ns)];
}

std::size_t PublishedImuOdometry::sample_at(TimeNs time_ns) const {
  const auto next = std::lower_bound(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(p_m_.size()),
                                     time_ns, [](const ImuSample& s, TimeNs t) { return s.time_ns < t; });
  return std::min(static_cast<std::size_t>(next - samples_.begin()), p_m_.size() - 1);
}

Eigen::Vector3d PublishedImuOdometry::acceleration_m_s2(std::size_t k) const {
  return attitude_[k] * samples_[k].specific_force_m_s2 - gravity_m_s2_ * Eigen::Vector3d::UnitZ();
}

}  // namespace tumble::baselines
