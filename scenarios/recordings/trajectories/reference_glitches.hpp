// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// What an optical reference says that no motion was: markers taken for one another, attitudes held. Private to
/// scenarios/recordings.
namespace tumble::scenarios {

/// What was left out, in samples.
struct GlitchReport {
  std::size_t unknown = 0;   ///< not finite
  std::size_t bad_norm = 0;  ///< off unit length by more than a percent: an average of two attitudes
  std::size_t frozen =
      0;  ///< repeats the one before; then a step of more than 0.02 rad catches up, half again the next
  std::size_t leaps = 0, leapt = 0;  ///< leaps; samples in and between them
  double fastest_leap_rad_s = 0.0;
  std::size_t gaps = 0;  ///< steps longer than 2.5 times the median: nothing is known within
  std::string text(std::size_t samples) const;
};

/// Takes from `poses` (attitudes count, positions do not; stamps rise) what is no motion. A leap is a step whose rate
/// exceeds that of the steps before and after, the median of four each that lie three to six steps away, by more than
/// 10 rad/s: no body here turns faster for 30 ms and then as before. Three samples on either side go with it. Leaps
/// less than 0.5 s apart are a pair, there and back, and what lies between them goes too. A leap without return leaves
/// the attitude after it in doubt; that is counted in `leaps` alone. Needs no other sensor. O(N).
GlitchReport leave_out_glitches(std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
