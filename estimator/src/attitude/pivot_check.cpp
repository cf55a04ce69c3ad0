// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/pivot_check.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

/// PivotMotionFit is a fitted rotation about a body point (pivot) that moves at constant velocity: imu_merge.md (I27).
struct PivotMotionFit {
  double residual_m_s = 0.0;  ///< root mean square of the components of the unexplained velocity
  double gravity_m_s2 = 0.0;  ///< magnitude of the fitted specific force that is constant in world axes
  double arm_m = 0.0;         ///< distance from the pivot to the IMU
};

class PivotMotionSums {
 public:
  /// `at_s` is the time from the start of the first reading to the middle of the added reading. Cost: O(1).
  void add(double at_s, double dt_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2) {
    const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * rate_rad_s);
    const Eigen::Quaterniond middle = rotation_ * half;
    const Eigen::Vector3d gained = dt_s * (middle * force_m_s2);
    const Eigen::Vector3d velocity = velocity_ + 0.5 * gained;
    velocity_ += gained;
    rotation_ = (middle * half).normalized();
    const Eigen::Matrix3d by_arm = middle.toRotationMatrix() * so3::hat(rate_rad_s);
    sample_count_ += 1.0;
    time_sum_ += at_s;
    squared_time_sum_ += at_s * at_s;
    squared_velocity_sum_ += velocity.squaredNorm();
    arm_jacobian_sum_ += by_arm;
    time_arm_jacobian_sum_ += at_s * by_arm;
    squared_arm_jacobian_sum_ += by_arm.transpose() * by_arm;
    velocity_sum_ += velocity;
    time_velocity_sum_ += at_s * velocity;
    arm_velocity_sum_ += by_arm.transpose() * velocity;
  }

  PivotMotionFit fit() const {
    constexpr double kArm = 0.01;  // regularisation [s^-2] that keeps the lever arm short if the body hardly rotates
    using Nine = Eigen::Matrix<double, 9, 1>;
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 9, 9> normal;
    normal << squared_time_sum_ * one, time_arm_jacobian_sum_, time_sum_ * one, time_arm_jacobian_sum_.transpose(),
        squared_arm_jacobian_sum_ + kArm * one, arm_jacobian_sum_.transpose(), time_sum_ * one, arm_jacobian_sum_,
        sample_count_ * one;
    Nine right;
    right << time_velocity_sum_, arm_velocity_sum_, velocity_sum_;
    const Nine x = normal.ldlt().solve(right);
    const double left = std::max(0.0, squared_velocity_sum_ - x.dot(right));
    return {std::sqrt(left / std::max(1.0, sample_count_)), x.head<3>().norm(), x.segment<3>(3).norm()};
  }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  /// time integral of the specific force, in sensor axes at the start
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  double sample_count_ = 0.0, time_sum_ = 0.0, squared_time_sum_ = 0.0, squared_velocity_sum_ = 0.0;
  Eigen::Matrix3d arm_jacobian_sum_ = Eigen::Matrix3d::Zero(), time_arm_jacobian_sum_ = Eigen::Matrix3d::Zero(),
                  squared_arm_jacobian_sum_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d velocity_sum_ = Eigen::Vector3d::Zero(), time_velocity_sum_ = Eigen::Vector3d::Zero(),
                  arm_velocity_sum_ = Eigen::Vector3d::Zero();
};

/// AxisLabels assigns the axes of an accelerometer to the axes of the gyro in the same IMU. While the body rotates, the
/// gyro predicts the rotation of the measured gravity correctly only with the correct axis labels. The rotation of
/// gravity cannot reveal that all three axes of the accelerometer are inverted. AxisLabels describes only rotations by
/// multiples of a right angle.
struct AxisLabels {
  std::array<int, 3> axis = {0, 1, 2};              ///< index of the accelerometer reading along x, y, z of the gyro
  std::array<double, 3> axis_signs = {1., 1., 1.};  ///< sign of each axis; the first sign is 1
  bool all_rates_inverted = false;

  Eigen::Vector3d in_corrected_axes(const Eigen::Vector3d& force) const {
    return {axis_signs[0] * force[axis[0]], axis_signs[1] * force[axis[1]], axis_signs[2] * force[axis[2]]};
  }
};

constexpr int kAxisLabels = 48;

