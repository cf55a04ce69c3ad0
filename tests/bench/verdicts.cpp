// SPDX-License-Identifier: BSD-3-Clause
// verdicts SCENARIO FIRST LAST METHOD [HARM]...: runs a method on draws with correct inputs, and on the same draws with
// wrong inputs (units, axes, signs, clocks, mountings, failing sensors, dust, people). Compares the method's report of
// its own quality with the truth.
// A run is wrong if its end error exceeds five standard deviations (slam: pose NEES above 25). A run of rates or
// attitudes is wrong if a tenth of the samples in rotation or motion exceed five standard deviations. Such a run is
// also wrong if half of the samples have an error above a fifth of their rate, or above 0.5 rad of tilt without
// `attitude_unknown_s`.
// A run reports trouble by its status, `localised`, or a key of its health. A method may also increase its covariance
// when it reports trouble. Rates are therefore also judged by the covariance before this increase, and a slam pose also
// by the root of chi-square.
// Prints a line per run, and the two rates of the classifier for each criterion: wrong runs with a report, and correct
// runs with a false alarm. This program is not a test; it takes a minute per draw for `slam`, and seconds for
// `position`.
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
#include "scenarios/scoring/truth_track.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/simulate.hpp"
#include "tests/bench/people.hpp"
#include "tests/scenarios/methods/rates_before_doubt.hpp"
#include "tests/scenarios/methods/wrong_inputs.hpp"
#include "tests/tree.hpp"

namespace {

namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;
using scenarios::testing::is_of_kind;
using scenarios::testing::wrong_inputs;
using tumble::AttitudeState;
using tumble::RateState;

constexpr double kWrongDeviations = 5.0;
constexpr double kWrongShare = 0.2, kWrongTilt_rad = 0.5;
constexpr std::string_view kPeople = "people";  // people walk around the start, so their effect depends on the truth

bool told(const scenarios::Outcome& outcome, const scenarios::Estimate& estimate) {
  if (outcome.status != scenarios::OutcomeStatus::ok) return true;
  using About = scenarios::HealthFinding::About;
  return has_finding({About::place}, estimate) || has_finding({About::readings}, estimate);
}

/// Error of a run in standard deviations, by three measures: the reported covariance, the covariance before it was
/// increased, and for a slam pose the root of the whole chi-square.
struct Judgement {
  double error = std::nan("");  ///< [m]; for rates a share of the rate, for attitudes the tilt [rad]
  double deviations = std::nan(""), before = std::nan(""), root_chi2 = std::nan("");
  bool gross = false;  ///< so large that no covariance excuses it
};

double quantile(std::vector<double>& values, std::size_t tenths) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() * tenths / 10];
}

double deviations_of(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return std::sqrt(error.dot(covariance.ldlt().solve(error)));
}

// For the samples in which the body rotates: the number of standard deviations that a tenth of them exceed, and the
// median error as a share of the rate.
Judgement judge_rates(const sim::Recording& recording, const std::vector<RateState>& before,
                      const scenarios::Estimate& estimate) {
  constexpr double kTurns_rad_s = 1.0;
  const std::vector<Eigen::Vector3d>& truth = recording.truth.imus.front().rate_rad_s;
  std::vector<double> deviations, deviations_before, shares;
  for (std::size_t k = 0; k < std::min(truth.size(), estimate.rates.size()); ++k) {
    if (truth[k].norm() < kTurns_rad_s) continue;
    const Eigen::Vector3d error = estimate.rates[k].w_WI_I_rad_s - truth[k];
    deviations.push_back(deviations_of(error, estimate.rates[k].covariance_rad2_s2));
    deviations_before.push_back(deviations_of(error, before[k].covariance_rad2_s2));
    shares.push_back(error.norm() / truth[k].norm());
  }
  Judgement out{quantile(shares, 5), quantile(deviations, 9), quantile(deviations_before, 9)};
  out.gross = !(out.error <= kWrongShare);
  return out;
}

// For the samples in which the body moves: the tilt error in standard deviations that a tenth of them exceed, and its
// median.
Judgement judge_attitudes(const sim::Recording& recording, const scenarios::Estimate& estimate) {
  const scenarios::TruthTrack truth(recording.truth, estimate.frame);
  std::vector<double> deviations, tilts;
  for (const AttitudeState& attitude : estimate.attitudes) {
    if (!truth.covers_attitude(attitude.time_ns) || truth.at_rest(attitude.time_ns)) continue;
    const Eigen::Vector2d error = scenarios::tilt_error_rad(attitude.q_WA, truth.pose(attitude.time_ns).q_WA);
    tilts.push_back(error.norm());
    deviations.push_back(deviations_of(error, attitude.covariance_rad2.topLeftCorner<2, 2>()));
  }
  Judgement out{quantile(tilts, 5), quantile(deviations, 9)};
  out.before = out.deviations;
  const bool says_so = has_finding({scenarios::HealthFinding::About::attitude}, estimate);
  out.gross = !says_so && !(out.error <= kWrongTilt_rad);
  return out;
}

