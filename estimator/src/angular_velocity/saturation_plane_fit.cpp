// SPDX-License-Identifier: BSD-3-Clause
#include "saturation_plane_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// prior probability that a long segment of equal readings is a constant rate (spin, turntable) instead of saturation
constexpr double kConstantRateFraction = 0.05;
constexpr double kBendRatioMin = 3.0;
constexpr double kLevelRangeFraction = 0.2;
constexpr std::size_t kNoiseWindow = 9;
constexpr double kNoiseQuantile = 0.2;
// A kink is a change of the clipped axis' slope, while the slopes of other axes remain constant, at the start or end of
// a saturation.
constexpr double kMaxKinkLogLikelihood = 2.5;
constexpr double kMotionSigmasMin = 10.0;
constexpr double kThinLogLikelihoodMin = 8.0;
// The fitted line uses two degrees of freedom, and the partly saturated first and last readings use two more.
constexpr std::size_t kThinLostFreedom = 4;
constexpr double kAtRailSigmas = 4.0, kAtRailRatioMax = 0.006;
constexpr double kBeyondPenalty = 5.0, kOutlierFraction = 0.02;

// See rails.md (R56).
double window_noise(std::span<const Vector3d> window, int axis) {
  double squares = 0.0;
  const std::size_t count = window.size() - 3;
  for (std::size_t i = 0; i < count; ++i) {
    // The third difference of white noise with variance 1 has variance 20.
    const double d = window[i + 3][axis] - 3.0 * window[i + 2][axis] + 3.0 * window[i + 1][axis] - window[i][axis];
    squares += d * d;
  }
  return std::sqrt(squares / (20.0 * static_cast<double>(count)));
}

struct Segment {
  std::size_t first, last;
  std::size_t size() const { return last - first + 1; }
};

Segment next_segment(std::span<const std::size_t> inliers, std::size_t& at) {
  Segment out{inliers[at], inliers[at]};
  for (++at; at < inliers.size() && inliers[at] == out.last + 1; ++at) ++out.last;
  return out;
}

// Returns the log-likelihood ratio of two hypotheses, saturated and unsaturated readings: rails.md (R65). If the device
// clips the sum of rate and noise, saturated readings contain no noise.
double plane_thickness_log_likelihood(const DistinctReadings& readings, const SaturationPlaneCandidate& facet,
                                      const Segment& s) {
  if (s.size() <= kThinLostFreedom) return 0.0;
  const std::size_t first = s.first + 1, count = s.size() - 2;
  const double middle = 0.5 * static_cast<double>(count - 1);
  double mean = 0.0, slope = 0.0, moment = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = facet.row.dot(readings.rates[first + i]), at = static_cast<double>(i) - middle;
    mean += value / static_cast<double>(count);
    slope += value * at;
    moment += at * at;
  }
  slope /= moment;
  for (std::size_t i = 0; i < count; ++i) {
    const double line = mean + slope * (static_cast<double>(i) - middle);
    squares += std::pow(facet.row.dot(readings.rates[first + i]) - line, 2);
  }
  const double free = static_cast<double>(s.size() - kThinLostFreedom),
               digit = readings.min_reading_change[facet.axis] / std::sqrt(12.0);
  const double least = std::max(digit, kEqualReadingsRatio * facet.plane_distance);
  const double noise = std::hypot(readings.noise[facet.axis], digit);
  const double scatter = std::max(least, std::sqrt(squares / free));
  return scatter < noise ? free * (std::log(noise / scatter) - 0.5 * (1.0 - std::pow(scatter / noise, 2))) : 0.0;
}

struct CurvatureAtSegment {
  double curvature_at_ends = 0.0, curvature_in_segment = 0.0;
  bool is_curved_at_ends() const { return curvature_at_ends >= kBendRatioMin * curvature_in_segment; }
};

