// SPDX-License-Identifier: BSD-3-Clause
#include "saturation_plane_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::rails {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Workspace = SaturationPlaneFinder::Workspace;

constexpr double kGridStep = 0.01;  // step of the search grid over cross-axis sensitivities
constexpr int kRefinements = 10;
constexpr double kSlabDeviations = 4.0, kSlabRatioMin = 2e-4, kSlabRatioMax = 0.006;

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
      double top = -std::numeric_limits<double>::max();
      for (std::size_t i = 0; i < near.size(); ++i) {
        const Vector3d& y = readings.rates[near[i]];
        values[i] = extreme.side * (y[axis] + slopes.dot(other_axes_readings(y, axis)));
        top = std::max(top, values[i]);
      }
      const auto count =
          std::count_if(values.begin(), values.end(), [&](double v) { return v >= top - extreme.slab_thickness; });
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
  double top = -std::numeric_limits<double>::max();
  for (const std::size_t k : workspace.near_plane_indices)
    top = std::max(top, facet.side * facet.row.dot(readings.rates[k]));
  collect_plane_inliers(readings, top - extreme.slab_thickness, side, workspace);
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
