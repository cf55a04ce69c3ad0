// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// reference_glitches.hpp removes errors of an optical reference: confused markers and repeated attitudes. Used only
/// within scenarios/recordings.
namespace tumble::scenarios {

/// GlitchReport contains the numbers of removed samples, by cause.
struct GlitchReport {
  std::size_t unknown = 0;           ///< not finite
  std::size_t bad_norm = 0;          ///< norm off by more than 1 %: an average of two attitudes
  std::size_t frozen = 0;            ///< repeats the previous attitude, followed by a jump above 0.02 rad
  std::size_t leaps = 0, leapt = 0;  ///< jumps; samples in and between them
  double fastest_leap_rad_s = 0.0;
  std::size_t gaps = 0;  ///< steps longer than 2.5 times the median step, without known attitude
  std::string text(std::size_t samples) const;
};

/// Removes errors from `poses`, using only attitudes. The stamps of the poses must increase. A jump is a step whose
/// rate exceeds that of the steps before and after by more than 10 rad/s. The compared rates are medians of four steps
/// before and of four steps after, three to six steps away. The threshold assumes that no recorded body rotates 10
/// rad/s faster for only 30 ms. The three samples on either side of a jump are also removed.
///
/// Jumps less than 0.5 s apart form a pair, and the samples between the two jumps are removed. After a jump without a
/// return jump, the attitude is uncertain; the function only counts this jump in `leaps`. The function uses no other
/// sensor. Cost: O(N).
GlitchReport leave_out_glitches(std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
