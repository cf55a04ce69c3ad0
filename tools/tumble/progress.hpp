// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "scenarios/sweep/sweep.hpp"

namespace tumble::tools {

/// A span of time in two units at most: "42 s", "3 min 05 s", "1 h 02 min"; "?" when negative or not finite.
std::string duration_text(double seconds);

/// "[####------]  4/10 draws  40 %  16 outcomes  3 not ok (2 diverged, 1 timeout)  0 rejected  left 1 min 10 s", what
/// has failed so far by how; the bar has `bar_width` cells, none at 0.
std::string progress_line(const scenarios::SweepProgress& progress, int bar_width);

/// Shows a sweep's progress: on a terminal one line that is written over, elsewhere a line every ten seconds.
class ProgressDisplay {
 public:
  using Write = std::function<void(std::string_view)>;
  ProgressDisplay(Write write, bool terminal);

  void show(const scenarios::SweepProgress& progress);
  /// The last line, always shown and ended.
  void finish(const scenarios::SweepProgress& progress);

 private:
  Write write_;
  bool terminal_;
  double shown_at_s_ = 0.0;
};

}  // namespace tumble::tools
