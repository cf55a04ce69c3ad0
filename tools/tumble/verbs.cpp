// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

std::span<const Verb> verbs() {
  static constexpr Verb kVerbs[] = {
      {"odometry", "estimates trajectory and map from a bag or another recording of an IMU and a lidar",
       declare_odometry},
      {"doctor", "searches a bag or another recording for faults and names the option that repairs each",
       declare_doctor},
      {"list", "lists scenarios, methods, metrics, sensors or suites with their parameters", declare_list},
      {"run", "draws, simulates, estimates and scores one situation", declare_run},
      {"record", "draws and simulates one situation", declare_record},
      {"estimate", "runs a method on a real or simulated recording; never reads the truth", declare_estimate},
      {"score", "scores an estimate against the truth of a recording", declare_score},
      {"sweep", "runs thousands of draws into a results database; resumes when run again", declare_sweep},
      {"merge", "merges results databases", declare_merge},
      {"report", "prints score tables and writes a self-contained page from a results database", declare_report},
      {"compare", "compares two methods on the same draws: differences, tests, failures, draws needed",
       declare_compare},
      {"sensitivity", "shows which drawn numbers influence a method's scores", declare_sensitivity},
      {"render", "draws pictures of a recording or of a draw", declare_render},
      {"replay", "writes a page that plays a recording with its estimates, without network", declare_replay},
      {"bench", "compares an external method with stored results on the standard draws of its kind", declare_bench},
      {"gate", "runs a suite's fixed seeds and compares each draw with the accepted results", declare_gate},
      {"triage", "replaces one input at a time by its truth and reports which one cures a failure", declare_triage},
      {"shrink", "makes a failing draw shorter and simpler while it still fails", declare_shrink},
      {"export", "converts a recording to another format", declare_export},
      {"import", "converts a recording from another format", declare_import},
      {"certify", "measures the agreement of this build's simulation with physics and data sheets", declare_certify},
  };
  return kVerbs;
}

}  // namespace tumble::tools
