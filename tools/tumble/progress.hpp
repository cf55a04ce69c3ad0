// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "scenarios/sweep/sweep.hpp"

namespace tumble::tools {

/// Formats a duration with at most two units: "42 s", "3 min 05 s", "1 h 02 min"; "?" if it is negative or not finite.
std::string duration_text(double seconds);

/// Formats the progress with the failures by kind: "[####------]  4/10 draws  40 %  16 outcomes  3 not ok (2 diverged,
/// 1 timeout)  0 rejected  left 1 min 10 s". The bar has `bar_width` cells; 0 omits it.
std::string progress_line(const scenarios::SweepProgress& progress, int bar_width);

/// RegistrationProgress is the progress of an estimator over the lidar sweeps of one recording.
struct RegistrationProgress {
  std::size_t done = 0, all = 0;
  double elapsed_s = 0.0;  ///< time since the first sweep of this pass
};

/// Formats the progress, for example "[####------]  40/100 lidar sweeps  87 sweeps/s".
std::string progress_line(const RegistrationProgress& progress, int bar_width);

/// SearchProgress is the progress of a search for failures on one scenario.
struct SearchProgress {
  std::size_t runs = 0, budget = 0, failures = 0;
  double elapsed_s = 0.0;
};

/// Formats the progress, for example "[####------]  40/100 runs  3 failures  in 1 min 10 s".
std::string progress_line(const SearchProgress& progress, int bar_width);

/// ProgressDisplay shows the progress of a sweep (many simulated runs) or of an estimator. A terminal shows one line
/// that is overwritten; other outputs get a new line every ten seconds.
class ProgressDisplay {
 public:
  using Write = std::function<void(std::string_view)>;
  ProgressDisplay(Write write, bool terminal);
  static ProgressDisplay on_standard_error();
  bool is_on_terminal() const { return terminal_; }

  void show(const scenarios::SweepProgress& progress) { show_line(progress, progress.elapsed_s); }
  void show(const RegistrationProgress& progress) { show_line(progress, progress.elapsed_s); }
  void show(const SearchProgress& progress) { show_line(progress, progress.elapsed_s); }
  /// Shows the last progress line and ends it.
  void finish(const scenarios::SweepProgress& progress) { finish_line(progress); }
  void finish(const RegistrationProgress& progress) { finish_line(progress); }
  void finish(const SearchProgress& progress) { finish_line(progress); }

 private:
  template <class Progress>
  void show_line(const Progress& progress, double elapsed_s);
  template <class Progress>
  void finish_line(const Progress& progress);

  Write write_;
  bool terminal_;
  double shown_at_s_ = 0.0;
};

}  // namespace tumble::tools
