// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

struct MotionPoint {
  double rate_rad_s = 0.0, force_m_s2 = 0.0;
};

struct MotionCloud {
  std::string scenario;
  std::size_t draws = 0;            ///< runs with positive maxima
  std::vector<MotionPoint> points;  ///< evenly spaced over the runs
};

struct PublishedExtreme {
  std::string campaign, source;
  double rate_rad_s, force_m_s2;
};

/// MotionMap contains the density of all simulated runs on a grid, whose logarithmic axes are the maximum rate and the
/// maximum specific force of a run.
struct MotionMap {
  static constexpr std::size_t kCells = 48;  ///< number of cells per axis
  static constexpr std::size_t kPointsMax = 500;
  std::vector<MotionCloud> clouds;         ///< in the order of `draws`
  std::vector<double> rate_rad_s;          ///< column centres, ascending
  std::vector<double> force_m_s2;          ///< centres of the rows, ascending
  std::vector<double> share;               ///< by rows; sum 1
  std::vector<PublishedExtreme> extremes;  ///< published values for the plot
};

/// Computes the density of the runs as a histogram, smoothed along both logarithmic axes by a Gaussian. For n runs with
/// the standard deviation sigma, the Gaussian has the standard deviation sigma n^(-1/6) (Scott, Multivariate Density
/// Estimation, 1992, section 6.3), but at least half a cell. The maximum rate and the maximum force of a run may occur
/// at different times.
MotionMap motion_map(std::span<const DrawValues> draws);

}  // namespace tumble::scenarios