constexpr std::array<std::array<int, 3>, 6> kOrders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

constexpr std::array<AxisLabels, kAxisLabels> all_axis_labels() {
  std::array<AxisLabels, kAxisLabels> out;
  std::size_t k = 0;
  for (const bool gyro_flipped : {false, true}) {
    for (const std::array<int, 3>& order : kOrders) {
      for (const double second : {1.0, -1.0}) {
        for (const double third : {1.0, -1.0}) out[k++] = {order, {1.0, second, third}, gyro_flipped};
      }
    }
  }
  return out;
}

// Index 0 is the identity.
constexpr std::array<AxisLabels, kAxisLabels> kAllAxisLabels = all_axis_labels();

constexpr double kPivotReading_s =
    0.01;                           // averaging time of readings, so that the cost is independent of the sample rate
constexpr double kSegment_s = 2.0;  // a person holds a pivot still for about 2 s
constexpr double kSegmentRotationMin_rad = 1.0;  // with less rotation, a segment cannot distinguish the gyro hypotheses
// largest rms velocity of the fitted pivot for which a time segment is used
constexpr double kExplained_m_s = 0.3;
// rms pivot velocity due to noise; below this velocity, the check does not prefer one gyro hypothesis to another
constexpr double kPivotNoise_m_s = 0.03;
constexpr double kSegmentGapMax_s = 0.1;  // an impact may hide in a longer data gap
// Successive time segments overlap by half, so six segments contain as much information as three independent segments.
constexpr double kEvidenceMin = 5.0, kMeanEvidenceMin = 0.6, kBetterSegmentsMin = 6.0, kBetterWorseRatioMin = 4.0;
// For a longer lever arm between pivot and IMU, an error of the lever arm could be mistaken for a gyro scale error.
constexpr double kPivotDistanceMax_m = 0.25;
constexpr double kScaleErrorMin = 0.025, kScaleErrorMinSigmas = 5.0;
constexpr double kScaleSegmentsMin = 10.0, kScaleSegmentFractionMin = 0.5;
constexpr double kScaleStep = 0.05;
constexpr std::size_t kHalf = kAxisLabels, kTwice = kAxisLabels + 1;  // indices of the gyro scales 1/2 and 2
constexpr std::size_t kLower = kAxisLabels + 2, kUpper = kAxisLabels + 3, kReadings = kAxisLabels + 4;
// number of compared gyro hypotheses, excluding the small scale changes kLower and kUpper
constexpr std::size_t kCompared = kLower;
// A gyro hypothesis is a possible gyro fault, for example swapped axes or a wrong scale. A time segment favours a gyro
// hypothesis if correcting the fault reduces the logarithm of the squared velocity residual by more than
// kClearLogRatio.
constexpr double kClearLogRatio = 0.4;

using Readings = std::array<Eigen::Matrix3d, kReadings>;

/// Returns matrices that correct the measured rates for possible gyro faults (swapped axes, wrong signs, wrong scale):
/// imu_merge.md (I27).
Readings all_readings() {
  Readings out;
  for (std::size_t k = 0; k < kAxisLabels; ++k) {
    const AxisLabels& labels = kAllAxisLabels[k];
    Eigen::Matrix3d renaming;
    for (int axis = 0; axis < 3; ++axis) renaming.col(axis) = labels.in_corrected_axes(Eigen::Vector3d::Unit(axis));
    out[k] = (labels.all_rates_inverted ? -1.0 : 1.0) * renaming.determinant() * renaming.transpose();
  }
  out[kHalf] = 0.5 * Eigen::Matrix3d::Identity();
  out[kTwice] = 2.0 * Eigen::Matrix3d::Identity();
  out[kLower] = (1.0 - kScaleStep) * Eigen::Matrix3d::Identity();
  out[kUpper] = (1.0 + kScaleStep) * Eigen::Matrix3d::Identity();
  return out;
}

/// `scale_step` is the estimate of the gyro scale minus 1 from one time segment, computed with one Newton step.
/// `weight` is the second derivative of the squared velocity residual with respect to the scale, divided by the squared
/// residual.
struct GyroScaleVote {
  double scale_step, weight;
};

class Segments {
 public:
  Segments(double gravity_m_s2, const Readings& readings) : gravity_m_s2_(gravity_m_s2), readings_(readings) {}

