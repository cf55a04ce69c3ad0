// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

std::span<const Verb> verbs() {
  static constexpr Verb kVerbs[] = {
      {"odometry", "estimates trajectory and map from a bag or another recording of an IMU and a lidar",
       declare_odometry},
      {"doctor", "searches a bag or another recording for faults and names the option that repairs each fault",
       declare_doctor},
      {"list", "lists scenarios, methods, metrics, sensors or suites with their parameters", declare_list},
      {"run", "simulates one run of a scenario, runs methods on the recording and scores the estimates", declare_run},
      {"record", "simulates one run of a scenario and writes the recording", declare_record},
      {"estimate", "runs a method on a real or simulated recording; never reads the truth", declare_estimate},
      {"score", "scores an estimate against the truth of a recording", declare_score},
      {"sweep",
       "simulates thousands of runs and stores the scores of methods in a results database; the same command continues "
       "a stopped sweep",
       declare_sweep},
      {"merge", "merges results databases", declare_merge},
      {"report", "prints score tables and writes a self-contained page from a results database", declare_report},
      {"compare", "compares methods on the same simulated runs: differences, tests, failures and number of runs needed",
       declare_compare},
      {"sensitivity", "shows which random parameters of a scenario influence a method's scores", declare_sensitivity},
      {"search", "estimates the probability of a rare failure and finds simulated runs on which a method fails",
       declare_search},
      {"render", "renders pictures of a recording or of a simulated run", declare_render},
      {"replay", "writes a page that plays a recording with its estimates; the page needs no network", declare_replay},
      {"bench", "compares an external method with stored results of other methods on standard simulated runs",
       declare_bench},
      {"gate", "runs a suite's fixed seeds and compares each simulated run with the accepted results", declare_gate},
      {"triage", "replaces one input at a time by its true value and reports which input prevents a failure",
       declare_triage},
      {"shrink", "makes a failing simulated run shorter and simpler while it still fails", declare_shrink},
      {"export", "converts a recording to another format", declare_export},
      {"import", "converts a recording from another format", declare_import},
      {"certify", "measures how well this build's simulation agrees with physics and data sheets", declare_certify},
  };
  return kVerbs;
}

}  // namespace tumble::tools
