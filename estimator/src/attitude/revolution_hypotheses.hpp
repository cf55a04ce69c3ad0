// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "carried_problem.hpp"

namespace tumble::carried {

inline constexpr double kAngleShare = 1.0 / 3.0;  ///< of pi: standard deviation with a revolution at six sigma
inline constexpr double kLogOdds = 6.9;           ///< 1 to 1000: less probable alternatives are ignored

/// Returns the minimum cost of an additional revolution within the time T with fixed ends, for white jerk of a root
/// density [rad/s^3 sqrt(s)]. The added rate is 2 pi / T 30 u^2 (1 - u)^2 with u from 0 to 1: carried.md (C28).
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests, segment by segment, whether the body rotated one more or one less revolution while a sensing element of its
/// gyro was clipped.
///
/// Data after a segment determine the segment's angle up to whole revolutions. The optimisation finds the number
/// closest to its initial values. A segment is tested in two cases. In case 1, the integral of the rate's standard
/// deviation reaches a third of pi. The integral of the rate's standard deviation is an upper bound of the angle's
/// standard deviation. In case 2, the solution is at the saturation level throughout, and the segment is long enough
/// for a revolution. The optimisation may then have stopped at too few revolutions.
///
/// The segment and its surroundings are then solved again with one more and one less revolution, and with two if one is
/// possible. The information of all other nodes about the ends of the part is included. The costs are compared, because
/// the widths of the modes hardly differ. The best solution is used. If an alternative is within odds of 1 to 1000, the
/// second moment of the mixture is added to the covariances of the nodes. After any change the whole problem is solved
/// again. If the whole problem cannot be solved, the previous solution remains, and the changes count as open. Without
/// a segment to test, nothing changes.
///
/// `problem` must have its covariances. Sets the counters in `report`. Not modelled are correlated revolutions of two
/// segments, modes other than whole revolutions about the clipped element's axis, and the effect of a revolution on the
/// constants. Cost: two sweeps over all nodes, plus O(nodes of the tested segments).
void test_revolutions(Problem& problem, CarriedSmoother::Report& report);

/// Tests the revolutions with `again` to solve the whole problem, so that a unit test can let the solver fail.
using SolveAgain = Status (*)(Problem& problem, CarriedSmoother::Report& report);
void test_revolutions(Problem& problem, CarriedSmoother::Report& report, SolveAgain again);

}  // namespace tumble::carried
