// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

std::span<const Verb> verbs() {
  static constexpr Verb kVerbs[] = {
      {"list", "names and parameters of scenarios, methods, metrics, sensors or suites", declare_list},
      {"run", "draw, simulate, estimate and score one situation", declare_run},
      {"record", "draw and simulate one situation", declare_record},
      {"estimate", "run a method over a recording, real or simulated; never opens the truth", declare_estimate},
      {"score", "hold an estimate to the truth of a recording", declare_score},
      {"sweep", "thousands of runs into a results database; run again to resume", declare_sweep},
      {"merge", "join results databases", declare_merge},
      {"report", "score tables and one self-contained page from a results database", declare_report},
      {"compare", "two methods on the same draws: differences, tests, failures, draws wanted", declare_compare},
      {"sensitivity", "which of the drawn numbers a method's scores depend on", declare_sensitivity},
      {"render", "pictures of a recording or of a draw", declare_render},
      {"replay", "a page that plays a recording with its estimates, off line", declare_replay},
      {"bench", "a method of anybody's on the standard draws of its kind, beside stored results", declare_bench},
      {"gate", "sweep a suite's fixed seeds and hold them to the accepted run, draw by draw", declare_gate},
      {"triage", "replace one input at a time by its truth and say which one cures a failure", declare_triage},
      {"shrink", "make a failing draw shorter and simpler until nothing more can go", declare_shrink},
      {"export", "a recording in somebody else's format", declare_export},
      {"import", "a recording from somebody else's format", declare_import},
      {"certify", "measure how far this build is from physics and its data sheets", declare_certify},
  };
  return kVerbs;
}

}  // namespace tumble::tools
