// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

namespace {

Status check_reading(const Eigen::Vector3d& reading, const char* field) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(reading[axis])) return {ErrorCode::non_finite, field, reading[axis], kReadingMax};
    if (std::abs(reading[axis]) > kReadingMax) return {ErrorCode::out_of_range, field, reading[axis], kReadingMax};
  }
  return {};
}

}  // namespace

Status check_sample(const ImuSample& sample) {
  const Status rate = check_reading(sample.angular_velocity_rad_s, "angular_velocity_rad_s");
  return rate.ok() ? check_reading(sample.specific_force_m_s2, "specific_force_m_s2") : rate;
}

Status check_stamp_order(TimeNs time_ns, TimeNs previous_ns, double gap_max_s) {
  if (time_ns <= previous_ns) {
    return {ErrorCode::time_order, "time_ns", static_cast<double>(time_ns), static_cast<double>(previous_ns)};
  }
  // The subtraction uses unsigned numbers, because the difference of two signed 64-bit time stamps may overflow.
  const std::uint64_t gap_ns = static_cast<std::uint64_t>(time_ns) - static_cast<std::uint64_t>(previous_ns);
  const double gap_s = static_cast<double>(gap_ns) * 1e-9;
  if (gap_s > gap_max_s) return {ErrorCode::gap, "time_s since the last sample", gap_s, gap_max_s};
  return {};
}

Status check_stamp(TimeNs stamp_ns, const char* field) {
  if (stamp_ns >= -kStampMax_ns && stamp_ns <= kStampMax_ns) return {};
  return {ErrorCode::out_of_range, field, static_cast<double>(stamp_ns), static_cast<double>(kStampMax_ns)};
}

Status check_samples(std::span<const ImuSample> samples, double gap_max_s) {
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (const Status status = check_sample(samples[k]); !status.ok()) return status;
    if (k == 0) continue;
    const Status status = check_stamp_order(samples[k].time_ns, samples[k - 1].time_ns, gap_max_s);
    if (!status.ok()) return status;
  }
  return {};
}

PoseState PoseState::transformed_to(const Eigen::Isometry3d& T_AB, const Eigen::Vector3d& w_WA_A_rad_s) const {
  const Eigen::Vector3d arm_A = T_AB.translation(), arm_W = orientation_W * arm_A;
  PoseState out = *this;
  out.position_W_m += arm_W;
  out.orientation_W = orientation_W * Eigen::Quaterniond(T_AB.linear());
  out.velocity_W_m_s += orientation_W * w_WA_A_rad_s.cross(arm_A);
  // An attitude error phi of A displaces the origin of B by phi x arm.
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();
  J.topRightCorner<3, 3>() = -so3::hat(arm_W);
  out.covariance = J * covariance * J.transpose();
  return out;
}

Status check_recording(std::span<const ImuSample> samples, std::size_t count_min, double gap_max_s) {
  if (samples.empty()) return {ErrorCode::empty, "samples", 0.0, 1.0};
  if (samples.size() < count_min) {
    return {ErrorCode::insufficient_data, "samples", static_cast<double>(samples.size()),
            static_cast<double>(count_min)};
  }
  return check_samples(samples, gap_max_s);
}

double median_period_s(std::span<const ImuSample> samples) {
  std::vector<TimeNs> steps(samples.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = samples[k + 1].time_ns - samples[k].time_ns;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return std::clamp(seconds(steps[steps.size() / 2]), 1e-6, 10.0);
}

Status elapsed_time_since_last(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s) {
  if (const Status bad = check_stamp_order(time_ns, last_time_ns, gap_max_s); !bad.ok()) return bad;
  dt_s = seconds(time_ns - last_time_ns);  // gap_max_s limits the difference, so there is no overflow
  return {};
}

}  // namespace tumble

namespace tumble::so3 {

namespace {

// For angles below 1e-4, the first two terms of the power series of sine and cosine are exact except for rounding.
constexpr double kSmallAngle = 1e-4;
// For angles x below 0.5, x - sin(x) loses digits by cancellation. The first seven terms of the power series are exact
// except for rounding.
constexpr double kCancellingAngle = 0.5;

// Returns (1 - cos x) / x^2 by the half-angle formula, which avoids cancellation of digits.
double one_minus_cosine_term(double angle, double angle2) {
  if (angle < kSmallAngle) return 0.5 - angle2 / 24.0;
  const double s = std::sin(0.5 * angle);
  return 2.0 * s * s / angle2;
}

// Returns (x - sin x) / x^3.
double angle_minus_sine_term(double angle, double angle2) {
  if (angle > kCancellingAngle) return (angle - std::sin(angle)) / (angle2 * angle);
  double term = 1.0 / 6.0, sum = 0.0;
  for (int n = 5; n <= 17; n += 2) {
    sum += term;
    term *= -angle2 / ((n - 1) * n);
  }
  return sum;
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond exp(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const double half_sinc = angle < kSmallAngle ? 0.5 - angle2 / 48.0 : std::sin(0.5 * angle) / angle;
  const double w = angle < kSmallAngle ? 1.0 - angle2 / 8.0 : std::cos(0.5 * angle);
  return {w, half_sinc * phi.x(), half_sinc * phi.y(), half_sinc * phi.z()};
}

Eigen::Vector3d logarithm(const Eigen::Quaterniond& q) {
  // For a half turn, the first non-zero component of the result is positive, so that q and -q have the same logarithm.
  double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (q.w() == 0.0) {
    const double lead = q.x() != 0.0 ? q.x() : (q.y() != 0.0 ? q.y() : q.z());
    sign = lead < 0.0 ? -1.0 : 1.0;
  }
  const Eigen::Vector3d v = sign * q.vec();
  const double w = std::abs(q.w());
  const double n = v.norm();
  const double scale = n < kSmallAngle ? 2.0 / w * (1.0 - n * n / (3.0 * w * w)) : 2.0 * std::atan2(n, w) / n;
  return scale * v;
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Eigen::Matrix3d k = hat(phi);
  return Eigen::Matrix3d::Identity() + one_minus_cosine_term(angle, angle2) * k +
         angle_minus_sine_term(angle, angle2) * k * k;
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const double c = angle < kSmallAngle ? 1.0 / 12.0 + angle2 / 720.0
                                       : (1.0 - 0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle)) / angle2;
  const Eigen::Matrix3d k = hat(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * k + c * k * k;
}

Eigen::Quaterniond shortest_arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  // The quaternion (|h| / 2, (from x h) / |h|) with h = from + to is accurate even for nearly opposite vectors.
  const Eigen::Vector3d h = from + to;
  const double length = h.norm();
  if (length < 1e-15) {
    const Eigen::Vector3d axis = from.unitOrthogonal();
    return {0.0, axis.x(), axis.y(), axis.z()};
  }
  const Eigen::Vector3d v = from.cross(h) / length;
  return Eigen::Quaterniond(0.5 * length, v.x(), v.y(), v.z()).normalized();
}

}  // namespace tumble::so3

namespace tumble::detail {

template <>
const char CurrentCompilerSettings::link_time_check = 0;

}  // namespace tumble::detail
