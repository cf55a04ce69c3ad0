// SPDX-License-Identifier: BSD-3-Clause
#include "rail_facets.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::rails {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Workspace = RailPlaneFinder::Workspace;

constexpr double kGridStep = 0.01;  // step of the search grid over cross-axis sensitivities
constexpr int kRefinements = 10;
constexpr double kSlabDeviations = 4.0, kSlabRatioMin = 2e-4, kSlabRatioMax = 0.006;

// Collects readings that may be saturated, for any cross-axis sensitivities up to `steepest`.
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

void collect(const DistinctReadings& readings, double from, Side& side, Workspace& workspace) {
  workspace.inliers.clear();
  side.gate.row = side.facet.row;
  side.gate.from = from;
  for (const std::size_t k : workspace.near) {
    if (side.sign * side.gate.row.dot(readings.rates[k]) >= from) workspace.inliers.push_back(k);
  }
}

// Fits a plane to the saturated readings by least squares, with a prior on the cross-axis sensitivities: rails.md
// (R58). Cauchy weights reduce the effect of partly saturated readings, which are below the plane.
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
    // The saturation level is linear in the cross-axis sensitivities.
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

}  // namespace

std::optional<Extreme> find_extreme(const RailPlaneFinder::Params& params, const DistinctReadings& readings, int axis,
                                    int sign, const FacetPrior& prior, double slope_range, Workspace& workspace) {
  double peak = 0.0;
  for (const Vector3d& y : readings.rates) peak = std::max(peak, sign * y[axis]);
  if (peak < 0.5 * params.distance_min_rad_s) return std::nullopt;
  const double steepest = slope_range + prior.slopes.lpNorm<Eigen::Infinity>() + kGridStep;
  Extreme out{axis, sign, std::max({0.002 * peak, 4.0 * readings.noise[axis], 3.0 * readings.digit[axis]}), steepest};
  out.near_min = candidates(readings, axis, sign, steepest, 2.0 * out.slab, workspace.near);
  return out;
}

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

Side fit_facet(const DistinctReadings& readings, const Extreme& extreme, const FacetPrior& prior,
               const Vector2d& slopes, double deviation, Workspace& workspace) {
  const int axis = extreme.axis;
  Side side{axis, extreme.sign, {}, {}};
  side.gate.steepest = extreme.steepest;
  side.gate.near_min = extreme.near_min;
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
    floor = std::max(kSlabRatioMin * facet.level, readings.digit[axis]);
    deviation = std::max(facet.deviation, 0.25 * floor);
    facet.tolerance = std::clamp(kSlabDeviations * deviation, floor, std::max(floor, kSlabRatioMax * facet.level));
    collect(readings, facet.level - facet.tolerance, side, workspace);
  }
  side.samples = static_cast<int>(workspace.inliers.size());
  if (workspace.inliers.empty()) return side;
  fit(readings, prior, deviation, facet, workspace);
  facet.deviation = std::max(facet.deviation, 0.25 * floor);
  return side;
}

}  // namespace tumble::rails
