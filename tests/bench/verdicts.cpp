// SPDX-License-Identifier: BSD-3-Clause
// verdicts SCENARIO FIRST LAST METHOD [HARM]...: scores the health of a method as a classifier. Runs the method on
// draws without a fault ("none") and with wrong inputs (units, axes, signs, clocks, mountings, sensors that fail, dust,
// people). The metrics health_wrong and health_reported of scenarios/scoring/health_scores.cpp state whether an
// estimate is wrong, and whether the health of the estimate reports the error. Prints a line per run with its findings,
// then the share of wrong runs that are reported and the share of false alarms on clean runs, with Wilson's intervals.
// The program is no test; it needs a minute per draw for `slam`, and seconds per draw for `position`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/simulate.hpp"
#include "tests/bench/people.hpp"
#include "tests/scenarios/methods/wrong_inputs.hpp"
#include "tests/tree.hpp"

namespace {

namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;
using scenarios::testing::is_of_kind;
using scenarios::testing::wrong_inputs;

constexpr std::string_view kPeople = "people";  // people near the start, who hide surfaces

/// Keeps the rows whose times are in `kept_ns`. The times of all rows are `all_ns`; both lists are sorted.
template <class Row>
void keep_rows(const std::vector<std::int64_t>& all_ns, const std::vector<std::int64_t>& kept_ns,
               std::vector<Row>& rows) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows.size() && kept < kept_ns.size(); ++k) {
    if (all_ns[k] == kept_ns[kept]) rows[kept++] = rows[k];
  }
  rows.resize(kept);
}

/// Tally counts the correct and wrong decisions of a classifier.
struct Tally {
  int wrong = 0, wrong_reported = 0, clean = 0, clean_reported = 0, refused = 0;

  /// Prints a fraction with Wilson's 95 % interval (Wilson, JASA 22, 1927).
  static void print(const char* what, int count, int all) {
    const double n = all, p = all > 0 ? count / n : 0.0, z = 1.96;
    const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    if (all == 0) return;
    std::printf("%s: %d of %d, %.1f %% [%.1f, %.1f]\n", what, count, all, 100.0 * p,
                100.0 * std::max(0.0, middle - half), 100.0 * std::min(1.0, middle + half));
  }
};

/// Returns the run by which an estimate from `given` is scored: the truth also lacks the samples that `given` lacks.
scenarios::SimulatedDraw scored_at_kept(const scenarios::SimulatedDraw& draw, const scenarios::SimulatedDraw& given) {
  scenarios::SimulatedDraw scored = scenarios::scored_by(draw, given);
  for (std::size_t i = 0; i < given.recording.sensors.imus.size(); ++i) {
    const std::vector<std::int64_t>& all_ns = draw.recording.sensors.imus[i].time_ns;
    const std::vector<std::int64_t>& kept_ns = given.recording.sensors.imus[i].time_ns;
    if (kept_ns.size() == all_ns.size()) continue;
    const auto keep = [&](auto&... rows) { (keep_rows(all_ns, kept_ns, rows), ...); };
    sim::ImuRecord& read = scored.recording.sensors.imus[i];
    sim::ImuTruth& truth = scored.recording.truth.imus[i];
    keep(read.gyro_rad_s, read.accel_m_s2, read.clip_flags, read.magnetic_field_t);
    keep(truth.rate_rad_s, truth.specific_force_m_s2, truth.gyro_unclipped_rad_s, truth.accel_unclipped_m_s2);
    keep(truth.gyro_bias_rad_s, truth.accel_bias_m_s2, truth.magnetic_field_t);
  }
  return scored;
}

