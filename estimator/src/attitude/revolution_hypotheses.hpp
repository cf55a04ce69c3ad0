// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "carried_problem.hpp"

namespace tumble::carried {

inline constexpr double kAngleShare = 1.0 / 3.0;  ///< of pi: standard deviation with a revolution at six sigma
inline constexpr double kLogOdds = 6.9;           ///< 1 to 1000: less probable alternatives are ignored

/// Returns the minimum cost of an additional revolution within a time with fixed ends, for white jerk of a root density
/// [rad/s^3 sqrt(s)]: carried.md (C28), 2 pi / T 30 u^2 (1 - u)^2.
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests, segment by segment, whether the body rotated one more or one less revolution while an element of its gyro was
/// clipped.
///
/// Data after a segment determine its angle up to whole revolutions. The descent finds the number closest to its
/// initial values. A segment is tested in two cases. The integral of the rate's standard deviation, an upper bound of
/// the angle's, reaches a third of pi. Or the solution is at the saturation level throughout and the segment is long
/// enough for a revolution. The descent may then have stopped at too few.
///
/// The segment and its surroundings are then solved again with one more and one less revolution, and with two, if one
/// is possible. The information of all other nodes about its ends is included. The costs are compared; the widths of
/// the modes hardly differ. The best solution is used. If an alternative is within odds of 1 to 1000, the second moment
/// of the mixture is added to the covariances of the nodes. After any change the whole problem is solved again. If this
/// fails, the previous solution remains, and the changes count as open. Without a segment to test, nothing changes.
///
/// `problem` must have its covariances. Sets the counters in `report`. Not modelled: correlated revolutions of two
/// segments, modes other than whole revolutions about the clipped element's axis, and the effect of a revolution on the
/// constants. Cost: two sweeps over all nodes, plus O(nodes of the tested segments).
void ask_revolutions(Problem& problem, CarriedSmoother::Report& report);

/// Same, with `again` solving the whole problem, so that a test can let it fail.
using SolveAgain = Status (*)(Problem& problem, CarriedSmoother::Report& report);
void ask_revolutions(Problem& problem, CarriedSmoother::Report& report, SolveAgain again);

}  // namespace tumble::carried
