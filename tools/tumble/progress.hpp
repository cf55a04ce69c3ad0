// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "scenarios/sweep/sweep.hpp"

namespace tumble::tools {

/// Formats a duration with at most two units: "42 s", "3 min 05 s", "1 h 02 min". Returns "?" if the duration is
/// negative or not finite.
std::string duration_text(double seconds);

/// Formats the progress with the failures by kind, for example "[####------]  4/10 draws  40 %  16 outcomes  3 not ok
/// (2 diverged, 1 timeout)  0 rejected  left 1 min 10 s". The bar has `bar_width` cells; a width of 0 omits the bar.
std::string progress_line(const scenarios::SweepProgress& progress, int bar_width);

/// Shows the progress of a sweep: on a terminal in one line that is overwritten, elsewhere in a new line every ten
/// seconds.
class ProgressDisplay {
 public:
  using Write = std::function<void(std::string_view)>;
  ProgressDisplay(Write write, bool terminal);

  void show(const scenarios::SweepProgress& progress);
  /// Shows and ends the last line.
  void finish(const scenarios::SweepProgress& progress);

 private:
  Write write_;
  bool terminal_;
  double shown_at_s_ = 0.0;
};

}  // namespace tumble::tools
