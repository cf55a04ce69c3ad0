// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hand_held_problem.hpp"

namespace tumble::hand_held {

inline constexpr double kAngleShare = 1.0 / 3.0;  ///< fraction of pi, so that a revolution is six sigma
inline constexpr double kLogOdds = 6.9;           ///< 1 to 1000: less probable alternatives are ignored

/// Returns the minimum cost of an additional revolution within the time T with fixed ends, for white jerk of a root
/// density [rad/s^3 sqrt(s)]. The added rate is 2 pi / T 30 u^2 (1 - u)^2 with u from 0 to 1, see carried.md (C28).
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests for each clipped segment of the gyro whether the body made one more or one less revolution than the solution.
/// Cost: two eliminations over all nodes, plus O(nodes of the tested segments).
///
/// Data after a clipped segment determine the rotation angle of the segment only up to whole revolutions. The
/// optimisation finds the number of revolutions that is closest to its initial values. A clipped segment is tested in
/// two cases. First, a segment is tested if the integral of the rate's standard deviation reaches a third of pi. The
/// integral of the rate's standard deviation is an upper bound of the angle's standard deviation. Second, a segment is
/// tested if the solution is at the saturation level throughout, and the segment is long enough for a revolution. In
/// the second case, the optimisation may have stopped at too few revolutions.
///
/// The tested segment and its surroundings are solved again with one more and one less revolution, and with two if one
/// is possible. The information of all other nodes about the ends of the tested part is included. The function compares
/// only the costs, because the widths of the modes hardly differ. The solution with the lowest cost is used. If an
/// alternative is within odds of 1 to 1000, the second moment of the mixture is added to the covariances of the nodes.
/// After a change of any number of revolutions, the whole problem is solved again. If the whole problem cannot be
/// solved, the previous solution remains, and the changes count as open. If no segment is tested, the problem is
/// unchanged.
///
/// The covariances of `problem` must be computed. The function sets the counters in `report`. The test does not model
/// correlated revolutions of two segments, or the effect of a revolution on the constants. Alternatives are only whole
/// revolutions about the clipped element's axis.
void test_revolutions(Problem& problem, HandHeldSmoother::Report& report);

/// Tests the revolutions, and uses `again` to solve the whole problem, so that a unit test can let the solver fail.
using SolveAgain = Status (*)(Problem& problem, HandHeldSmoother::Report& report);
void test_revolutions(Problem& problem, HandHeldSmoother::Report& report, SolveAgain again);

}  // namespace tumble::hand_held
