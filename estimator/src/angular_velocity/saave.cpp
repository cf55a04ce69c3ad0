// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saave.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

namespace {

constexpr double kVarianceMin = 1e-18;
constexpr double kVarianceMax = 1e18;

// Relates the states x_k and x_{k+1} of two successive samples on one axis: R x_k + S x_{k+1} = z, with unit noise. R
// is `residual_factor`, and S is `innovation_matrix`: saave.md (S6). The state x contains the rate, and the angular
// acceleration times time_scale.
struct EliminatedKnot {
  Eigen::Matrix2d residual_factor, innovation_matrix;
  Eigen::Vector2d z;
};

// Represents the equation R x = z with upper triangular R for the state x of the current sample.
struct ForwardMessage {
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
};

// Columns 0 to 3 of a Stack multiply the states of samples k and k + 1, and column 4 is the right-hand side.
using Stack = Eigen::Matrix<double, 5, 5>;

void triangularise(Stack& a) {
  for (int c = 0; c < 4; ++c) {
    const int n = 5 - c;
    const double norm = a.col(c).tail(n).norm();
    if (norm == 0.0) continue;
    Eigen::Matrix<double, 5, 1> v = a.col(c);
    v[c] += std::copysign(norm, v[c]);
    const double scale = 2.0 / v.tail(n).squaredNorm();
    for (int j = c; j < 5; ++j) {
      const double projection = scale * v.tail(n).dot(a.col(j).tail(n));
      a.col(j).tail(n) -= projection * v.tail(n);
    }
    a.col(c).tail(n - 1).setZero();
  }
}

EliminatedKnot eliminate(ForwardMessage& carried, double rate, double deviation, double dt_s, double psd,
                         double time_scale_s) {
  // See saave.md (S5).
  const double ratio = dt_s / time_scale_s;
  const double unit = std::sqrt(psd * dt_s) * dt_s;
  const double l11 = unit / std::sqrt(3.0);
  const double l21 = unit * std::sqrt(3.0) / (2.0 * ratio);
  const double l22 = unit / (2.0 * ratio);
  Eigen::Matrix2d L_inv, F;
  L_inv << 1.0 / l11, 0.0, -l21 / (l11 * l22), 1.0 / l22;
  F << 1.0, ratio, 0.0, 1.0;

  Stack a = Stack::Zero();
  a.block<2, 2>(0, 0) = carried.R;
  a.block<2, 1>(0, 4) = carried.z;
  a(2, 0) = 1.0 / deviation;
  a(2, 4) = rate / deviation;
  a.block<2, 2>(3, 0) = L_inv * F;
  a.block<2, 2>(3, 2) = -L_inv;
  triangularise(a);
  carried = {a.block<2, 2>(2, 2), a.block<2, 1>(2, 4)};
  return {a.block<2, 2>(0, 0), a.block<2, 2>(0, 2), a.block<2, 1>(0, 4)};
}

void add_measurement(ForwardMessage& carried, double rate, double deviation) {
  Stack a = Stack::Zero();
  a.block<2, 2>(0, 0) = carried.R;
  a.block<2, 1>(0, 4) = carried.z;
  a(2, 0) = 1.0 / deviation;
  a(2, 4) = rate / deviation;
  triangularise(a);
  carried = {a.block<2, 2>(0, 0), a.block<2, 1>(0, 4)};
}

Status check(std::span<const WnojSmoother::Measurement> measurements) {
  if (measurements.empty()) return {ErrorCode::empty, "measurements", 0.0, 1.0};
  for (std::size_t k = 0; k < measurements.size(); ++k) {
    const auto& m = measurements[k];
    for (int j = 0; j < 3; ++j) {
      if (!std::isfinite(m.rate_rad_s[j])) {
        return {ErrorCode::non_finite, "rate_rad_s", m.rate_rad_s[j], std::numeric_limits<double>::max()};
      }
      if (!std::isfinite(m.variance_rad2_s2[j])) {
        return {ErrorCode::non_finite, "variance_rad2_s2", m.variance_rad2_s2[j], kVarianceMax};
      }
      if (m.variance_rad2_s2[j] < kVarianceMin) {
        return {ErrorCode::out_of_range, "variance_rad2_s2", m.variance_rad2_s2[j], kVarianceMin};
      }
      if (m.variance_rad2_s2[j] > kVarianceMax) {
        return {ErrorCode::out_of_range, "variance_rad2_s2", m.variance_rad2_s2[j], kVarianceMax};
      }
    }
    if (k > 0 && m.time_ns <= measurements[k - 1].time_ns) {
      return {ErrorCode::time_order, "time_ns", static_cast<double>(m.time_ns),
              static_cast<double>(measurements[k - 1].time_ns)};
    }
  }
  return {};
}

void smooth_axis(std::span<const WnojSmoother::Measurement> measurements, int axis, double psd,
                 std::vector<EliminatedKnot>& rows, std::vector<WnojSmoother::Smoothed>& out) {
  const std::size_t count = measurements.size();
  const double time_scale_s =
      seconds(measurements.back().time_ns - measurements.front().time_ns) / static_cast<double>(count - 1);
  ForwardMessage carried;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const auto& m = measurements[k];
    rows[k] = eliminate(carried, m.rate_rad_s[axis], std::sqrt(m.variance_rad2_s2[axis]),
                        seconds(measurements[k + 1].time_ns - m.time_ns), psd, time_scale_s);
  }
  add_measurement(carried, measurements.back().rate_rad_s[axis], std::sqrt(measurements.back().variance_rad2_s2[axis]));

  // See saave.md (S7).
  Eigen::Matrix2d R_inv = carried.R.triangularView<Eigen::Upper>().solve(Eigen::Matrix2d::Identity());
  Eigen::Vector2d x = R_inv * carried.z;
  Eigen::Matrix2d P = R_inv * R_inv.transpose();
  for (std::size_t k = count; k-- > 0;) {
    if (k + 1 < count) {
      const EliminatedKnot& row = rows[k];
      R_inv = row.residual_factor.triangularView<Eigen::Upper>().solve(Eigen::Matrix2d::Identity());
      const Eigen::Matrix2d G = R_inv * row.innovation_matrix;
      x = (R_inv * row.z - G * x).eval();
      P = (R_inv * R_inv.transpose() + G * P * G.transpose()).eval();
    }
    out[k].rate_rad_s[axis] = x[0];
    out[k].acceleration_rad_s2[axis] = x[1] / time_scale_s;
    out[k].variance_rad2_s2[axis] = P(0, 0);
  }
}

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

WnojSmoother::WnojSmoother(const Params& params) : params_(params) {
  require_valid_fields(params);
}

Status WnojSmoother::smooth(std::span<const Measurement> measurements, std::vector<Smoothed>& out) const {
  if (Status status = check(measurements); !status.ok()) return status;
  out.resize(measurements.size());
  if (measurements.size() == 1) {
    out[0] = {measurements[0].rate_rad_s, Eigen::Vector3d::Zero(), measurements[0].variance_rad2_s2};
    return {};
  }
  std::vector<EliminatedKnot> rows(measurements.size() - 1);
  for (int axis = 0; axis < 3; ++axis) smooth_axis(measurements, axis, params_.jerk_psd_rad2_s5, rows, out);
  return {};
}

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
