// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/pivot_check.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pivot_sums.hpp"
#include "tumble/angular_velocity/detail/rail_ratios.hpp"
#include "tumble/attitude/detail/axis_labels.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

namespace {

constexpr double kScaleStep = 0.05;
constexpr std::size_t kHalf = kAxisLabels, kTwice = kAxisLabels + 1;  // indices of the gyro scales 1/2 and 2
constexpr std::size_t kLower = kAxisLabels + 2, kUpper = kAxisLabels + 3, kReadings = kAxisLabels + 4;
constexpr std::size_t kCompared = kLower;  // number of hypotheses that differ clearly from the unchanged rates
// minimum logarithm of the ratio of two squared residuals for a clear decision
constexpr double kClearLogRatio = 0.4;

using Readings = std::array<Eigen::Matrix3d, kReadings>;

/// Returns the matrices S by which each hypothesis about the gyro multiplies the rates: imu_merge.md (I27).
Readings all_readings() {
  Readings out;
  for (std::size_t k = 0; k < kAxisLabels; ++k) {
    const AxisLabels& labels = axis_labels()[k];
    Eigen::Matrix3d renaming;
    for (int axis = 0; axis < 3; ++axis) renaming.col(axis) = labels.relabelled(Eigen::Vector3d::Unit(axis));
    out[k] = (labels.gyro_flipped ? -1.0 : 1.0) * renaming.determinant() * renaming.transpose();
  }
  out[kHalf] = 0.5 * Eigen::Matrix3d::Identity();
  out[kTwice] = 2.0 * Eigen::Matrix3d::Identity();
  out[kLower] = (1.0 - kScaleStep) * Eigen::Matrix3d::Identity();
  out[kUpper] = (1.0 + kScaleStep) * Eigen::Matrix3d::Identity();
  return out;
}

/// ScaleVote is the estimate of the gyro's scale from one segment of motion. `step` is the Newton step from scale 1.
/// `weight` is the second derivative of the residual with respect to the scale, at scale 1.
struct ScaleVote {
  double step, weight;
};

/// Segments contains the results of the completed segments of a recording, and the sums of the current segment.
class Segments {
 public:
  Segments(const PivotCheckParams& params, const Readings& readings) : params_(params), readings_(readings) {}

  void add(double dt_s, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2) {
    for (std::size_t k = 0; k < kReadings; ++k) {
      sums_[k].add(length_s_ + 0.5 * dt_s, dt_s, readings_[k] * rate_rad_s, force_m_s2);
    }
    length_s_ += dt_s;
    rotated_rad_ += dt_s * rate_rad_s.norm();
    if (length_s_ >= params_.segment_s) close();
  }
  /// Completes the current segment of motion. A segment that is shorter than half of the nominal length is discarded.
  void close() {
    if (length_s_ >= 0.5 * params_.segment_s && rotated_rad_ >= params_.rotation_min_rad) take();
    sums_ = {};
    length_s_ = rotated_rad_ = 0.0;
  }

  std::array<double, kCompared> evidence{};
  std::array<std::size_t, kCompared> counted{}, better{}, worse{};
  std::vector<ScaleVote> votes;
  std::size_t explained = 0;  // number of segments that the unchanged rates explain

 private:
  void take() {
    std::array<PivotFit, kReadings> fits;
    std::transform(sums_.begin(), sums_.end(), fits.begin(), [](const PivotSums& sums) { return sums.fit(); });
    compare(fits);
    vote(fits);
  }

  /// Compares how well the unchanged gyro and each hypothesis about a wrong gyro explain a segment: imu_merge.md (I28),
  /// (I29).
  void compare(const std::array<PivotFit, kReadings>& fits) {
    // The residual of a hypothesis has two parts: the unexplained velocity, and the difference between mean force and
    // gravity.
    const auto residual = [&](std::size_t k) {
      return std::hypot(fits[k].residual_m_s,
                        length_s_ * (fits[k].gravity_m_s2 - params_.gravity_m_s2) / std::sqrt(12.0));
    };
    const double unchanged_residual = residual(0);
    for (std::size_t k = 1; k < kCompared; ++k) {
      const double otherwise = residual(k);
      if (std::min(unchanged_residual, otherwise) > params_.explained_rms_m_s) continue;
      const double noise = params_.noise_m_s;
      const double gained = 2.0 * std::log(std::max(unchanged_residual, noise) / std::max(otherwise, noise));
      evidence[k] += gained;
      ++counted[k];
      better[k] += gained > kClearLogRatio;
      worse[k] += gained < -kClearLogRatio;
    }
  }

  /// Adds the segment's estimate of the gyro's scale: imu_merge.md (I30).
  void vote(const std::array<PivotFit, kReadings>& fits) {
    const PivotFit& fit = fits[0];
    if (fit.residual_m_s > params_.explained_rms_m_s) return;
    ++explained;
    if (fit.arm_m > params_.pivot_distance_max_m) return;
    const auto square = [&](std::size_t k) { return fits[k].residual_m_s * fits[k].residual_m_s; };
    const double curvature = (square(kLower) + square(kUpper) - 2.0 * square(0)) / (kScaleStep * kScaleStep);
    if (!(curvature > 0.0)) return;
    const double step = -(square(kUpper) - square(kLower)) / (2.0 * kScaleStep) / curvature;
    votes.push_back({step, curvature / std::max(square(0), params_.noise_m_s * params_.noise_m_s)});
  }

