// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"

/// The function motion_map computes the distribution of simulated runs over maximum rate and maximum specific force.
namespace tumble::scenarios {

/// MotionPoint contains the maximum true rate of the body and the maximum unclipped specific force of the primary IMU
/// in one simulated run.
struct MotionPoint {
  double rate_rad_s = 0.0, force_m_s2 = 0.0;
};

/// MotionCloud contains the points of one scenario's simulated runs.
struct MotionCloud {
  std::string scenario;
  std::size_t draws = 0;            ///< runs with both numbers above 0
  std::vector<MotionPoint> points;  ///< at most `kPointsMax` of them, evenly spaced in draw order
};

/// PublishedExtreme contains the maxima that a publication reports; NaN means that a maximum is not reported.
struct PublishedExtreme {
  std::string campaign, source;
  double rate_rad_s, force_m_s2;
};

/// MotionMap is the density of all simulated runs over a grid with logarithmic axes, as a kernel density estimate.
struct MotionMap {
  static constexpr std::size_t kCells = 48;  ///< per axis
  static constexpr std::size_t kPointsMax = 500;
  std::vector<MotionCloud> clouds;         ///< scenarios in the order of the draws
  std::vector<double> rate_rad_s;          ///< centres of the columns, ascending; empty without draws
  std::vector<double> force_m_s2;          ///< centres of the rows, ascending
  std::vector<double> share;               ///< fraction of the runs per cell, row by row; their sum is 1
  std::vector<PublishedExtreme> extremes;  ///< published values for the plot
};

/// Computes the density of the runs: counts in cells, smoothed along both axes by a Gaussian of Scott's width in
/// logarithms (at least half a cell). Scott's width is sigma n^(-1/6) (Multivariate Density Estimation, 1992, section
/// 6.3). The part of a kernel beyond the grid is distributed over the grid. The maximum rate and the maximum force of a
/// run may occur at different times. The cost is O(draws + cells^(3/2)).
MotionMap motion_map(std::span<const DrawValues> draws);

}  // namespace tumble::scenarios
