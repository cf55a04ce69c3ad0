// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "scenarios/sweep/sweep.hpp"

namespace tumble::tools {

/// Formats a duration with at most two units, for example "42 s", "3 min 05 s" or "1 h 02 min"; "?" if the duration is
/// negative or not finite.
std::string duration_text(double seconds);

std::string progress_line(const scenarios::SweepProgress& progress, int bar_width);

struct RegistrationProgress {
  std::size_t done = 0, all = 0;
  double elapsed_s = 0.0;  ///< since the first sweep
};

std::string progress_line(const RegistrationProgress& progress, int bar_width);

/// SearchProgress is the progress of a search for failures on one scenario.
struct SearchProgress {
  std::size_t runs = 0, budget = 0, failures = 0;
  double elapsed_s = 0.0;
};

/// Formats the progress, for example "[####------]  40/100 runs  3 failures  in 1 min 10 s".
std::string progress_line(const SearchProgress& progress, int bar_width);

class ProgressDisplay {
 public:
  using Write = std::function<void(std::string_view)>;
  ProgressDisplay(Write write, bool terminal);
  static ProgressDisplay on_standard_error();
  bool is_on_terminal() const { return terminal_; }

  void show(const scenarios::SweepProgress& progress) { show_line(progress, progress.elapsed_s); }
  void show(const RegistrationProgress& progress) { show_line(progress, progress.elapsed_s); }
  void show(const SearchProgress& progress) { show_line(progress, progress.elapsed_s); }
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
