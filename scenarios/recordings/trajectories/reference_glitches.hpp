// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// Removes errors of an optical reference: confused markers and held attitudes. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Numbers of removed samples.
struct GlitchReport {
  std::size_t unknown = 0;   ///< not finite
  std::size_t bad_norm = 0;  ///< norm off by more than 1 %: an average of two attitudes
  std::size_t frozen = 0;  ///< repeats the previous one, followed by a jump of more than 0.02 rad that is at least 1.5
                           ///< times the next step
  std::size_t leaps = 0, leapt = 0;  ///< jumps; samples in and between them
  double fastest_leap_rad_s = 0.0;
  std::size_t gaps = 0;  ///< steps longer than 2.5 times the median, without known attitude
  std::string text(std::size_t samples) const;
};

/// Removes errors from `poses`, using attitudes only; stamps must increase. A jump is a step whose rate exceeds that of
/// the steps before and after by more than 10 rad/s. The comparison uses medians of four steps each, three to six steps
/// away. No body here rotates that much faster for only 30 ms. Three samples on either side are removed too.
///
/// Jumps less than 0.5 s apart form a pair, and the samples between them are removed. A jump without return leaves the
/// later attitude uncertain; it only counts in `leaps`. Needs no other sensor. O(N).
GlitchReport leave_out_glitches(std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