  const PivotCheckParams& params_;
  const Readings& readings_;
  std::array<PivotSums, kReadings> sums_{};
  double length_s_ = 0.0, rotated_rad_ = 0.0;
};

/// Computes the weighted mean of the segments' gyro scales, with a heteroscedasticity-consistent standard deviation
/// (White, 1980): imu_merge.md (I30).
void conclude_scale(const std::vector<ScaleVote>& votes, PivotCheck::Found& found) {
  double weight = 0.0, sum = 0.0, spread = 0.0;
  for (const ScaleVote& vote : votes) weight += vote.weight, sum += vote.weight * vote.step;
  found.scale_segments = votes.size();
  if (votes.size() < 2) return;
  const double step = sum / weight;
  for (const ScaleVote& vote : votes) {
    const double off = vote.weight * (vote.step - step);
    spread += off * off;
  }
  found.scale = 1.0 + step;
  found.scale_sigma = std::sqrt(2.0 * spread) / weight;  // each moment belongs to two segments
}

}  // namespace

PivotCheck::PivotCheck(const Params& params) : params_(params) {
  require_valid_fields(params);
}

PivotCheck::Found PivotCheck::find(std::span<const ImuSample> samples, std::span<const RateState> rates) const {
  static const Readings readings = all_readings();
  // The check divides the recording twice into segments, offset by half a segment. An event at a boundary between two
  // segments is therefore inside a segment of the other division.
  std::array<Segments, 2> series = {Segments(params_, readings), Segments(params_, readings)};
  double mean_s = 0.0, since_s = 0.0;
  Eigen::Vector3d turned = Eigen::Vector3d::Zero(), gained = Eigen::Vector3d::Zero();
  const double rail_m_s2 = (1.0 - kNearRailRatio) * params_.accel_range_m_s2;
  for (std::size_t k = 1; k < std::min(samples.size(), rates.size()); ++k) {
    const Eigen::Vector3d& force = samples[k].specific_force_m_s2;
    const double dt_s = seconds(samples[k].time_ns - samples[k - 1].time_ns);
    if (dt_s <= 0.0) continue;
    const bool at_rail = (rail_m_s2 > 0.0 && force.cwiseAbs().maxCoeff() >= rail_m_s2) ||
                         (samples[k].device_clip_flags & kClipAccel) != 0;
    if (dt_s > params_.gap_max_s || at_rail || rates[k].source != RateSource::measured ||
        !check_sample(samples[k]).ok()) {
      for (Segments& segments : series) segments.close();
      mean_s = since_s = 0.0;
      turned.setZero(), gained.setZero();
      continue;
    }
    mean_s += dt_s;
    turned += dt_s * rates[k].w_WI_I_rad_s;
    gained += dt_s * force;
    if (mean_s < params_.reading_s - 0.5 * dt_s) continue;
    since_s += mean_s;
    series[0].add(mean_s, turned / mean_s, gained / mean_s);
    if (since_s > 0.5 * params_.segment_s) series[1].add(mean_s, turned / mean_s, gained / mean_s);
    mean_s = 0.0;
    turned.setZero(), gained.setZero();
  }
  for (Segments& segments : series) segments.close();

  Found found;
  for (std::size_t k = 1; k < kCompared; ++k) {
    const double evidence = series[0].evidence[k] + series[1].evidence[k];
    if (found.reading != 0 && evidence <= found.evidence) continue;
    found.reading = static_cast<int>(k);
    found.evidence = evidence;
    found.compared_segments = series[0].counted[k] + series[1].counted[k];
    found.better_segments = series[0].better[k] + series[1].better[k];
    found.worse_segments = series[0].worse[k] + series[1].worse[k];
  }
  std::vector<ScaleVote> votes = std::move(series[0].votes);
  votes.insert(votes.end(), series[1].votes.begin(), series[1].votes.end());
  conclude_scale(votes, found);
  found.explained_segments = series[0].explained + series[1].explained;
  return found;
}

/// Returns an error if the evidence for a wrong gyro scale or axis exceeds its limits: imu_merge.md (I29), (I30).
Status PivotCheck::verdict(const Found& found) const {
  const double least =
      std::max(params_.evidence_min, params_.mean_evidence_min * static_cast<double>(found.compared_segments));
  const auto better = static_cast<double>(found.better_segments), worse = static_cast<double>(found.worse_segments);
  if (found.evidence > least && better >= params_.better_segments_min &&
      better >= params_.better_worse_ratio_min * worse) {
    return {ErrorCode::out_of_range, "evidence for other axes, signs or scale of the gyro, from rotation about a pivot",
            found.evidence, least};
  }
  const double off = std::abs(found.scale - 1.0);
  const double bound = std::max(params_.scale_error_min, params_.scale_error_min_sigmas * found.scale_sigma);
  const double better_segments_min = std::max(
      params_.scale_segments_min, params_.scale_segment_fraction_min * static_cast<double>(found.explained_segments));
  if (static_cast<double>(found.scale_segments) >= better_segments_min && off > bound) {
    return {ErrorCode::out_of_range, "scale of the gyro estimated from rotation about a pivot", found.scale,
            found.scale < 1.0 ? 1.0 - bound : 1.0 + bound};
  }
  return {};
}

}  // namespace tumble
