// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rail_planes.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "rail_evidence.hpp"
#include "tumble/angular_velocity/detail/rail_shares.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Workspace = RailPlaneFinder::Workspace;

constexpr double kGridStep = 0.01;  // of the slopes
constexpr int kRefinements = 10;
// Deviations with which the robust fit starts, as shares of the slab: a thin rail with a few samples short of it, a
// thick one.
constexpr double kStarts[] = {0.5, 0.02};
// Half a slab: deviations of the samples, and the least and the most share of the level.
constexpr double kSlabDeviations = 4.0, kSlabShareMin = 2e-4, kSlabShareMax = 0.006;
// Elements of one device differ by this share without remark: another axis does not read more than that beyond a rail.
constexpr double kSiblingShare = 0.04;
// Log odds of a level: near that of another element, of a stated range, of the other sign; and what cannot be.
constexpr double kNearSibling = 5.0, kNearStated = 3.0, kOtherSignAgrees = 5.0, kImpossible = -100.0;
// What a rail at that of an earlier run is worth, how far the two may lie apart as a share of the level, and the least
// that one elsewhere is worth: the device may be another.
constexpr double kNearKnown = 6.0, kKnownShare = 0.003, kFarFromKnown = -3.0;
// What the slopes may change from run to run.
constexpr double kKnownSlopeSigma = 2e-3;

// Readings that belong to a facet: along `row` not below `from`, and near the extreme for slopes up to `steepest`.
struct Gate {
  Vector3d row = Vector3d::Zero();
  double from = 0.0, steepest = 0.0, near_from = 0.0;
};

// One sign of one element while it is searched for.
struct Side {
  int axis = 0, sign = 1;
  RailFacet facet;
  Gate gate;  // of the facet's readings
  int samples = 0;
  double log_odds = -std::numeric_limits<double>::infinity();
};

Vector2d others(const Vector3d& y, int axis) {
  return {y[(axis + 1) % 3], y[(axis + 2) % 3]};
}

// What is known of a facet before its samples are looked at.
struct FacetPrior {
  Vector2d slopes = Vector2d::Zero();
  Matrix2d information = Matrix2d::Identity();
};

double highest_value(const Vector3d& y, int axis, int sign, double steepest) {
  return sign * y[axis] + steepest * others(y, axis).lpNorm<1>();
}

// Samples that may lie in the slab below the largest value for any slope up to `steepest`; returns their least value.
double candidates(const DistinctReadings& readings, int axis, int sign, double steepest, double slab,
                  std::vector<std::size_t>& out) {
  double sure = -std::numeric_limits<double>::max();
  for (const Vector3d& y : readings.rates) {
    sure = std::max(sure, sign * y[axis] - steepest * others(y, axis).lpNorm<1>());
  }
  out.clear();
  for (std::size_t k = 0; k < readings.rates.size(); ++k) {
    if (highest_value(readings.rates[k], axis, sign, steepest) >= sure - slab) out.push_back(k);
  }
  return sure - slab;
}

// The samples by which the facet is fitted.
void collect(const DistinctReadings& readings, double from, Side& side, Workspace& workspace) {
  workspace.inliers.clear();
  side.gate.row = side.facet.row;
  side.gate.from = from;
  for (const std::size_t k : workspace.near) {
    if (side.sign * side.gate.row.dot(readings.rates[k]) >= from) workspace.inliers.push_back(k);
  }
}

// Least squares of slopes and level over the inliers, with the prior of the slopes; deviation of the samples. Robust
// (Cauchy), since windows that met the rail in a part only lie short of the plane: rails.md (R58).
void fit(const DistinctReadings& readings, const FacetPrior& prior, double deviation, RailFacet& facet,
         Workspace& workspace) {
  const int axis = facet.axis;
  const Vector3d row = facet.row;
  const double level = facet.level;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  H.topLeftCorner<2, 2>() = prior.information;
  g.head<2>() = prior.information * prior.slopes;
  const double weight = 1.0 / (deviation * deviation);
  for (const std::size_t k : workspace.inliers) {
    const Vector3d& y = readings.rates[k];
    // level = sign * (y_j + slopes . others)
    Vector3d A;
    A << -facet.sign * others(y, axis), 1.0;
    const double off = level > 0.0 ? (facet.sign * row.dot(y) - level) / deviation : 0.0;
    const double share = weight / (1.0 + off * off);
    H += share * A * A.transpose();
    g += share * A * (facet.sign * y[axis]);
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(H);
  const Vector3d x = factor.solve(g);
  facet.row = Vector3d::Zero();
  facet.row[axis] = 1.0;
  facet.row[(axis + 1) % 3] = x[0];
  facet.row[(axis + 2) % 3] = x[1];
  facet.level = x[2];
  std::vector<double>& residuals = workspace.values;
  residuals.clear();
  for (const std::size_t k : workspace.inliers) {
    residuals.push_back(std::abs(facet.sign * facet.row.dot(readings.rates[k]) - facet.level));
  }
  std::nth_element(residuals.begin(), residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2),
                   residuals.end());
  facet.deviation = residuals.empty() ? 0.0 : 1.4826 * residuals[residuals.size() / 2];
}