std::optional<CurvatureAtSegment> curvature_at_segment(const DistinctReadings& readings,
                                                       const SaturationPlaneCandidate& facet, const Segment& s) {
  const std::vector<Vector3d>& rates = readings.rates;
  const auto value = [&](std::size_t k) { return facet.side * facet.row.dot(rates[k]); };
  double depth = std::numeric_limits<double>::max();
  if (s.first >= 2) depth = std::min(depth, facet.plane_distance - value(s.first - 2));
  if (s.last + 2 < rates.size()) depth = std::min(depth, facet.plane_distance - value(s.last + 2));
  if (s.size() < 2 || depth == std::numeric_limits<double>::max()) return std::nullopt;
  double low = std::numeric_limits<double>::max(), high = -low;
  for (std::size_t k = s.first; k <= s.last; ++k) {
    low = std::min(low, value(k));
    high = std::max(high, value(k));
  }
  // See rails.md (R61).
  const double n = static_cast<double>(s.size()), inside = (n - 1.0) / (n + 3.0);
  return CurvatureAtSegment{depth * inside * inside, std::max(high - low, 2.0 * facet.noise_sigma_rad_s)};
}

// Returns the log likelihood of saturation, computed from the change of slope at the start and end of the saturation:
// rails.md (R64).
double end_kink_evidence(const DistinctReadings& readings, const SaturationPlaneCandidate& facet, const Segment& s,
                         bool after) {
  const std::vector<Vector3d>& rates = readings.rates;
  if (s.size() < 3 || (after ? s.last + 3 >= rates.size() : s.first < 3)) return 0.0;
  const double noise = readings.noise[facet.axis];
  const std::size_t end = after ? s.last : s.first;
  const std::size_t outside = after ? end + 2 : end - 2, inside_of = after ? end - 2 : end + 2;
  const Vector3d bent = rates[outside] - 2.0 * rates[end] + rates[inside_of];
  const double own = std::abs(facet.row.dot(bent));
  Vector3d beside = bent, moving = rates[outside] - rates[inside_of];
  beside[facet.axis] = moving[facet.axis] = 0.0;
  if (moving.norm() < kMotionSigmasMin * noise) return 0.0;
  const double ratio = std::max(beside.norm(), 2.0 * noise) / std::max(own, 1e-9);
  return std::clamp(-std::log(5.0 * ratio), -0.5, kMaxKinkLogLikelihood);
}

Eigen::Matrix3d information_of(const DistinctReadings& readings, const SaturationPlaneCandidate& facet,
                               const Segment& s) {
  Vector3d mean = Vector3d::Zero();
  for (std::size_t k = s.first; k <= s.last; ++k) mean += readings.rates[k] / static_cast<double>(s.size());
  Vector3d A;
  A << -facet.side * mean[(facet.axis + 1) % 3], -facet.side * mean[(facet.axis + 2) % 3], 1.0;
  return A * A.transpose() / (facet.noise_sigma_rad_s * facet.noise_sigma_rad_s);
}

}  // namespace

DistinctReadings distinct_readings(std::span<const Vector3d> readings, std::vector<Vector3d>& rates,
                                   std::vector<double>& noises) {
  DistinctReadings out{rates};
  rates.clear();
  out.min_reading_change.setConstant(std::numeric_limits<double>::max());
  for (const Vector3d& y : readings) {
    if (!out.rates.empty() && out.rates.back() == y) continue;
    out.peak = out.peak.cwiseMax(y.cwiseAbs());
    for (int j = 0; j < 3 && !out.rates.empty(); ++j) {
      const double change = std::abs(y[j] - out.rates.back()[j]);
      // The rounding error of a floating-point sum is smaller than any quantisation step of a sensor.
      if (change > 1e-9 * (1.0 + std::abs(y[j])))
        out.min_reading_change[j] = std::min(out.min_reading_change[j], change);
    }
    out.rates.push_back(y);
  }
  for (int j = 0; j < 3; ++j) {
    if (out.min_reading_change[j] == std::numeric_limits<double>::max()) out.min_reading_change[j] = 0.0;
    noises.clear();
    for (std::size_t k = 0; k + kNoiseWindow <= out.rates.size(); k += kNoiseWindow) {
      const std::span<const Vector3d> window = std::span(out.rates).subspan(k, kNoiseWindow);
      const bool clear = std::all_of(window.begin(), window.end(),
                                     [&](const Vector3d& y) { return std::abs(y[j]) < 0.8 * out.peak[j]; });
      if (clear) noises.push_back(window_noise(window, j));
    }
    if (noises.empty()) continue;
    const auto at = static_cast<std::ptrdiff_t>(kNoiseQuantile * static_cast<double>(noises.size() - 1));
    std::nth_element(noises.begin(), noises.begin() + at, noises.end());
    out.noise[j] = noises[static_cast<std::size_t>(at)];
  }
  return out;
}

