// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "saturation_plane_fit.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using rails::other_axes_readings;
using rails::PlaneInlierGate;
using rails::PlaneSlopePrior;
using rails::SaturationPlaneSide;

// Each saturation plane (SaturationPlane) is fitted with two different initial standard deviations of the distance
// between reading and plane. kInitialSigmaRatios contains the two standard deviations as fractions of
// ExtremeReading::slab_thickness. If few readings are partly saturated, the fit with the smaller initial standard
// deviation is better.
constexpr double kInitialSigmaRatios[] = {0.5, 0.02};
constexpr double kElementLevelRatio = 0.04;
constexpr double kNearElementLogOdds = 5.0, kNearStatedLogOdds = 3.0, kOppositeSignLogOdds = 5.0,
                 kImpossibleLogOdds = -100.0;
// If a saturation level is far from the level of an earlier run, the log odds decrease only by kFarFromKnownLogOdds,
// because the device may have been replaced.
constexpr double kNearKnownLogOdds = 6.0, kKnownLevelSigmaRatio = 0.003, kFarFromKnownLogOdds = -3.0;
// standard deviation of the change of a cross-axis sensitivity between two runs
constexpr double kKnownSlopeSigma = 2e-3;

double gaussian_log_ratio(double value, double sigma) {
  const double z = value / sigma;
  return std::max(kImpossibleLogOdds, -0.5 * z * z);
}

// See rails.md (R67).
double equal_limits_log_odds(const SaturationPlaneFinder::Params& params, const DistinctReadings& readings,
                             const SaturationPlanes& known, const SaturationPlaneSide& side) {
  const double level = side.plane.plane_distance;
  double odds = params.kLogOddsBefore;
  if (level < params.distance_min_rad_s) return kImpossibleLogOdds;
  for (int other = 0; other < 3; ++other) {
    const auto& rail = known.sensing_axis[static_cast<std::size_t>(other)];
    if (rail && other == side.axis) {
      odds += kOppositeSignLogOdds +
              gaussian_log_ratio(level - rail->saturation_limit_rad_s, params.kOffsetSigmaRatio * level);
    } else if (rail) {
      odds += kNearElementLogOdds +
              gaussian_log_ratio(level - rail->saturation_limit_rad_s, 2.0 * params.kOffsetSigmaRatio * level);
    }
    if (other == side.axis) continue;
    const double beyond = readings.peak[other] / level - 1.0 - kElementLevelRatio;
    if (beyond > 0.0) odds += gaussian_log_ratio(beyond, params.kOffsetSigmaRatio);
  }
  if (const auto& rail = params.known_limits.sensing_axis[static_cast<std::size_t>(side.axis)]) {
    const double apart = level - rail->saturation_limit_rad_s - side.side * rail->offset_rad_s;
    odds +=
        std::max(kFarFromKnownLogOdds, kNearKnownLogOdds + gaussian_log_ratio(apart, kKnownLevelSigmaRatio * level));
  }
  if (params.stated_range_rad_s) {
    const double ratio = level / *params.stated_range_rad_s;
    odds += ratio < kStatedRailMin ? kImpossibleLogOdds : ratio < 1.05 && ratio > 0.95 ? kNearStatedLogOdds : 0.0;
  }
  return odds;
}

// See rails.md (R53).
SaturationPlane merged_plane(const SaturationPlaneFinder::Params& params, const DistinctReadings& readings,
                             const SaturationPlaneSide* minus, const SaturationPlaneSide* plus) {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  Eigen::Vector4d g = Eigen::Vector4d::Zero();
  const int axis = (plus != nullptr ? plus : minus)->axis;
  const double level = (plus != nullptr ? plus : minus)->plane.plane_distance;
  const double slope_information = 1.0 / (params.kSlopeSigma * params.kSlopeSigma);
  H.diagonal() << slope_information, slope_information, 0.0, 1.0 / std::pow(params.kOffsetSigmaRatio * level, 2);
  SaturationPlane out;
  double squares = 0.0, weights = 0.0;
  for (const SaturationPlaneSide* side : {minus, plus}) {
    if (side == nullptr) continue;
    const double variance = side->plane.noise_sigma_rad_s * side->plane.noise_sigma_rad_s;
    const PlaneInlierGate& gate = side->gate;
    for (const Vector3d& y : readings.rates) {
      if (!(side->side * gate.row.dot(y) >= gate.from)) continue;
      if (!(rails::highest_value(y, axis, side->side, gate.max_cross_axis_slope) >= gate.near_readings_min)) continue;
      // A saturated reading is a linear function of saturation level, offset and cross-axis sensitivities: rails.md
      // (R59).
      Eigen::Vector4d A;
      A << -other_axes_readings(y, axis), side->side, 1.0;
      const double off = side->side * side->plane.row.dot(y) - side->plane.plane_distance;
      const double weight = 1.0 / (variance + off * off);  // Cauchy weight, as in (R58)
      H += weight * A * A.transpose();
      g += weight * A * y[axis];
    }
    squares += side->plane.noise_sigma_rad_s * side->plane.noise_sigma_rad_s * side->samples;
    weights += side->samples;
    const std::size_t i = side->side > 0 ? 1 : 0;
    out.samples[i] = side->samples;
    out.segments[i] = side->plane.segments;
    out.tolerance_rad_s = std::max(out.tolerance_rad_s, side->plane.plane_tolerance_rad_s);
    out.log_odds = std::max(out.log_odds, side->log_odds);
  }
  // If two sensing elements always clip together, their cross-axis sensitivity is undetermined.
  const Eigen::LDLT<Eigen::Matrix4d> factor(H);
  out.covariance = factor.solve(Eigen::Matrix4d::Identity());
  const Eigen::Vector4d x = factor.solve(g);
  out.row[axis] = 1.0;
  out.row[(axis + 1) % 3] = x[0];
  out.row[(axis + 2) % 3] = x[1];
  out.saturation_limit_rad_s = x[2];
  out.offset_rad_s = x[3];
  out.deviation_rad_s = std::sqrt(squares / weights);
  return out;
}