  void add(double dt_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2) {
    for (std::size_t k = 0; k < kReadings; ++k) {
      sums_[k].add(length_s_ + 0.5 * dt_s, dt_s, readings_[k] * rate_rad_s, force_m_s2);
    }
    length_s_ += dt_s;
    rotated_rad_ += dt_s * rate_rad_s.norm();
    if (length_s_ >= kSegment_s) close_segment();
  }
  void close_segment() {
    if (length_s_ >= 0.5 * kSegment_s && rotated_rad_ >= kSegmentRotationMin_rad) process_segment();
    sums_ = {};
    length_s_ = rotated_rad_ = 0.0;
  }

  std::array<double, kCompared> log_evidence{};
  std::array<std::size_t, kCompared> compared_segment_count{}, better_segment_count{}, worse_segment_count{};
  std::vector<GyroScaleVote> gyro_scale_votes;
  std::size_t unchanged_explained_count = 0;

 private:
  void process_segment() {
    std::array<PivotMotionFit, kReadings> fits;
    std::transform(sums_.begin(), sums_.end(), fits.begin(), [](const PivotMotionSums& sums) { return sums.fit(); });
    compare_alternatives(fits);
    vote_on_gyro_scale(fits);
  }

  /// See imu_merge.md (I28), (I29).
  void compare_alternatives(const std::array<PivotMotionFit, kReadings>& fits) {
    const auto residual = [&](std::size_t k) {
      return std::hypot(fits[k].residual_m_s, length_s_ * (fits[k].gravity_m_s2 - gravity_m_s2_) / std::sqrt(12.0));
    };
    const double unchanged_residual = residual(0);
    for (std::size_t k = 1; k < kCompared; ++k) {
      const double otherwise = residual(k);
      if (std::min(unchanged_residual, otherwise) > kExplained_m_s) continue;
      const double gained =
          2.0 * std::log(std::max(unchanged_residual, kPivotNoise_m_s) / std::max(otherwise, kPivotNoise_m_s));
      log_evidence[k] += gained;
      ++compared_segment_count[k];
      better_segment_count[k] += gained > kClearLogRatio;
      worse_segment_count[k] += gained < -kClearLogRatio;
    }
  }

  /// See imu_merge.md (I30).
  void vote_on_gyro_scale(const std::array<PivotMotionFit, kReadings>& fits) {
    const PivotMotionFit& fit = fits[0];
    if (fit.residual_m_s > kExplained_m_s) return;
    ++unchanged_explained_count;
    if (fit.arm_m > kPivotDistanceMax_m) return;
    const auto square = [&](std::size_t k) { return fits[k].residual_m_s * fits[k].residual_m_s; };
    const double curvature = (square(kLower) + square(kUpper) - 2.0 * square(0)) / (kScaleStep * kScaleStep);
    if (!(curvature > 0.0)) return;
    const double step = -(square(kUpper) - square(kLower)) / (2.0 * kScaleStep) / curvature;
    gyro_scale_votes.push_back({step, curvature / std::max(square(0), kPivotNoise_m_s * kPivotNoise_m_s)});
  }

  double gravity_m_s2_;
  const Readings& readings_;
  std::array<PivotMotionSums, kReadings> sums_{};
  double length_s_ = 0.0, rotated_rad_ = 0.0;
};

/// Computes the gyro scale, with a heteroscedasticity-consistent standard deviation (White, 1980): imu_merge.md (I30).
void conclude_gyro_scale(const std::vector<GyroScaleVote>& votes, PivotMotionCheck& found) {
  double weight = 0.0, sum = 0.0, spread = 0.0;
  for (const GyroScaleVote& vote : votes) weight += vote.weight, sum += vote.weight * vote.scale_step;
  found.gyro_scale_segments = votes.size();
  if (votes.size() < 2) return;
  const double step = sum / weight;
  for (const GyroScaleVote& vote : votes) {
    const double off = vote.weight * (vote.scale_step - step);
    spread += off * off;
  }
  found.scale = 1.0 + step;
  found.scale_sigma = std::sqrt(2.0 * spread) / weight;  // the segments overlap, so each sample counts twice
}

}  // namespace