// One sign of an axis, its samples near the extreme and the slab in which a rail is looked for.
struct Extreme {
  int axis = 0, sign = 1;
  double slab = 0.0;
  double steepest = 0.0, near_from = 0.0;
};

// Nothing where the axis reads too little for a rail. Leaves the samples near it in the workspace.
std::optional<Extreme> find_extreme(const RailPlaneFinder::Params& params, const DistinctReadings& readings, int axis,
                                    int sign, const FacetPrior& prior, double slope_range, Workspace& workspace) {
  double peak = 0.0;
  for (const Vector3d& y : readings.rates) peak = std::max(peak, sign * y[axis]);
  if (peak < 0.5 * params.distance_min_rad_s) return std::nullopt;
  const double steepest = slope_range + prior.slopes.lpNorm<Eigen::Infinity>() + kGridStep;
  Extreme out{axis, sign, std::max({0.002 * peak, 4.0 * readings.noise[axis], 3.0 * readings.digit[axis]}), steepest};
  out.near_from = candidates(readings, axis, sign, steepest, 2.0 * out.slab, workspace.near);
  return out;
}

// Slopes on a grid about the prior whose slab holds the most samples, less what is odd about them: rails.md (R57).
Vector2d search_slopes(const DistinctReadings& readings, const Extreme& extreme, double slope_max,
                       const FacetPrior& prior, Workspace& workspace) {
  const std::vector<std::size_t>& near = workspace.near;
  const int axis = extreme.axis;
  const int steps = static_cast<int>(std::floor(slope_max / kGridStep + 1e-9));
  Vector2d best = prior.slopes;
  double highest = -std::numeric_limits<double>::max();
  std::vector<double>& values = workspace.values;
  values.resize(near.size());
  for (int a = -steps; a <= steps; ++a) {
    for (int b = -steps; b <= steps; ++b) {
      const Vector2d slopes = prior.slopes + kGridStep * Vector2d(a, b);
      if (slopes.lpNorm<Eigen::Infinity>() > slope_max + kGridStep) continue;
      double top = -std::numeric_limits<double>::max();
      for (std::size_t i = 0; i < near.size(); ++i) {
        const Vector3d& y = readings.rates[near[i]];
        values[i] = extreme.sign * (y[axis] + slopes.dot(others(y, axis)));
        top = std::max(top, values[i]);
      }
      const auto count = std::count_if(values.begin(), values.end(), [&](double v) { return v >= top - extreme.slab; });
      const Vector2d off = slopes - prior.slopes;
      const double score = static_cast<double>(count) - 0.5 * off.dot(prior.information * off);
      if (!(score > highest)) continue;
      highest = score;
      best = slopes;
    }
  }
  return best;
}

// The facet about given slopes, the robust fit starting with `deviation`. Leaves its samples in the workspace.
Side fit_facet(const DistinctReadings& readings, const Extreme& extreme, const FacetPrior& prior,
               const Vector2d& slopes, double deviation, Workspace& workspace) {
  const int axis = extreme.axis;
  Side side{axis, extreme.sign, {}, {}};
  side.gate.steepest = extreme.steepest;
  side.gate.near_from = extreme.near_from;
  RailFacet& facet = side.facet;
  facet.axis = axis;
  facet.sign = extreme.sign;
  facet.row[axis] = 1.0;
  facet.row[(axis + 1) % 3] = slopes[0];
  facet.row[(axis + 2) % 3] = slopes[1];
  double top = -std::numeric_limits<double>::max();
  for (const std::size_t k : workspace.near) top = std::max(top, facet.sign * facet.row.dot(readings.rates[k]));
  collect(readings, top - extreme.slab, side, workspace);
  double floor = readings.digit[axis];
  facet.tolerance = extreme.slab;
  for (int i = 0; i < kRefinements && !workspace.inliers.empty(); ++i) {
    fit(readings, prior, deviation, facet, workspace);
    floor = std::max(kSlabShareMin * facet.level, readings.digit[axis]);
    deviation = std::max(facet.deviation, 0.25 * floor);
    facet.tolerance = std::clamp(kSlabDeviations * deviation, floor, std::max(floor, kSlabShareMax * facet.level));
    collect(readings, facet.level - facet.tolerance, side, workspace);
  }
  side.samples = static_cast<int>(workspace.inliers.size());
  if (workspace.inliers.empty()) return side;
  fit(readings, prior, deviation, facet, workspace);
  facet.deviation = std::max(facet.deviation, 0.25 * floor);
  return side;
}

