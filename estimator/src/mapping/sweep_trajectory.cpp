// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/sweep_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "unknowns.hpp"

namespace tumble {

namespace {

// coefficients for evaluating the power series of cos(x) and sin(x) / x with Horner's method, where x is half of a
// rotation angle; ratios of successive terms, last term first
constexpr std::pair<double, double> kSeriesRatios[] = {
    {1.0 / 182, 1.0 / 210}, {1.0 / 132, 1.0 / 156}, {1.0 / 90, 1.0 / 110}, {1.0 / 56, 1.0 / 72},
    {1.0 / 30, 1.0 / 42},   {1.0 / 12, 1.0 / 20},   {1.0 / 2, 1.0 / 6}};
// square of the largest rotation angle for which the power series is accurate
constexpr double kSeriesAngle2_rad2 = 1.0;
constexpr int kLanes = 8;
constexpr double kNoEnd_s = std::numeric_limits<double>::infinity();
using Lane = double[kLanes];

struct PointLanes {
  int count = 0;
  alignas(16) Lane s{}, x{}, y{}, z{};
  alignas(16) Lane cosine, sinc;
};

void rotate_lever_arms(double rate2_rad2_s2, PointLanes& p) {
  alignas(16) Lane h;
  for (int l = 0; l < kLanes; ++l) {
    h[l] = 0.25 * (p.s[l] * p.s[l] * rate2_rad2_s2);
    p.cosine[l] = p.sinc[l] = 1.0;
  }
  for (const auto& [of_cosine, of_sinc] : kSeriesRatios) {
    for (int l = 0; l < kLanes; ++l) {
      p.cosine[l] = 1.0 - (h[l] * of_cosine) * p.cosine[l];
      p.sinc[l] = 1.0 - (h[l] * of_sinc) * p.sinc[l];
    }
  }
}

Eigen::Vector3d max_rate_sigma_per_axis(std::span<const MotionSample> samples, TimeNs end_ns) {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  for (const MotionSample& sample : samples) {
    if (sample.from_ns >= end_ns) break;
    for (int axis = 0; axis < 3; ++axis) {
      if (sample.clipped_axes >> axis & 1) sigma[axis] = std::max(sigma[axis], sample.rate_sigma_rad_s[axis]);
    }
  }
  return sigma;
}

/// Returns the signed factors s_j by which the saturation deficit of each gyro axis changes the rate of a sample:
/// mapping.md (R8).
Eigen::Vector3d clipped_axis_signs(const MotionSample& sample, const Eigen::Vector3d& least_known_rad_s) {
  Eigen::Vector3d share = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(sample.clipped_axes >> axis & 1)) continue;
    share[axis] = least_known_rad_s[axis] > 0.0 ? sample.rate_sigma_rad_s[axis] / least_known_rad_s[axis] : 1.0;
    // A saturated reading has a smaller magnitude than the true rate, and the same sign. In a gap between IMU samples,
    // the sign of the interpolation error is unknown.
    if (sample.w_WI_I_rad_s[axis] < 0.0 && !sample.bridges_gap) share[axis] = -share[axis];
  }
  return share;
}

/// See mapping.md (R7).
Eigen::Matrix<double, SweepTrajectory::kKnots, 1> knot_weights(double share) {
  Eigen::Matrix<double, SweepTrajectory::kKnots, 1> weights;
  const double place = std::clamp(share, 0.0, 1.0) * (SweepTrajectory::kKnots - 1);
  for (int k = 0; k < SweepTrajectory::kKnots; ++k) weights[k] = std::max(0.0, 1.0 - std::abs(place - k));
  return weights;
}

/// If the angle is small, rotated_by() sums the power series of cosine and sine. The power series is faster to compute
/// than so3::exp, and exact except for rounding.
Eigen::Quaterniond rotated_by(const Eigen::Vector3d& rate_rad_s, double s) {
  const double angle2 = s * s * rate_rad_s.squaredNorm();
  if (!(angle2 <= kSeriesAngle2_rad2)) return so3::exp(rate_rad_s * s);
  const double h = 0.25 * angle2;  // square of half of the angle
  double cosine = 1.0, sinc = 1.0;
  for (const auto& [of_cosine, of_sinc] : kSeriesRatios) {
    cosine = 1.0 - (h * of_cosine) * cosine;
    sinc = 1.0 - (h * of_sinc) * sinc;
  }
  const Eigen::Vector3d v = (0.5 * s * sinc) * rate_rad_s;
  return {cosine, v.x(), v.y(), v.z()};
}

}  // namespace

