// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "carried_problem.hpp"

namespace tumble::carried {

inline constexpr double kAngleShare = 1.0 / 3.0;  ///< of pi: a deviation of the angle that may hide a turn at six sigma
inline constexpr double kLogOdds = 6.9;           ///< 1 to 1000: less likely turns are not counted

/// Least cost of white jerk of a root density [rad/s^3 sqrt(s)] for a whole turn more within a time, both ends given:
/// carried.md (C30), 2 pi / T 30 u^2 (1 - u)^2.
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Asks, segment by segment, whether the body turned once more or once less while an element of its gyro was clipped.
///
/// What follows a segment tells its angle but for whole turns: a descent ends at the number of turns next to its start.
/// A segment is asked where the angle over it may be off by a turn: the integral of the rate's stated deviation, which
/// is that of the angle or more, reaches a third of pi; or where the descent lies all along the rail and the segment is
/// long enough for a turn: it may have been drawn to fewer turns and be held there. There the segment and its
/// surroundings are solved again from their own rates plus a whole turn and minus one (and a second one, where the
/// first is possible), with what all the rest says of its ends, and the costs are compared (the widths of two modes
/// differ by next to nothing: what a faster turn leaves less sure, it expects less of). The best is taken; where any
/// other is within odds of 1 to 1000, the covariances of the nodes get the second moment of the mixture about it. After
/// any change the whole is solved once more; where that fails the answer before the change stands, and the turns that
/// were to be taken count among those that stay possible. Where no segment qualifies nothing is computed and nothing
/// changes.
///
/// `problem` has its covariances. Fills the counts in `report`. Not modelled: turns of two segments that hang on each
/// other; other modes than whole turns about the clipped element's axis; that the constants move with a turn. Two
/// sweeps over all nodes and O(nodes of the segments asked).
void ask_revolutions(Problem& problem, CarriedSmoother::Report& report);

/// The same, the whole solved again by `again`, which a test may let fail.
using SolveAgain = Status (*)(Problem& problem, CarriedSmoother::Report& report);
void ask_revolutions(Problem& problem, CarriedSmoother::Report& report, SolveAgain again);

}  // namespace tumble::carried
