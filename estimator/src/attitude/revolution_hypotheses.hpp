// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hand_held_problem.hpp"

namespace tumble::hand_held {

/// A clipped segment may hide a revolution if the standard deviation of the rotation angle in the segment exceeds
/// kAngleShare times pi: carried.md (C28).
inline constexpr double kAngleShare = 1.0 / 3.0;
inline constexpr double kLogOdds = 6.9;  ///< alternatives with odds below 1 to 1000 are ignored

/// Returns the minimum least-squares cost of the angular jerk for one additional revolution within `span_s` seconds:
/// carried.md (C28). The additional revolution does not change rate and angular acceleration at the start and end of
/// the time span. The angular jerk is modelled as white noise with the root density `jerk_rad_s3_sqrts` [rad/s^3
/// sqrt(s)].
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests for each ambiguous clipped gyro segment whether the body made up to two revolutions more or less than in the
/// solution. Cost: O(N) for N time steps.
///
/// Data after a clipped segment determine the rotation during the segment only up to whole revolutions.
///
/// If another number of revolutions has odds above 1 to 1000, the covariances increase in proportion to the probability
/// of this number: carried.md (C29).
///
/// The caller must have computed the covariances of `problem`. The hypotheses neglect correlations between the
/// revolutions of two segments, and the effect of revolutions on the calibration constants. Only additional revolutions
/// about the axis of the clipped sensing element are tested.
void test_revolutions(HandHeldProblem& problem, HandHeldSmoother::Report& report);

using SolveAgain = Status (*)(HandHeldProblem& problem, HandHeldSmoother::Report& report);
void test_revolutions(HandHeldProblem& problem, HandHeldSmoother::Report& report, SolveAgain again);

}  // namespace tumble::hand_held