Judgement judge_poses(const scenarios::Estimate& estimate, const std::vector<scenarios::Score>& scores) {
  Judgement out;
  const double nees = value_of(scores, "pose_nees");
  const double sigma_m =
      estimate.poses.empty() ? 0.0 : std::sqrt(estimate.poses.back().covariance.topLeftCorner<3, 3>().trace());
  out.error = value_of(scores, "position_end_error_m");
  if (std::isnan(out.error)) out.error = value_of(scores, "ate_m");
  out.deviations = std::isnan(nees) ? out.error / sigma_m : std::sqrt(nees);
  out.before = out.deviations;
  out.root_chi2 = std::isnan(nees) ? out.deviations : std::sqrt(6.0 * nees);  // chi-square is divided by six
  return out;
}

Judgement judgement_of(const scenarios::Method& method, const sim::Recording& truth,
                       const scenarios::Estimate& estimate, const std::vector<scenarios::Score>& scores) {
  if (method.info.kind == scenarios::Kind::attitude) return judge_attitudes(truth, estimate);
  if (method.info.kind != scenarios::Kind::rate) return judge_poses(estimate, scores);
  return judge_rates(truth, scenarios::testing::rates_before_doubt(estimate), estimate);
}

/// Returns the rows at the times `kept_ns`, which are a subsequence of `all_ns`.
template <class Row>
void keep_rows(const std::vector<std::int64_t>& all_ns, const std::vector<std::int64_t>& kept_ns,
               std::vector<Row>& rows) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows.size() && kept < kept_ns.size(); ++k) {
    if (all_ns[k] == kept_ns[kept]) rows[kept++] = rows[k];
  }
  rows.resize(kept);
}

/// Counts of a classifier, from which its two rates follow.
struct Tally {
  int wrong = 0, wrong_told = 0, good = 0, good_told = 0;

  void add(bool is_wrong, bool says, bool as_it_is) {
    if (is_wrong) {
      ++wrong, wrong_told += says;
    } else if (as_it_is) {  // a report about a harmless wrong input is correct
      ++good, good_told += says;
    }
  }
  void print(const char* by) const {
    std::printf("%s: wrong by more than %g deviations: %d, of these told: %d; good: %d, of these crying wolf: %d\n", by,
                kWrongDeviations, wrong, wrong_told, good, good_told);
  }
};

struct Tallies {
  Tally reported, before, root_chi2;
};

/// Returns the truth for scoring an answer to `given`. Samples that are missing in `given` are missing in the truth,
/// too.
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
           const std::string& harm, Tallies& tallies) {
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
  double overlap = std::nan(""), coverage = std::nan("");
  Judgement judged;
  if (answered) {
    const scenarios::SimulatedDraw scored = scored_at_kept(draw, given);
    scenarios::assess(method, scored, surface, estimate, outcome);
    overlap = value_of(outcome.scores, "map_overlap"), coverage = value_of(outcome.scores, "map_coverage");
    judged = judgement_of(method, scored.recording, estimate, outcome.scores);
  }
  const auto is_wrong = [&](double deviations) {
    return answered && (!(deviations <= kWrongDeviations) || judged.gross);
  };
  const bool wrong = is_wrong(judged.before), as_it_is = harm == "none";
  tallies.reported.add(is_wrong(judged.deviations), says, as_it_is);
  tallies.before.add(wrong, says, as_it_is);
  tallies.root_chi2.add(is_wrong(judged.root_chi2), says, as_it_is);
  const auto health = [&](const char* key) {
    const auto found = estimate.health.find(key);
    return found == estimate.health.end() ? std::nan("") : found->second;
  };
  std::printf(
      "%-10s %6llu %-22s %-9s error %9.4f deviations %8.2f (before %7.2f, root of chi2 %7.2f) %-5s "
      "%-5s mahalanobis %7.3g innovation %7.3g %7.3g rig %7.3g "
      "held %5.2f map %6.4f covers %6.4f scale %6.3f +- %6.3f slope %5.2f rest %5.3f missed %5.2f of %5.2f velocity "
      "%5.2f of %5.2f pivot %6.2f of %2.0f scale %6.4f +- %6.4f%s\n",
      draw.scenario.c_str(), static_cast<unsigned long long>(draw.seed), harm.c_str(), to_string(outcome.status),
      judged.error, judged.deviations, judged.before, judged.root_chi2, wrong ? "wrong" : "good", says ? "told" : "-",
      health("lidar_calibration_mahalanobis"), health("innovation_median"), health("innovation_90"),
      health("calibration_mahalanobis"), health("well_constrained_share"), overlap, coverage, health("lidar_scale"),
      health("lidar_scale_sigma"), health("imu_rotation_slope"), health("imu_rest_force_share"),
      health("rest_gravity_missed_rad"), health("rest_gravity_missed_sigma_rad"), health("rest_velocity_share"),
      health("rest_velocity_allowed_share"), health("pivot_evidence"), health("pivot_segments"), health("pivot_scale"),
      health("pivot_scale_sigma"),
      wrong && !says ? "  <- silently wrong" : (!wrong && says && harm == "none" ? "  <- false alarm" : ""));
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
  Tallies tallies;
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
      if (is_of_kind(harm, method.info.kind)) judge(method, draw, surface ? &*surface : nullptr, harm, tallies);
    }
  }
  tallies.reported.print("by the covariance reported");
  if (kind == "rate") tallies.before.print("by the covariance before any telling");
  if (kind == "slam") tallies.root_chi2.print("by the root of chi-square");
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