double log_normal_ratio(double value, double sigma) {
  const double z = value / sigma;
  return std::max(kImpossible, -0.5 * z * z);
}

// What is believed of a level before its samples are counted: rails.md (R67).
double level_log_odds(const RailPlaneFinder::Params& params, const DistinctReadings& readings, const RailPlanes& known,
                      const Side& side) {
  const double level = side.facet.level;
  double odds = params.log_odds_before;
  if (level < params.distance_min_rad_s) return kImpossible;
  for (int other = 0; other < 3; ++other) {
    const auto& rail = known.element[static_cast<std::size_t>(other)];
    if (rail && other == side.axis) {
      odds += kOtherSignAgrees + log_normal_ratio(level - rail->distance_rad_s, params.offset_share * level);
    } else if (rail) {
      odds += kNearSibling + log_normal_ratio(level - rail->distance_rad_s, 2.0 * params.offset_share * level);
    }
    if (other == side.axis) continue;
    const double beyond = readings.peak[other] / level - 1.0 - kSiblingShare;
    if (beyond > 0.0) odds += log_normal_ratio(beyond, params.offset_share);
  }
  if (const auto& rail = params.known.element[static_cast<std::size_t>(side.axis)]) {
    const double apart = level - rail->distance_rad_s - side.sign * rail->offset_rad_s;
    odds += std::max(kFarFromKnown, kNearKnown + log_normal_ratio(apart, kKnownShare * level));
  }
  if (params.stated_rad_s) {
    const double ratio = level / *params.stated_rad_s;
    odds += ratio < kStatedRailMin ? kImpossible : ratio < 1.05 && ratio > 0.95 ? kNearStated : 0.0;
  }
  return odds;
}

// One element, rails.md (R53), of what its two signs show; either may be missing.
RailPlane joined(const RailPlaneFinder::Params& params, const DistinctReadings& readings, const Side* minus,
                 const Side* plus) {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  Eigen::Vector4d g = Eigen::Vector4d::Zero();
  const int axis = (plus != nullptr ? plus : minus)->axis;
  const double level = (plus != nullptr ? plus : minus)->facet.level;
  const double slope_information = 1.0 / (params.slope_sigma * params.slope_sigma);
  H.diagonal() << slope_information, slope_information, 0.0, 1.0 / std::pow(params.offset_share * level, 2);
  RailPlane out;
  double squares = 0.0, weights = 0.0;
  for (const Side* side : {minus, plus}) {
    if (side == nullptr) continue;
    const double weight = 1.0 / (side->facet.deviation * side->facet.deviation);
    const Gate& gate = side->gate;
    for (const Vector3d& y : readings.rates) {
      if (!(side->sign * gate.row.dot(y) >= gate.from)) continue;
      if (!(highest_value(y, axis, side->sign, gate.steepest) >= gate.near_from)) continue;
      // rails.md (R59): y_j = sign * r + b - slopes . others
      Eigen::Vector4d A;
      A << -others(y, axis), side->sign, 1.0;
      H += weight * A * A.transpose();
      g += weight * A * y[axis];
    }
    squares += side->facet.deviation * side->facet.deviation * side->samples;
    weights += side->samples;
    const std::size_t i = side->sign > 0 ? 1 : 0;
    out.samples[i] = side->samples;
    out.stretches[i] = side->facet.stretches;
    out.tolerance_rad_s = std::max(out.tolerance_rad_s, side->facet.tolerance);
    out.log_odds = std::max(out.log_odds, side->log_odds);
  }
  // two elements that clip together leave a slope untold: badly conditioned
  const Eigen::LDLT<Eigen::Matrix4d> factor(H);
  out.covariance = factor.solve(Eigen::Matrix4d::Identity());
  const Eigen::Vector4d x = factor.solve(g);
  out.row[axis] = 1.0;
  out.row[(axis + 1) % 3] = x[0];
  out.row[(axis + 2) % 3] = x[1];
  out.distance_rad_s = x[2];
  out.offset_rad_s = x[3];
  out.deviation_rad_s = std::sqrt(squares / weights);
  return out;
}

}  // namespace

RailPlaneFinder::RailPlaneFinder(const Params& params) : params_(params) {
  require_fields(params);
  if (params.stated_rad_s) require_within("stated_rad_s", *params.stated_rad_s, 1e-6, 1000.0);
  require_within("log_odds_keep", params.log_odds_keep, -100.0, params.log_odds_min);
}

void RailPlaneFinder::Workspace::reserve(std::size_t readings) {
  rates.reserve(readings);
  values.reserve(readings);
  near.reserve(readings);
  inliers.reserve(readings);
}

