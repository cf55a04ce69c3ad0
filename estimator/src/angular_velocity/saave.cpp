// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saave.hpp"

#include <algorithm>
#include <cmath>

#include "wnoj_smoother.hpp"

namespace tumble {

namespace {

std::uint8_t axes_above_bound(const Eigen::Vector3d& rate, double bound) {
  std::uint8_t axes = 0;
  for (int j = 0; j < 3; ++j) {
    if (std::abs(rate[j]) > bound) axes |= static_cast<std::uint8_t>(1u << j);
  }
  return axes;
}

// Returns the squared angular rate, or NaN if the IMU is on the rotation axis: saave.md (S1), (S2).
double squared_rate(const Eigen::Vector3d& lever_arm, const Eigen::Vector3d& axis, const Eigen::Vector3d& force) {
  const Eigen::Vector3d to_axis = lever_arm.dot(axis) * axis - lever_arm;
  const double r = to_axis.norm();
  return (to_axis / r).dot(force) / r;
}

}  // namespace

SaturationAwareRateEstimator::SaturationAwareRateEstimator(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status SaturationAwareRateEstimator::step(const ImuSample& sample, State& state, RecoveredRate& out) const {
  if (Status status = check_sample(sample); !status.ok()) return status;
  if (state.started) {
    Status status = check_stamp_order(sample.time_ns, state.last_time_ns, params_.kGapMax_s);
    if (!status.ok()) return status;
  }
  state.started = true;
  state.last_time_ns = sample.time_ns;

  const Eigen::Vector3d& reading = sample.angular_velocity_rad_s;
  out.rate_rad_s = reading;
  out.variance_rad2_s2.setConstant(params_.kVarianceMeasured_rad2_s2);
  out.clipped_axes = axes_above_bound(reading, params_.saturation_point_rad_s);
  out.accepted = true;
  if (out.clipped_axes != 0) {
    // As in the publication of the method Saave, SaturationAwareRateEstimator recovers only the first clipped axis in
    // the order x, y, z: saave.md (S3).
    int j = 0;
    while ((out.clipped_axes >> j & 1u) == 0) ++j;
    Eigen::Vector3d unclipped = reading;
    unclipped[j] = 0.0;
    const double others = unclipped.squaredNorm();
    const double squared = squared_rate(params_.lever_arm_m, state.axis, sample.specific_force_m_s2);
    out.accepted = squared > others;
    if (out.accepted) {
      const double magnitude = std::max(std::sqrt(squared - others), std::abs(reading[j]));
      out.rate_rad_s[j] = std::copysign(magnitude, reading[j]);
      out.variance_rad2_s2[j] = params_.kVarianceEstimated_rad2_s2;
    } else {
      out.variance_rad2_s2[j] = params_.kVarianceRejected_rad2_s2;
    }
  }
  const double norm = out.rate_rad_s.norm();
  if (out.accepted && norm > 0.0) state.axis = out.rate_rad_s / norm;
  return {};
}

Status SaturationAwareRateEstimator::estimate(std::span<const ImuSample> samples,
                                              std::vector<AngularRateState>& out) const {
  if (samples.empty()) return {ErrorCode::empty, "samples", 0.0, 1.0};
  State state;
  std::vector<RecoveredRate> recovered(samples.size());
  std::vector<WnojSmoother::Measurement> measurements(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (Status status = step(samples[k], state, recovered[k]); !status.ok()) return status;
    measurements[k] = {samples[k].time_ns, recovered[k].rate_rad_s, recovered[k].variance_rad2_s2};
  }
  std::vector<WnojSmoother::Smoothed> smoothed;
  const WnojSmoother smoother({params_.jerk_psd_rad2_s5});
  if (Status status = smoother.smooth(measurements, smoothed); !status.ok()) return status;

  out.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out[k].time_ns = samples[k].time_ns;
    out[k].w_WI_I_rad_s = smoothed[k].rate_rad_s;
    out[k].covariance_rad2_s2 = smoothed[k].variance_rad2_s2.asDiagonal();
    out[k].clipped_axes = recovered[k].clipped_axes;
    out[k].source = recovered[k].clipped_axes == 0 ? AngularRateSource::measured
                    : recovered[k].accepted        ? AngularRateSource::recovered_in_flight
                                                   : AngularRateSource::lower_bound_only;
  }
  return {};
}

}  // namespace tumble