double plateau_segment_evidence(const DistinctReadings& readings, const Eigen::Matrix2d& slope_information,
                                std::span<const std::size_t> inliers, SaturationPlaneCandidate& facet) {
  const double thickness = 2.5 * facet.noise_sigma_rad_s, noise = readings.noise[facet.axis];
  const double of_level = std::log(kLevelRangeFraction * facet.plane_distance / thickness);
  double odds = 0.0;
  facet.segments = 0;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  H.topLeftCorner<2, 2>() = slope_information;
  for (std::size_t at = 0; at < inliers.size();) {
    const Segment s = next_segment(inliers, at);
    const std::optional<CurvatureAtSegment> shape = curvature_at_segment(readings, facet, s);
    if (!shape) continue;
    const double thin = plane_thickness_log_likelihood(readings, facet, s);
    if (!shape->is_curved_at_ends() && thin < kThinLogLikelihoodMin) continue;
    ++facet.segments;
    odds += std::max(0.0, thin);
    if (!shape->is_curved_at_ends()) continue;
    // See rails.md (R62), (R63).
    const double flatness =
        static_cast<double>(s.size() - 1) * std::log(shape->curvature_at_ends / shape->curvature_in_segment);
    odds += std::min(flatness, -std::log(kConstantRateFraction)) + of_level;
    for (const bool after : {false, true}) odds += end_kink_evidence(readings, facet, s, after);
    H += information_of(readings, facet, s);
  }
  const auto beyond = std::count_if(inliers.begin(), inliers.end(), [&](std::size_t k) {
    return facet.side * facet.row.dot(readings.rates[k]) > facet.plane_distance + facet.plane_tolerance_rad_s;
  });
  odds -= kBeyondPenalty *
          std::max(0.0, static_cast<double>(beyond) - kOutlierFraction * static_cast<double>(inliers.size()));
  if (facet.segments == 0) return -std::numeric_limits<double>::infinity();
  facet.plane_tolerance_rad_s =
      std::max(facet.plane_tolerance_rad_s, std::min(kAtRailSigmas * noise, kAtRailRatioMax * facet.plane_distance));
  // The Occam factor is the ratio of posterior to prior parameter volume: rails.md (R66).
  const Eigen::Matrix3d posterior_covariance = H.inverse();
  const double of_slopes =
      0.5 * std::log(std::max(1.0, 1.0 / (posterior_covariance.topLeftCorner<2, 2>().determinant() *
                                          slope_information.determinant())));
  return odds - of_level - of_slopes;
}

}  // namespace tumble

