// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"

/// Where the draws of a sweep lie among motions: how fast they turned, and how hard they were hit.
namespace tumble::scenarios {

/// Of one draw, from the truth: the largest rate of its body, and the largest specific force that its primary IMU would
/// have read had it no rail.
struct MotionPoint {
  double rate_rad_s = 0.0, force_m_s2 = 0.0;
};

/// The draws of one scenario.
struct MotionCloud {
  std::string scenario;
  std::size_t draws = 0;            ///< with both numbers, above 0
  std::vector<MotionPoint> points;  ///< of them, at most `kPointsMax`, at equal steps of the order of the draws
};

/// The largest that a published campaign reports; NaN: it does not say.
struct PublishedExtreme {
  std::string campaign, source;
  double rate_rad_s, force_m_s2;
};

/// Share of all draws over a grid whose cells are equally wide in logarithms: a kernel density estimate.
struct MotionMap {
  static constexpr std::size_t kCells = 48;  ///< along either axis
  static constexpr std::size_t kPointsMax = 500;
  std::vector<MotionCloud> clouds;         ///< scenarios in the order of the draws
  std::vector<double> rate_rad_s;          ///< centres of the columns, rising; empty without a draw
  std::vector<double> force_m_s2;          ///< centres of the rows, rising
  std::vector<double> share;               ///< row by row: share of the draws in a cell; all of them sum to 1
  std::vector<PublishedExtreme> extremes;  ///< to be drawn beside it
};

/// Counts in cells, then smoothed along either axis by a Gaussian of Scott's width in logarithms (Multivariate Density
/// Estimation, 1992, section 6.3: sigma n^(-1/6)), at least half a cell; what a kernel has beyond the grid is given
/// back to the grid. Of a draw it has two maxima alone, which need not fall on one instant: what a motion was like
/// between them is in no database. O(draws + cells^(3/2)).
MotionMap motion_map(std::span<const DrawValues> draws);

}  // namespace tumble::scenarios
