// SPDX-License-Identifier: BSD-3-Clause
// verdicts SCENARIO FIRST LAST METHOD [HARM]...: runs a method of kind `slam`, `position` or `rate` on draws as they
// are and on the same with wrong inputs (units, axes, signs, clocks, mountings, sensors that die, dust, people), and
// holds what it says of itself against what is true. Wrong: ends further off than five of its standard deviations
// (slam: pose NEES beyond 25; rate: a tenth of the samples that turn are off by more than five, or half of them by a
// fifth of their rate). Told: the status, `localised`, or a key of its health that says so. Prints a line per run and
// the two rates of a classifier: wrong runs that say so, runs with inputs as they are that cry wolf. Not a test: a
// minute a draw for `slam`, seconds for `position`.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/method.hpp"
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

constexpr double kWrongDeviations = 5.0;
constexpr double kWrongShare = 0.2;
constexpr std::string_view kPeople = "people";  // about the start: what they hide depends on the truth

double value_of(const std::vector<scenarios::Score>& scores, const std::string& metric) {
  const auto found =
      std::find_if(scores.begin(), scores.end(), [&](const auto& score) { return score.metric == metric; });
  return found == scores.end() ? std::nan("") : found->value;
}

bool told(const scenarios::Outcome& outcome, const scenarios::Estimate& estimate) {
  if (outcome.status != scenarios::OutcomeStatus::ok) return true;
  const auto says = [&](const char* key, double otherwise) {
    const auto found = estimate.health.find(key);
    return found == estimate.health.end() ? otherwise : found->second;
  };
  return says("localised", 1.0) == 0.0 || says("imu_implausible", 0.0) != 0.0;
}

// Of the samples in which the body turns: the deviations that a tenth exceeds, and the median of the error as a share
// of the rate.
struct RateErrors {
  double deviations = 0.0, share = 0.0;
};

RateErrors rate_errors(const sim::Recording& recording, const scenarios::Estimate& estimate) {
  constexpr double kTurns_rad_s = 1.0;
  const std::vector<Eigen::Vector3d>& truth = recording.truth.imus.front().rate_rad_s;
  std::vector<double> deviations, shares;
  for (std::size_t k = 0; k < std::min(truth.size(), estimate.rates.size()); ++k) {
    if (truth[k].norm() < kTurns_rad_s) continue;
    const Eigen::Vector3d error = estimate.rates[k].w_WI_I_rad_s - truth[k];
    deviations.push_back(std::sqrt(error.dot(estimate.rates[k].covariance_rad2_s2.ldlt().solve(error))));
    shares.push_back(error.norm() / truth[k].norm());
  }
  if (shares.empty()) return {};
  std::sort(deviations.begin(), deviations.end());
  std::sort(shares.begin(), shares.end());
  return {deviations[deviations.size() * 9 / 10], shares[shares.size() / 2]};
}

struct Tally {
  int wrong = 0, wrong_told = 0, good = 0, good_told = 0;
};

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
  const bool says = told(outcome, estimate), answered = outcome.status == scenarios::OutcomeStatus::ok;
  double error = std::nan(""), deviations = std::nan(""), overlap = std::nan(""), coverage = std::nan("");
  if (answered) {
    scenarios::assess(method, scenarios::scored_by(draw, given), surface, estimate, outcome);
    overlap = value_of(outcome.scores, "map_overlap"), coverage = value_of(outcome.scores, "map_coverage");
    const double nees = value_of(outcome.scores, "pose_nees");
    const double sigma_m =
        estimate.poses.empty() ? 0.0 : std::sqrt(estimate.poses.back().covariance.topLeftCorner<3, 3>().trace());
    error = value_of(outcome.scores, "position_end_error_m");
    if (std::isnan(error)) error = value_of(outcome.scores, "ate_m");
    deviations = std::isnan(nees) ? error / sigma_m : std::sqrt(nees);
  }
  bool wrong = !(deviations <= kWrongDeviations) && answered;
  if (answered && method.info.kind == scenarios::Kind::rate) {
    const RateErrors of_rate = rate_errors(draw.recording, estimate);
    error = of_rate.share, deviations = of_rate.deviations;
    wrong = !(deviations <= kWrongDeviations && error <= kWrongShare);
  }
  if (wrong) {
    ++tally.wrong, tally.wrong_told += says;
  } else if (harm == "none") {  // a wrong input that did no harm is told rightly
    ++tally.good, tally.good_told += says;
  }
  const auto health = [&](const char* key) {
    const auto found = estimate.health.find(key);
    return found == estimate.health.end() ? std::nan("") : found->second;
  };
  std::printf(
      "%-10s %6llu %-22s %-9s error %9.4f deviations %8.2f %-5s %-5s surprise %7.3g innovation %7.3g %7.3g rig %7.3g "
      "held %5.2f map %6.4f covers %6.4f scale %6.3f +- %6.3f slope %5.2f rest %5.3f missed %5.2f of %5.2f velocity "
      "%5.2f of %5.2f pivot %6.2f of %2.0f scale %6.4f +- %6.4f%s\n",
      draw.scenario.c_str(), static_cast<unsigned long long>(draw.seed), harm.c_str(), to_string(outcome.status), error,
      deviations, wrong ? "wrong" : "good", says ? "told" : "-", health("calibration_surprise"),
      health("innovation_median"), health("innovation_90"), health("calibration_mahalanobis"), health("held_share"),
      overlap, coverage, health("lidar_scale"), health("lidar_scale_sigma"), health("imu_turning_slope"),
      health("imu_rest_force_share"), health("rest_gravity_missed_rad"), health("rest_gravity_missed_sigma_rad"),
      health("rest_velocity_share"), health("rest_velocity_allowed_share"), health("pivot_evidence"),
      health("pivot_stretches"), health("pivot_scale"), health("pivot_scale_sigma"),
      wrong && !says ? "  <- silently wrong" : (!wrong && says && harm == "none" ? "  <- cries wolf" : ""));
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
  std::printf("wrong by more than %g deviations: %d, of these told: %d; good: %d, of these crying wolf: %d\n",
              kWrongDeviations, tally.wrong, tally.wrong_told, tally.good, tally.good_told);
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