namespace tumble::rails {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Workspace = SaturationPlaneFinder::Workspace;

constexpr double kGridStep = 0.01;  // step of the search grid over cross-axis sensitivities
constexpr int kRefinements = 10;
constexpr double kSlabDeviations = 4.0, kSlabRatioMin = 2e-4, kSlabRatioMax = 0.006;

/// Returns the top of the readings on a plane, and changes the order of `values`. Some readings may be beyond the
/// plane, because the low-pass filter of a gyro overshoots where a saturation begins.
double top_without_overshoot(std::vector<double>& values) {
  const auto at = static_cast<std::ptrdiff_t>(kOutlierFraction * double(values.size()));
  std::nth_element(values.begin(), values.begin() + at, values.end(), std::greater<>());
  return values[static_cast<std::size_t>(at)];
}

// Stores in `out` the readings that can be on a saturation plane whose cross-axis sensitivities are at most `steepest`.
double candidates(const DistinctReadings& readings, int axis, int sign, double steepest, double slab,
                  std::vector<std::size_t>& out) {
  double sure = -std::numeric_limits<double>::max();
  for (const Vector3d& y : readings.rates) {
    sure = std::max(sure, sign * y[axis] - steepest * other_axes_readings(y, axis).lpNorm<1>());
  }
  out.clear();
  for (std::size_t k = 0; k < readings.rates.size(); ++k) {
    if (highest_value(readings.rates[k], axis, sign, steepest) >= sure - slab) out.push_back(k);
  }
  return sure - slab;
}

void collect_plane_inliers(const DistinctReadings& readings, double from, SaturationPlaneSide& side,
                           Workspace& workspace) {
  workspace.inliers.clear();
  side.gate.row = side.plane.row;
  side.gate.from = from;
  for (const std::size_t k : workspace.near_plane_indices) {
    if (side.side * side.gate.row.dot(readings.rates[k]) >= from) workspace.inliers.push_back(k);
  }
}

// Cauchy weights reduce the effect of partly saturated readings, which are below the plane.
void fit(const DistinctReadings& readings, const PlaneSlopePrior& prior, double deviation,
         SaturationPlaneCandidate& facet, Workspace& workspace) {
  const int axis = facet.axis;
  const Vector3d row = facet.row;
  const double level = facet.plane_distance;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  H.topLeftCorner<2, 2>() = prior.information;
  g.head<2>() = prior.information * prior.cross_axis_slopes;
  const double weight = 1.0 / (deviation * deviation);
  for (const std::size_t k : workspace.inliers) {
    const Vector3d& y = readings.rates[k];
    // The saturation level is linear in the cross-axis sensitivities.
    Vector3d A;
    A << -facet.side * other_axes_readings(y, axis), 1.0;
    const double off = level > 0.0 ? (facet.side * row.dot(y) - level) / deviation : 0.0;
    const double share = weight / (1.0 + off * off);
    H += share * A * A.transpose();
    g += share * A * (facet.side * y[axis]);
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(H);
  const Vector3d x = factor.solve(g);
  facet.row = Vector3d::Zero();
  facet.row[axis] = 1.0;
  facet.row[(axis + 1) % 3] = x[0];
  facet.row[(axis + 2) % 3] = x[1];
  facet.plane_distance = x[2];
  std::vector<double>& residuals = workspace.values;
  residuals.clear();
  for (const std::size_t k : workspace.inliers) {
    residuals.push_back(std::abs(facet.side * facet.row.dot(readings.rates[k]) - facet.plane_distance));
  }
  std::nth_element(residuals.begin(), residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2),
                   residuals.end());
  facet.noise_sigma_rad_s = residuals.empty() ? 0.0 : 1.4826 * residuals[residuals.size() / 2];
}

}  // namespace

std::optional<ExtremeReading> find_extreme_reading(const SaturationPlaneFinder::Params& params,
                                                   const DistinctReadings& readings, int axis, int sign,
                                                   const PlaneSlopePrior& prior, double slope_range,
                                                   Workspace& workspace) {
  double peak = 0.0;
  for (const Vector3d& y : readings.rates) peak = std::max(peak, sign * y[axis]);
  if (peak < 0.5 * params.distance_min_rad_s) return std::nullopt;
  const double steepest = slope_range + prior.cross_axis_slopes.lpNorm<Eigen::Infinity>() + kGridStep;
  ExtremeReading out{axis, sign,
                     std::max({0.002 * peak, 4.0 * readings.noise[axis], 3.0 * readings.min_reading_change[axis]}),
                     steepest};
  out.near_readings_min =
      candidates(readings, axis, sign, steepest, 2.0 * out.slab_thickness, workspace.near_plane_indices);
  return out;
}