PivotMotionCheck PivotMotionCheck::of(std::span<const ImuSample> samples, double gravity_m_s2, double gyro_range_rad_s,
                                      double accel_range_m_s2) {
  static const Readings readings = all_readings();
  // The recording is divided twice into time segments, the second time shifted by half a segment. An impact at the end
  // of a segment in one division is inside a segment of the other division.
  std::array<Segments, 2> series = {Segments(gravity_m_s2, readings), Segments(gravity_m_s2, readings)};
  double mean_s = 0.0, since_s = 0.0;
  Eigen::Vector3d turned = Eigen::Vector3d::Zero(), gained = Eigen::Vector3d::Zero();
  const auto is_at_rail = [](const Eigen::Vector3d& measured, double range) {
    return range > 0.0 && measured.cwiseAbs().maxCoeff() >= (1.0 - kNearRailRatio) * range;
  };
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const Eigen::Vector3d &rate = samples[k].angular_velocity_rad_s, &force = samples[k].specific_force_m_s2;
    const double dt_s = seconds(samples[k].time_ns - samples[k - 1].time_ns);
    if (dt_s <= 0.0) continue;
    if (dt_s > kSegmentGapMax_s || is_at_rail(rate, gyro_range_rad_s) || is_at_rail(force, accel_range_m_s2) ||
        samples[k].device_clip_flags != 0 || !check_sample(samples[k]).ok()) {
      for (Segments& segments : series) segments.close_segment();
      mean_s = since_s = 0.0;
      turned.setZero(), gained.setZero();
      continue;
    }
    mean_s += dt_s;
    turned += dt_s * rate;
    gained += dt_s * force;
    if (mean_s < kPivotReading_s - 0.5 * dt_s) continue;
    since_s += mean_s;
    series[0].add(mean_s, turned / mean_s, gained / mean_s);
    if (since_s > 0.5 * kSegment_s) series[1].add(mean_s, turned / mean_s, gained / mean_s);
    mean_s = 0.0;
    turned.setZero(), gained.setZero();
  }
  for (Segments& segments : series) segments.close_segment();

  PivotMotionCheck found;
  for (std::size_t k = 1; k < kCompared; ++k) {
    const double evidence = series[0].log_evidence[k] + series[1].log_evidence[k];
    if (found.reading != 0 && evidence <= found.log_evidence) continue;
    found.reading = static_cast<int>(k);
    found.log_evidence = evidence;
    found.comparable_segments = series[0].compared_segment_count[k] + series[1].compared_segment_count[k];
    found.better_explained_segments = series[0].better_segment_count[k] + series[1].better_segment_count[k];
    found.worse_explained_segments = series[0].worse_segment_count[k] + series[1].worse_segment_count[k];
  }
  std::vector<GyroScaleVote> votes = std::move(series[0].gyro_scale_votes);
  votes.insert(votes.end(), series[1].gyro_scale_votes.begin(), series[1].gyro_scale_votes.end());
  conclude_gyro_scale(votes, found);
  found.segments_explained_unchanged = series[0].unchanged_explained_count + series[1].unchanged_explained_count;
  return found;
}

/// See imu_merge.md (I29), (I30).
Status PivotMotionCheck::verdict() const {
  const double least = std::max(kEvidenceMin, kMeanEvidenceMin * static_cast<double>(comparable_segments));
  const auto better = static_cast<double>(better_explained_segments),
             worse = static_cast<double>(worse_explained_segments);
  if (log_evidence > least && better >= kBetterSegmentsMin && better >= kBetterWorseRatioMin * worse) {
    return {ErrorCode::out_of_range, "evidence from rotation about a pivot for other axes, signs or scale of the gyro",
            log_evidence, least};
  }
  const double off = std::abs(scale - 1.0);
  const double bound = std::max(kScaleErrorMin, kScaleErrorMinSigmas * scale_sigma);
  const double better_segments_min =
      std::max(kScaleSegmentsMin, kScaleSegmentFractionMin * static_cast<double>(segments_explained_unchanged));
  if (static_cast<double>(gyro_scale_segments) >= better_segments_min && off > bound) {
    return {ErrorCode::out_of_range, "scale of the gyro estimated from rotation about a pivot", scale,
            scale < 1.0 ? 1.0 - bound : 1.0 + bound};
  }
  return {};
}

}  // namespace tumble
