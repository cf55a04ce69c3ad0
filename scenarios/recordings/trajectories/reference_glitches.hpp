// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// leave_out_glitches removes errors of an optical reference: confused markers and repeated attitudes.
namespace tumble::scenarios {

/// GlitchReport contains the number of removed samples per cause.
struct GlitchReport {
  std::size_t unknown = 0;           ///< values that are not finite
  std::size_t bad_norm = 0;          ///< norm differs from 1 by more than 1 %: mean of two attitudes
  std::size_t frozen = 0;            ///< attitude repeats the previous one, before a jump above 0.02 rad
  std::size_t leaps = 0, leapt = 0;  ///< number of jumps; number of samples in and between them
  double fastest_leap_rad_s = 0.0;
  std::size_t gaps = 0;  ///< steps longer than 2.5 median steps, in which the attitude is unknown
  std::string text(std::size_t samples) const;
};

/// Removes erroneous samples from `poses`, judged by their attitudes alone. The time stamps must increase. A jump is a
/// step whose rate exceeds the rates before and after by more than 10 rad/s. The rates before and after are medians of
/// four steps, three to six steps from the jump. No recorded body is assumed to rotate this much faster for only 30 ms.
/// The three samples on either side of a jump are also removed.
///
/// Two jumps less than 0.5 s apart are a pair, and the samples between them are removed. After a single jump, the
/// attitude is uncertain; such a jump is only counted in `leaps`. The cost is O(N).
GlitchReport leave_out_glitches(std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