Vector2d search_cross_axis_slopes(const DistinctReadings& readings, const ExtremeReading& extreme, double slope_max,
                                  const PlaneSlopePrior& prior, Workspace& workspace) {
  const std::vector<std::size_t>& near = workspace.near_plane_indices;
  const int axis = extreme.axis;
  const int steps = static_cast<int>(std::floor(slope_max / kGridStep + 1e-9));
  Vector2d best = prior.cross_axis_slopes;
  double highest = -std::numeric_limits<double>::max();
  std::vector<double>& values = workspace.values;
  values.resize(near.size());
  for (int a = -steps; a <= steps; ++a) {
    for (int b = -steps; b <= steps; ++b) {
      const Vector2d slopes = prior.cross_axis_slopes + kGridStep * Vector2d(a, b);
      if (slopes.lpNorm<Eigen::Infinity>() > slope_max + kGridStep) continue;
      for (std::size_t i = 0; i < near.size(); ++i) {
        const Vector3d& y = readings.rates[near[i]];
        values[i] = extreme.side * (y[axis] + slopes.dot(other_axes_readings(y, axis)));
      }
      const double from = top_without_overshoot(values) - extreme.slab_thickness;
      const auto count = std::count_if(values.begin(), values.end(), [&](double v) { return v >= from; });
      const Vector2d off = slopes - prior.cross_axis_slopes;
      const double score = static_cast<double>(count) - 0.5 * off.dot(prior.information * off);
      if (!(score > highest)) continue;
      highest = score;
      best = slopes;
    }
  }
  return best;
}

SaturationPlaneSide fit_saturation_plane(const DistinctReadings& readings, const ExtremeReading& extreme,
                                         const PlaneSlopePrior& prior, const Vector2d& slopes, double deviation,
                                         Workspace& workspace) {
  const int axis = extreme.axis;
  SaturationPlaneSide side{axis, extreme.side, {}, {}};
  side.gate.max_cross_axis_slope = extreme.max_cross_axis_slope;
  side.gate.near_readings_min = extreme.near_readings_min;
  SaturationPlaneCandidate& facet = side.plane;
  facet.axis = axis;
  facet.side = extreme.side;
  facet.row[axis] = 1.0;
  facet.row[(axis + 1) % 3] = slopes[0];
  facet.row[(axis + 2) % 3] = slopes[1];
  std::vector<double>& values = workspace.values;
  values.clear();
  for (const std::size_t k : workspace.near_plane_indices)
    values.push_back(facet.side * facet.row.dot(readings.rates[k]));
  collect_plane_inliers(readings, top_without_overshoot(values) - extreme.slab_thickness, side, workspace);
  double floor = readings.min_reading_change[axis];
  facet.plane_tolerance_rad_s = extreme.slab_thickness;
  for (int i = 0; i < kRefinements && !workspace.inliers.empty(); ++i) {
    fit(readings, prior, deviation, facet, workspace);
    floor = std::max(kSlabRatioMin * facet.plane_distance, readings.min_reading_change[axis]);
    deviation = std::max(facet.noise_sigma_rad_s, 0.25 * floor);
    facet.plane_tolerance_rad_s =
        std::clamp(kSlabDeviations * deviation, floor, std::max(floor, kSlabRatioMax * facet.plane_distance));
    collect_plane_inliers(readings, facet.plane_distance - facet.plane_tolerance_rad_s, side, workspace);
  }
  side.samples = static_cast<int>(workspace.inliers.size());
  if (workspace.inliers.empty()) return side;
  fit(readings, prior, deviation, facet, workspace);
  facet.noise_sigma_rad_s = std::max(facet.noise_sigma_rad_s, 0.25 * floor);
  return side;
}

}  // namespace tumble::rails