RailPlanes RailPlaneFinder::find(std::span<const ImuSample> samples, Triad triad) const {
  std::vector<Vector3d> readings(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) readings[k] = reading_of(samples[k], triad);
  Workspace workspace;
  return find(readings, {}, workspace);
}

RailPlanes RailPlaneFinder::find(std::span<const Vector3d> readings_rad_s, const RailPlanes& before,
                                 Workspace& workspace) const {
  const DistinctReadings readings = distinct_readings(readings_rad_s, workspace.rates, workspace.values);
  RailPlanes found;
  if (readings.rates.size() < static_cast<std::size_t>(params_.samples_min) + 2)
    return with_known(found, readings.rates);
  std::array<std::array<std::optional<Side>, 2>, 3> sides;
  const Matrix2d unknown = Matrix2d::Identity() / (params_.slope_sigma * params_.slope_sigma);
  // the best facet about what is known of the slopes, by the log odds of rails.md (R60)
  const auto look_about = [&](int axis, int sign, const RailPlanes& known, const FacetPrior& prior, double range) {
    Side side{axis, sign, {}, {}};
    const std::optional<Extreme> extreme = find_extreme(params_, readings, axis, sign, prior, range, workspace);
    if (!extreme) return side;
    const Vector2d searched = search_slopes(readings, *extreme, range, prior, workspace);
    for (const Vector2d& slopes : {searched, prior.slopes}) {
      for (const double start : kStarts) {
        Side tried = fit_facet(readings, *extreme, prior, slopes, start * extreme->slab, workspace);
        if (tried.samples < params_.samples_min) continue;
        tried.log_odds = level_log_odds(params_, readings, known, tried) +
                         stretch_evidence(readings, prior.information, workspace.inliers, tried.facet);
        if (tried.log_odds > side.log_odds) side = tried;
      }
    }
    return side;
  };
  const auto look = [&](int axis, int i, const RailPlanes& known) {
    const int sign = i == 0 ? -1 : 1;
    if (const auto& rail = known.element[static_cast<std::size_t>(axis)]) {
      const Matrix2d of_slopes = rail->covariance.topLeftCorner<2, 2>();
      const FacetPrior prior{others(rail->row, axis), (of_slopes + 1e-6 * Matrix2d::Identity()).inverse()};
      const double range = std::min(params_.slope_max, 3.0 * std::sqrt(of_slopes.trace()) + 1e-3);
      return look_about(axis, sign, known, prior, range);
    }
    const Side side = look_about(axis, sign, known, {Vector2d::Zero(), unknown}, params_.slope_max);
    const auto& earlier = params_.known.element[static_cast<std::size_t>(axis)];
    if (!earlier) return side;
    // the device of the earlier run, or another
    const Matrix2d changed =
        earlier->covariance.topLeftCorner<2, 2>() + kKnownSlopeSigma * kKnownSlopeSigma * Matrix2d::Identity();
    const double range = std::min(params_.slope_max, 3.0 * std::sqrt(changed.trace()));
    const Side same = look_about(axis, sign, known, {others(earlier->row, axis), changed.inverse()}, range);
    return same.log_odds > side.log_odds ? same : side;
  };
  // what is found of one element or sign tells of the others, so again until nothing is added
  for (bool added = true; added;) {
    added = false;
    for (int axis = 0; axis < 3; ++axis) {
      auto& pair = sides[static_cast<std::size_t>(axis)];
      auto& rail = found.element[static_cast<std::size_t>(axis)];
      for (std::size_t i = 0; i < 2; ++i) {
        if (pair[i]) continue;
        const Side side = look(axis, static_cast<int>(i), found);
        const auto& held = before.element[static_cast<std::size_t>(axis)];
        const bool kept = held && held->seen(side.sign);
        const bool believed = side.log_odds >= (kept ? params_.log_odds_keep : params_.log_odds_min);
        if (believed) pair[i] = side;
        // both signs of one row may be believed together where neither is alone
        if (!believed && !rail && side.log_odds > -std::numeric_limits<double>::infinity()) {
          RailPlanes supposed = found;
          const bool plus = side.sign > 0;
          supposed.element[static_cast<std::size_t>(axis)] =
              joined(params_, readings, plus ? nullptr : &side, plus ? &side : nullptr);
          const Side other = look(axis, plus ? 0 : 1, supposed);
          // the odds before count once: rails.md (R68)
          if (side.log_odds + other.log_odds - params_.log_odds_before < params_.log_odds_min) continue;
          pair[i] = side;
          pair[1 - i] = other;
        }
        if (!pair[i]) continue;
        added = true;
        rail = joined(params_, readings, pair[0] ? &*pair[0] : nullptr, pair[1] ? &*pair[1] : nullptr);
      }
    }
  }
  return with_known(found, readings.rates);
}

}  // namespace tumble