/// See mapping.md (R2), (R4), (R6).
// lever_arm_vectors() performs the same operations as Eigen's quaternions, in the same order. The results are therefore
// bit-identical to the results of SweepTrajectory::at.
void SweepTrajectory::lever_arm_vectors(std::span<const SweepPoint> points,
                                        std::span<Eigen::Vector3f> levers_W_m) const {
  const double from_s = -kExtrapolation_s, to_s = duration_s_ + kExtrapolation_s;
  std::size_t hint = 0;
  for (std::size_t first = 0; first < points.size();) {
    const Interval& now = interval_at(std::clamp<double>(points[first].t_s, from_s, to_s), hint);
    const double begin_s = hint == 0 ? from_s : now.start_s;
    const double end_s = hint + 1 < intervals_.size() ? intervals_[hint + 1].start_s : kNoEnd_s;
    const double rate2 = now.rate_I_rad_s.squaredNorm();
    PointLanes p;
    bool small = true;
    for (; p.count < kLanes && first + p.count < points.size(); ++p.count) {
      const SweepPoint& point = points[first + p.count];
      const double t = std::clamp<double>(point.t_s, from_s, to_s);
      if (p.count > 0 && !(t >= begin_s && t < end_s)) break;
      const double s = t - now.start_s;
      small = small && s * s * rate2 <= kSeriesAngle2_rad2;
      p.s[p.count] = s;
      p.x[p.count] = point.x_I_m.x();
      p.y[p.count] = point.x_I_m.y();
      p.z[p.count] = point.x_I_m.z();
    }
    if (!small) {
      for (int l = 0; l < p.count; ++l) {
        const SweepPoint& point = points[first + l];
        const PreintegratedMotion at = this->at(point.t_s, hint);
        levers_W_m[first + l] = (at.preintegrated_position_m + at.q_WI * point.x_I_m.cast<double>()).cast<float>();
      }
      first += p.count;
      continue;
    }
    rotate_lever_arms(rate2, p);
    const Eigen::Quaterniond& q = now.q_WI;
    const double ax = q.x(), ay = q.y(), az = q.z(), aw = q.w();
    const Eigen::Vector3d &w = now.rate_I_rad_s, &S = now.preintegrated_position_m, &V = now.preintegrated_velocity_m_s,
                          &A = now.specific_force_W_m_s2;
    alignas(16) float ux[kLanes], uy[kLanes], uz[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const double s = p.s[l], x = p.x[l], y = p.y[l], z = p.z[l];
      const double half = 0.5 * s * p.sinc[l], bx = half * w.x(), by = half * w.y(), bz = half * w.z();
      const double bw = p.cosine[l];
      const double qx = (aw * bx + ay * bz) - (az * by - ax * bw), qy = (aw * by + ay * bw) + (az * bx - ax * bz);
      const double qz = (aw * bz - ay * bx) + (az * bw + ax * by), qw = (aw * bw - ay * by) - (az * bz + ax * bx);
      double tx = qy * z - qz * y, ty = qz * x - qx * z, tz = qx * y - qy * x;
      tx += tx;
      ty += ty;
      tz += tz;
      const double force = 0.5 * s * s;
      ux[l] = static_cast<float>((S.x() + s * V.x() + force * A.x()) + (x + qw * tx + (qy * tz - qz * ty)));
      uy[l] = static_cast<float>((S.y() + s * V.y() + force * A.y()) + (y + qw * ty + (qz * tx - qx * tz)));
      uz[l] = static_cast<float>((S.z() + s * V.z() + force * A.z()) + (z + qw * tz + (qx * ty - qy * tx)));
    }
    for (int l = 0; l < p.count; ++l) levers_W_m[first + l] = {ux[l], uy[l], uz[l]};
    first += p.count;
  }
}

PoseState MotionState::pose() const {
  PoseState pose;
  pose.time_ns = time_ns;
  pose.position_W_m = p_WI_m;
  pose.orientation_W = q_WI;
  pose.velocity_W_m_s = v_WI_m_s;
  pose.covariance = covariance.topLeftCorner<6, 6>();
  return pose;
}

