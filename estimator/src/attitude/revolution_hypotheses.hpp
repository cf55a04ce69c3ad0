// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hand_held_problem.hpp"

namespace tumble::hand_held {

/// A segment is tested if the time integral of the rate's standard deviation reaches this fraction of pi (a revolution
/// is then six sigma).
inline constexpr double kAngleShare = 1.0 / 3.0;
inline constexpr double kLogOdds = 6.9;  ///< alternatives with odds below 1 to 1000 are ignored

/// Returns the minimum cost of an additional revolution within a time T between fixed ends, for white jerk of the given
/// root density [rad/s^3 sqrt(s)]: carried.md (C28). The additional rate is (2 pi / T) 30 u^2 (1 - u)^2, where u
/// increases from 0 to 1.
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests for each clipped segment of the gyro whether the body made one revolution more or less than in the solution.
/// Cost: two eliminations over all nodes, plus O(N) for N nodes in tested segments.
///
/// Data after a clipped segment determine the rotation during the segment only up to whole revolutions. The
/// optimisation therefore finds the number of revolutions that is closest to its initial values. A segment is tested if
/// the time integral of the rate's standard deviation, an upper bound of the angle's standard deviation, reaches a
/// third of pi. A segment is also tested if the estimated rate stays at the saturation level, and the segment is long
/// enough for another revolution. At the saturation level, the optimisation may have stopped with too few revolutions.
///
/// The function solves the segment and its surroundings again with one revolution more and less, and with two if
/// possible. All nodes outside of the tested part act as a prior on the ends of the part. The solution with the lowest
/// cost is selected; the widths of the cost minima hardly differ. Alternatives with odds above 1 to 1000 enlarge the
/// covariances of the nodes to the covariances of the mixture of all solutions. If a number of revolutions changes, the
/// function solves the whole problem again. If the whole problem has no solution, the previous solution remains, and
/// the alternatives enlarge the covariances. The problem is unchanged if no segment is tested.
///
/// The caller must have computed the covariances of `problem`. The function sets the counters of `report`. The test
/// neglects correlations between the revolutions of two segments, and the effect of a revolution on the calibration
/// constants. The alternatives differ only by whole revolutions about the clipped element's axis.
void test_revolutions(Problem& problem, HandHeldSmoother::Report& report);

/// Tests the revolutions of clipped segments, with `again` as solver of the whole problem. Unit tests use a solver that
/// fails.
using SolveAgain = Status (*)(Problem& problem, HandHeldSmoother::Report& report);
void test_revolutions(Problem& problem, HandHeldSmoother::Report& report, SolveAgain again);

}  // namespace tumble::hand_held