void judge(const scenarios::Method& method, const scenarios::SimulatedDraw& draw, const sim::Surface* surface,
           const std::string& harm, Tally& tally) {
  scenarios::SimulatedDraw given = draw;
  if (harm == kPeople) {
    tumble::bench::let_people_walk(draw.recording.truth, given.recording.sensors);
  } else {
    const auto found = wrong_inputs().find(harm);
    if (found == wrong_inputs().end())
      throw std::invalid_argument("no harm '" + harm + "'; without words all are listed");
    found->second(given.recording.sensors);
  }
  scenarios::Outcome outcome;
  const scenarios::Estimate estimate = scenarios::run_method(method, given, outcome);
  if (outcome.status == scenarios::OutcomeStatus::ok)
    scenarios::assess(method, scored_at_kept(draw, given), surface, estimate, outcome);
  // an error of the run also counts as a report
  const bool refused = std::isnan(value_of(outcome.scores, "health_reported"));
  const bool wrong = value_of(outcome.scores, "health_wrong") > 0.0;
  const bool reported = refused || value_of(outcome.scores, "health_reported") > 0.0;
  tally.refused += refused;
  if (wrong) tally.wrong += 1, tally.wrong_reported += reported;
  if (!wrong && harm == "none") tally.clean += 1, tally.clean_reported += reported;
  double error = value_of(outcome.scores, "position_end_error_m");
  for (const char* other : {"ate_m", "inclination_rmse_rad", "rate_error_free_median_rad_s"})
    if (std::isnan(error)) error = value_of(outcome.scores, other);
  std::printf(
      "%-10s %6llu %-22s %-9s %-5s %-8s error %9.4f root of nees %8.2f%s\n", draw.scenario.c_str(),
      static_cast<unsigned long long>(draw.seed), harm.c_str(), to_string(outcome.status),
      refused ? "-" : (wrong ? "wrong" : "good"), reported ? "reported" : "-", error,
      std::sqrt(value_of(outcome.scores, "pose_nees")),
      wrong && !reported ? "  <- silently wrong" : (!wrong && reported && harm == "none" ? "  <- false alarm" : ""));
  for (const tumble::HealthFinding& finding : estimate.faults.findings)
    std::printf("  %s%s: %s\n", to_string(finding.kind), finding.ended ? " (ended)" : "", to_text(finding).c_str());
  if (wrong && !reported) {
    for (const auto& [name, value] : estimate.health) std::printf("  %s %.4g\n", name.c_str(), value);
  }
  if (!estimate.status.ok()) std::printf("  %s\n", estimate.status.message().c_str());
  std::fflush(stdout);
}

int run(const std::string& name, std::uint64_t first, std::uint64_t last, const std::string& full_name,
        std::vector<std::string> chosen) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, name);
  const scenarios::Method& method = *scenarios::find_methods(full_name).front();
  const std::string kind = full_name.substr(0, full_name.find('/'));
  if (chosen.empty()) {
    for (const auto& [harm, _] : wrong_inputs()) chosen.push_back(harm);
    if (kind == "slam") chosen.emplace_back(kPeople);
  }
  Tally tally;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    scenarios::SimulatedDraw draw;
    try {
      draw = scenarios::simulate_draw(data, scenario, seed, 1,
                                      kind == "slam" ? scenarios::Lidars::simulated : scenarios::Lidars::left_out);
    } catch (const sim::SimulationFailure&) {
      continue;
    }
    std::optional<sim::Surface> surface;
    if (kind == "slam") surface.emplace(*draw.built);
    for (const std::string& harm : chosen) {
      if (is_of_kind(harm, method.info.kind)) judge(method, draw, surface ? &*surface : nullptr, harm, tally);
    }
  }
  Tally::print("wrong runs that are reported (asked: 99 %)", tally.wrong_reported, tally.wrong);
  Tally::print("false alarms on clean runs (asked: at most 1 %)", tally.clean_reported, tally.clean);
  std::printf("refused with an error: %d\n", tally.refused);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(stderr, "usage: verdicts SCENARIO FIRST LAST KIND/METHOD [HARM]...\nharms:");
    for (const auto& [harm, _] : wrong_inputs()) std::fprintf(stderr, " %s", harm.c_str());
    std::fprintf(stderr, " %s\n", kPeople.data());
    return 2;
  }
  try {
    return run(words[1], std::strtoull(words[2], nullptr, 10), std::strtoull(words[3], nullptr, 10), words[4],
               {words + 5, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