Status SweepTrajectory::build(const MotionState& start, std::span<const MotionSample> samples, TimeNs end_ns,
                              const Eigen::Vector3d& gravity_W_m_s2, const Deficit& deficit_rad_s) {
  start_ = start;
  gravity_W_m_s2_ = gravity_W_m_s2;
  duration_s_ = seconds(end_ns - start.time_ns);
  clipped_axes_ = 0;
  intervals_.clear();
  if (end_ns < start.time_ns) return {ErrorCode::time_order, "end_ns", double(end_ns), double(start.time_ns)};
  if (samples.empty() || samples.back().time_ns < end_ns) {
    return {ErrorCode::insufficient_data, "imu time_ns", samples.empty() ? 0.0 : double(samples.back().time_ns),
            double(end_ns)};
  }
  if (samples.front().from_ns > start.time_ns) {
    // Each `gap` error reports a duration in seconds.
    return {ErrorCode::gap, "imu window start", seconds(samples.front().from_ns - start.time_ns), 0.0};
  }

  const Eigen::Vector3d sigma = max_rate_sigma_per_axis(samples, end_ns);
  Interval next{};
  next.q_WI = start.q_WI;
  next.preintegrated_velocity_m_s = next.preintegrated_position_m = next.rate_I_rad_s = next.specific_force_W_m_s2 =
      next.clipped_axis_sign = Eigen::Vector3d::Zero();
  next.attitude_jacobian = next.velocity_jacobian = next.position_jacobian = next.acceleration_jacobian =
      DeficitJacobian::Zero();
  for (const MotionSample& sample : samples) {
    const TimeNs from = std::max(sample.from_ns, start.time_ns);
    const TimeNs to = std::min(sample.time_ns, end_ns);
    // A trajectory with zero duration gets one interval, so that its state can be computed.
    if (to < from || (to == from && !(end_ns == start.time_ns && intervals_.empty()))) continue;
    const double dt = seconds(to - from);
    const Eigen::Vector3d share = clipped_axis_signs(sample, sigma);
    clipped_axes_ |= sample.clipped_axes & 7;
    Interval& now = intervals_.emplace_back(next);
    now.start_s = seconds(from - start.time_ns);
    now.length_s = dt;
    now.clipped_axis_sign = share;
    now.knot_weight = knot_weights(duration_s_ > 0.0 ? (now.start_s + 0.5 * dt) / duration_s_ : 0.0);
    // See mapping.md (R7), (R5), (R4), (R6).
    now.rate_I_rad_s = sample.w_WI_I_rad_s + share.cwiseProduct(deficit_rad_s * now.knot_weight);
    const Eigen::Matrix3d R = now.q_WI.toRotationMatrix();
    const Eigen::Matrix3d mean_rotation = R * so3::left_jacobian(now.rate_I_rad_s * dt);
    now.specific_force_W_m_s2 =
        sample.bridges_gap ? Eigen::Vector3d(-gravity_W_m_s2) : Eigen::Vector3d(mean_rotation * sample.f_I_m_s2);

    next.q_WI = (now.q_WI * so3::exp(now.rate_I_rad_s * dt)).normalized();
    next.preintegrated_velocity_m_s = now.preintegrated_velocity_m_s + now.specific_force_W_m_s2 * dt;
    next.preintegrated_position_m = now.preintegrated_position_m + now.preintegrated_velocity_m_s * dt +
                                    now.specific_force_W_m_s2 * (0.5 * dt * dt);
    if (clipped_axes_ == 0) continue;
    now.acceleration_jacobian = -so3::hat(now.specific_force_W_m_s2) * now.attitude_jacobian;
    next.attitude_jacobian = now.attitude_jacobian + saturation_deficit_jacobian_within(now, dt);
    // The mean attitude error during an IMU sample rotates the specific force of the sample: mapping.md (R10).
    const DeficitJacobian turn =
        -so3::hat(now.specific_force_W_m_s2) * (0.5 * (now.attitude_jacobian + next.attitude_jacobian));
    next.velocity_jacobian = now.velocity_jacobian + turn * dt;
    next.position_jacobian = now.position_jacobian + now.velocity_jacobian * dt + turn * (0.5 * dt * dt);
  }
  if (intervals_.empty()) return {ErrorCode::insufficient_data, "imu samples", 0.0, 1.0};
  return {};
}

const SweepTrajectory::Interval& SweepTrajectory::interval_at(double t_s, std::size_t& hint) const {
  std::size_t i = std::min(hint, intervals_.size() - 1);
  while (i + 1 < intervals_.size() && t_s >= intervals_[i + 1].start_s) ++i;
  while (i > 0 && t_s < intervals_[i].start_s) --i;
  hint = i;
  return intervals_[i];
}

/// See mapping.md (R2), (R4), (R6).
SweepTrajectory::PreintegratedMotion SweepTrajectory::at(double t_s, std::size_t& hint) const {
  const double t = std::clamp(t_s, -kExtrapolation_s, duration_s_ + kExtrapolation_s);
  const Interval& now = interval_at(t, hint);
  const double s = t - now.start_s;
  return {
      now.q_WI * rotated_by(now.rate_I_rad_s, s),
      now.preintegrated_position_m + s * now.preintegrated_velocity_m_s + (0.5 * s * s) * now.specific_force_W_m_s2};
}

