// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hand_held_problem.hpp"

namespace tumble::hand_held {

inline constexpr double kAngleShare = 1.0 / 3.0;  ///< fraction of pi, so that a revolution is six sigma
inline constexpr double kLogOdds = 6.9;           ///< 1 to 1000: less probable alternatives are ignored

/// Returns the minimum cost of an additional revolution within a time T between fixed ends, for white jerk of the given
/// root density [rad/s^3 sqrt(s)]. The additional revolution adds the rate 2 pi / T 30 u^2 (1 - u)^2 with u from 0 to
/// 1, see carried.md (C28).
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests for each clipped segment of the gyro whether the body made one revolution more or less than in the solution.
/// Cost: two eliminations over all nodes, plus O(nodes of the tested segments).
///
/// Data after a clipped segment determine the rotation during the segment only up to whole revolutions. The
/// optimisation finds the number of revolutions that is closest to its initial values. The function tests a clipped
/// segment if the integral of the rate's standard deviation reaches a third of pi. The integral is an upper bound of
/// the angle's standard deviation. The function also tests a clipped segment that stays at the saturation level and is
/// long enough for a revolution. In a segment that stays at the saturation level, the optimisation may have stopped
/// with too few revolutions.
///
/// The function solves the segment and its surroundings again with one revolution more and less, and with two if
/// possible. The information of all other nodes about the ends of the tested part is included. The function compares
/// only the costs of the solutions, because the widths of the cost minima hardly differ. The function selects the
/// solution with the lowest cost. An alternative within odds of 1 to 1000 increases the covariances of the nodes to the
/// second moment of the mixture. If a number of revolutions changes, the function solves the whole problem again. If
/// the whole problem cannot be solved, the previous solution remains, and the alternatives increase the covariances.
/// The problem is unchanged if no segment is tested.
///
/// The caller must have computed the covariances of `problem`. The function sets the counters of `report`. The test
/// neglects correlated revolutions of two segments, and the effect of a revolution on the calibration constants. The
/// alternatives differ only by whole revolutions about the clipped element's axis.
void test_revolutions(Problem& problem, HandHeldSmoother::Report& report);

/// Tests the revolutions with `again` as solver of the whole problem, so that a unit test can inject a failing solver.
using SolveAgain = Status (*)(Problem& problem, HandHeldSmoother::Report& report);
void test_revolutions(Problem& problem, HandHeldSmoother::Report& report, SolveAgain again);

}  // namespace tumble::hand_held