/// While several gyro axes are saturated together, their readings do not change, and the fit may give any slopes.
bool has_plausible_slopes(const SaturationPlane& plane, int axis) {
  constexpr double kFittedSlopeMax = 2.0 * SaturationPlaneFinder::Params::kSlopeMax;
  return other_axes_readings(plane.row, axis).cwiseAbs().maxCoeff() <= kFittedSlopeMax;
}

using Pair = std::array<std::optional<SaturationPlaneSide>, 2>;

SaturationPlane merged_plane(const SaturationPlaneFinder::Params& params, const DistinctReadings& readings,
                             const Pair& pair) {
  return merged_plane(params, readings, pair[0] ? &*pair[0] : nullptr, pair[1] ? &*pair[1] : nullptr);
}

struct PlaneSideSearch {
  const SaturationPlaneFinder::Params& params;
  const DistinctReadings& readings;
  SaturationPlaneFinder::Workspace& workspace;

  // See rails.md (R60).
  SaturationPlaneSide search_near_prior(int axis, int sign, const SaturationPlanes& known, const PlaneSlopePrior& prior,
                                        double range) const {
    SaturationPlaneSide side{axis, sign, {}, {}};
    const auto extreme = rails::find_extreme_reading(params, readings, axis, sign, prior, range, workspace);
    if (!extreme) return side;
    const Vector2d searched = rails::search_cross_axis_slopes(readings, *extreme, range, prior, workspace);
    for (const Vector2d& slopes : {searched, prior.cross_axis_slopes}) {
      for (const double start : kInitialSigmaRatios) {
        SaturationPlaneSide tried =
            rails::fit_saturation_plane(readings, *extreme, prior, slopes, start * extreme->slab_thickness, workspace);
        if (tried.samples < params.samples_min) continue;
        tried.log_odds = equal_limits_log_odds(params, readings, known, tried) +
                         plateau_segment_evidence(readings, prior.information, workspace.inliers, tried.plane);
        if (tried.log_odds > side.log_odds) side = tried;
      }
    }
    return side;
  }

  SaturationPlaneSide search_plane_on_side(int axis, int sign, const SaturationPlanes& known) const {
    const auto element = static_cast<std::size_t>(axis);
    if (const auto& rail = known.sensing_axis[element]) {
      const Matrix2d of_slopes = rail->covariance.topLeftCorner<2, 2>();
      const PlaneSlopePrior prior{other_axes_readings(rail->row, axis),
                                  (of_slopes + 1e-6 * Matrix2d::Identity()).inverse()};
      const double range = std::min(params.kSlopeMax, 3.0 * std::sqrt(of_slopes.trace()) + 1e-3);
      return search_near_prior(axis, sign, known, prior, range);
    }
    const Matrix2d unknown = Matrix2d::Identity() / (params.kSlopeSigma * params.kSlopeSigma);
    const SaturationPlaneSide side =
        search_near_prior(axis, sign, known, {Vector2d::Zero(), unknown}, params.kSlopeMax);
    const auto& earlier = params.known_limits.sensing_axis[element];
    if (!earlier) return side;
    const Matrix2d changed =
        earlier->covariance.topLeftCorner<2, 2>() + kKnownSlopeSigma * kKnownSlopeSigma * Matrix2d::Identity();
    const double range = std::min(params.kSlopeMax, 3.0 * std::sqrt(changed.trace()));
    const SaturationPlaneSide same =
        search_near_prior(axis, sign, known, {other_axes_readings(earlier->row, axis), changed.inverse()}, range);
    return same.log_odds > side.log_odds ? same : side;
  }