SweepTrajectory::PreintegratedMotion SweepTrajectory::at(double t_s, const Eigen::Vector3d& x_I_m, std::size_t& hint,
                                                         Eigen::Vector3d& velocity_m_s) const {
  const double t = std::clamp(t_s, -kExtrapolation_s, duration_s_ + kExtrapolation_s);
  const Interval& now = interval_at(t, hint);
  const double s = t - now.start_s;
  const Eigen::Quaterniond turned = rotated_by(now.rate_I_rad_s, s);
  velocity_m_s = start_.v_WI_m_s + t * gravity_W_m_s2_ + now.preintegrated_velocity_m_s +
                 s * now.specific_force_W_m_s2 + now.q_WI * (turned * now.rate_I_rad_s.cross(x_I_m));
  return {now.q_WI * turned, now.preintegrated_position_m + s * now.preintegrated_velocity_m_s +
                                 (0.5 * s * s) * now.specific_force_W_m_s2};
}

/// See mapping.md (R9).
SweepTrajectory::DeficitJacobian SweepTrajectory::saturation_deficit_jacobian_within(const Interval& now, double s) {
  if (now.clipped_axis_sign.isZero(0.0)) return DeficitJacobian::Zero();
  const Eigen::Matrix3d gained =
      now.q_WI.toRotationMatrix() * so3::left_jacobian(now.rate_I_rad_s * s) * now.clipped_axis_sign.asDiagonal() * s;
  DeficitJacobian out;
  for (int k = 0; k < kKnots; ++k) out.middleCols<3>(3 * k) = now.knot_weight[k] * gained;
  return out;
}

/// See mapping.md (R9), (R10).
SweepTrajectory::SaturationDeficitJacobian SweepTrajectory::saturation_deficit_jacobian(double t_s,
                                                                                        std::size_t& hint) const {
  const double t = std::clamp(t_s, 0.0, duration_s_);
  const Interval& now = interval_at(t, hint);
  const double s = t - now.start_s;
  if (now.clipped_axis_sign.isZero(0.0))
    return {now.attitude_jacobian,
            now.position_jacobian + s * now.velocity_jacobian + now.acceleration_jacobian * (0.5 * s * s)};
  const DeficitJacobian gained = saturation_deficit_jacobian_within(now, s);
  const DeficitJacobian turn = -so3::hat(now.specific_force_W_m_s2) * (now.attitude_jacobian + 0.5 * gained);
  return {now.attitude_jacobian + gained, now.position_jacobian + s * now.velocity_jacobian + turn * (0.5 * s * s)};
}

MotionState SweepTrajectory::state(double t_s) const {
  const double t = std::clamp(t_s, 0.0, duration_s_);
  std::size_t hint = 0;
  const Interval& now = interval_at(t, hint);
  const double s = t - now.start_s;
  MotionState state;
  state.time_ns = start_.time_ns + static_cast<TimeNs>(std::llround(t * 1e9));
  state.q_WI = (now.q_WI * so3::exp(now.rate_I_rad_s * s)).normalized();
  state.p_WI_m = gravity_free_position_m(t) + now.preintegrated_position_m + s * now.preintegrated_velocity_m_s +
                 (0.5 * s * s) * now.specific_force_W_m_s2;
  state.v_WI_m_s =
      start_.v_WI_m_s + now.preintegrated_velocity_m_s + s * now.specific_force_W_m_s2 + t * gravity_W_m_s2_;
  const Eigen::Matrix<double, 9, 9> F = transition(t).jacobian_start;
  const Eigen::Matrix<double, 9, 9> P = F * start_.covariance * F.transpose();
  state.covariance = 0.5 * (P + P.transpose());
  return state;
}

/// See mapping.md (R11).
SweepTrajectory::Transition SweepTrajectory::transition(double t_s) const {
  const double t = std::clamp(t_s, 0.0, duration_s_);
  std::size_t hint = 0;
  const Interval& now = interval_at(t, hint);
  const double s = t - now.start_s;
  namespace u = mapping::unknowns;
  Transition out;
  out.jacobian_start.setIdentity();
  u::sub_block(out.jacobian_start, u::position, u::attitude) = -so3::hat(
      now.preintegrated_position_m + s * now.preintegrated_velocity_m_s + (0.5 * s * s) * now.specific_force_W_m_s2);
  u::sub_block(out.jacobian_start, u::position, u::velocity) = t * Eigen::Matrix3d::Identity();
  u::sub_block(out.jacobian_start, u::velocity, u::attitude) =
      -so3::hat(now.preintegrated_velocity_m_s + s * now.specific_force_W_m_s2);

  const SaturationDeficitJacobian deficit = saturation_deficit_jacobian(t, hint);
  const DeficitJacobian mean_attitude = 0.5 * (now.attitude_jacobian + deficit.attitude_by_deficit_s);
  out.jacobian_saturation_deficit_s << deficit.position_jacobian_m_s, deficit.attitude_by_deficit_s,
      now.velocity_jacobian - so3::hat(now.specific_force_W_m_s2) * mean_attitude * s;
  out.jacobian_gravity << 0.5 * t * t * Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(),
      t * Eigen::Matrix3d::Identity();
  return out;
}

}  // namespace tumble
