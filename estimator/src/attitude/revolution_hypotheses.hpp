// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hand_held_problem.hpp"

namespace tumble::hand_held {

/// A clipped segment is tested for hidden revolutions if the standard deviation of its rotation angle reaches
/// kAngleShare times pi.
inline constexpr double kAngleShare = 1.0 / 3.0;
inline constexpr double kLogOdds = 6.9;  ///< alternatives with odds below 1 to 1000 are ignored

/// Returns the minimum cost of one additional revolution within the duration T = `span_s`: carried.md (C28). The
/// additional revolution does not change rate and angular acceleration at the start and end of the duration. The
/// angular jerk is modelled as white noise with the root density `jerk_rad_s3_sqrts` [rad/s^3 sqrt(s)].
double revolution_cost(double span_s, double jerk_rad_s3_sqrts);

/// Tests for each clipped gyro segment whether the body made one revolution more or less than in the solution. Cost:
/// O(N) for N time steps.
///
/// Data after a clipped segment determine the rotation during the segment only up to whole revolutions.
///
/// Alternatives with odds above 1 to 1000 enlarge the covariances to those of the mixture of all solutions.
///
/// The caller must have computed the covariances of `problem`. The hypotheses neglect correlations between the
/// revolutions of two segments, and the effect of revolutions on the calibration constants. The alternative solutions
/// differ only by whole revolutions about the clipped element's axis.
void test_revolutions(HandHeldProblem& problem, HandHeldSmoother::Report& report);

using SolveAgain = Status (*)(HandHeldProblem& problem, HandHeldSmoother::Report& report);
void test_revolutions(HandHeldProblem& problem, HandHeldSmoother::Report& report, SolveAgain again);

}  // namespace tumble::hand_held