  bool add(int axis, std::size_t i, bool kept, const SaturationPlanes& found, Pair& pair) const {
    const int sign = i == 0 ? -1 : 1;
    const SaturationPlaneSide side = search_plane_on_side(axis, sign, found);
    if (side.log_odds >= (kept ? params.kLogOddsKeep : params.kLogOddsMin)) {
      pair[i] = side;
      return true;
    }
    const auto& rail = found.sensing_axis[static_cast<std::size_t>(axis)];
    if (rail || !(side.log_odds > -std::numeric_limits<double>::infinity())) return false;
    // The planes of positive and negative saturation may be accepted together although the evidence for each plane
    // alone is insufficient.
    Pair alone;
    alone[i] = side;
    SaturationPlanes supposed = found;
    supposed.sensing_axis[static_cast<std::size_t>(axis)] = merged_plane(params, readings, alone);
    const SaturationPlaneSide other = search_plane_on_side(axis, -sign, supposed);
    // The planes of positive and negative saturation have one common prior: rails.md (R68).
    if (side.log_odds + other.log_odds - params.kLogOddsBefore < params.kLogOddsMin) return false;
    pair[i] = side;
    pair[1 - i] = other;
    return true;
  }
};

constexpr double kBeyondTolerance = 4.0;
constexpr int kMinContradictions = 2;
// maximum relative difference between the saturation levels of one device in two runs
constexpr double kSameShare = 0.003;

}  // namespace

SaturationPlaneFinder::SaturationPlaneFinder(const Params& params) : params_(params) {
  require_valid_fields(params);
  if (params.stated_range_rad_s) require_in_interval("stated_rad_s", *params.stated_range_rad_s, 1e-6, 1000.0);
}

void SaturationPlaneFinder::Workspace::reserve(std::size_t readings) {
  rates.reserve(readings);
  values.reserve(readings);
  near_plane_indices.reserve(readings);
  inliers.reserve(readings);
}

SaturationPlanes SaturationPlaneFinder::find(std::span<const ImuSample> samples, Triad triad) const {
  std::vector<Vector3d> readings(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) readings[k] = triad_reading_of(samples[k], triad);
  Workspace workspace;
  return find(readings, {}, workspace);
}

SaturationPlanes SaturationPlaneFinder::find(std::span<const Vector3d> readings_rad_s, const SaturationPlanes& before,
                                             Workspace& workspace) const {
  const DistinctReadings readings = distinct_readings(readings_rad_s, workspace.rates, workspace.values);
  SaturationPlanes found;
  if (readings.rates.size() < static_cast<std::size_t>(params_.samples_min) + 2)
    return merge_known_saturation_planes(found, readings.rates);
  const PlaneSideSearch search{params_, readings, workspace};
  std::array<Pair, 3> sides;
  // Each accepted saturation plane changes the log odds of the other saturation planes, so the search is repeated.
  for (bool added = true; added;) {
    added = false;
    for (int axis = 0; axis < 3; ++axis) {
      const auto element = static_cast<std::size_t>(axis);
      const auto& held = before.sensing_axis[element];
      Pair& pair = sides[element];
      for (std::size_t i = 0; i < 2; ++i) {
        const bool kept = held && held->was_reached(i == 0 ? -1 : 1);
        const Pair earlier = pair;
        if (pair[i] || !search.add(axis, i, kept, found, pair)) continue;
        const SaturationPlane merged = merged_plane(params_, readings, pair);
        if (!has_plausible_slopes(merged, axis)) {
          pair = earlier;
          continue;
        }
        added = true;
        found.sensing_axis[element] = merged;
      }
    }
  }
  return merge_known_saturation_planes(found, readings.rates);
}

SaturationPlanes SaturationPlaneFinder::merge_known_saturation_planes(const SaturationPlanes& found,
                                                                      std::span<const Vector3d> readings_rad_s) const {
  SaturationPlanes out = found;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& earlier = params_.known_limits.sensing_axis[j];
    auto& rail = out.sensing_axis[j];
    if (!earlier) continue;
    if (!rail && !earlier->is_contradicted_by_readings(readings_rad_s)) rail = earlier;
    for (const int sign : {-1, 1}) {
      if (!rail || rail->was_reached(sign) || !earlier->was_reached(sign)) continue;
      const double apart = std::abs(rail->saturation_limit_rad_s - earlier->saturation_limit_rad_s);
      const std::size_t i = sign > 0 ? 1 : 0;
      if (apart <= kSameShare * earlier->saturation_limit_rad_s) rail->samples[i] = earlier->samples[i];
    }
  }
  return out;
}

bool SaturationPlane::is_contradicted_by_readings(std::span<const Vector3d> readings_rad_s) const {
  int beyond = 0;
  for (const Vector3d& y : readings_rad_s) {
    for (const int sign : {-1, 1}) {
      beyond += was_reached(sign) && distance_to_plane_rad_s(y, sign) < -kBeyondTolerance * tolerance_rad_s ? 1 : 0;
    }
  }
  return beyond >= kMinContradictions;
}

SensingDirections sensing_directions(const SaturationPlanes& planes, double unknown_sigma) {
  SensingDirections out;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const std::optional<SaturationPlane>& plane = planes.sensing_axis[j];
    out.cross_axis_slope_sigma[i] =
        plane ? std::sqrt(0.5 * plane->covariance.topLeftCorner<2, 2>().trace()) : unknown_sigma;
    if (plane) out.sensing_directions.row(i) = plane->row.transpose();
  }
  return out;
}

}  // namespace tumble
