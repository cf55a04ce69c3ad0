// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/scoring/registered_sweeps.hpp"

namespace tumble::scenarios {

const Score* find_score(std::span<const Score> scores, const std::string& metric) {
  const auto found =
      std::find_if(scores.begin(), scores.end(), [&](const Score& score) { return score.metric == metric; });
  return found == scores.end() ? nullptr : &*found;
}

double value_of(std::span<const Score> scores, const std::string& metric) {
  const Score* const score = find_score(scores, metric);
  return score == nullptr ? kNaN : score->value;
}

namespace {

// Longest accepted gap of an estimate, as a fraction of the recording
constexpr double kHoleMaxShare = 0.2;
// Smallest accepted fraction of gyro samples with an estimated rate
constexpr double kAnsweredMin = 0.9;
constexpr double kEndErrorFloorM = 1.0;

std::vector<Metric> all_metrics() {
  std::vector<Metric> all;
  for (const auto& family :
       {rate_metrics(), binned_rate_metrics(), reference_rate_metrics(), attitude_metrics(), position_metrics(),
        slip_metrics(), trajectory_metrics(Kind::position), end_pose_metrics(), trajectory_metrics(Kind::slam),
        map_metrics(), sweep_border_metrics(), time_offset_metrics(), health_metrics()}) {
    all.insert(all.end(), family.begin(), family.end());
  }
  return all;
}

std::int64_t sensors_start_ns(const sim::Sensors& sensors, Kind kind) {
  std::int64_t start_ns = 0;
  if (!sensors.imus.empty() && !sensors.imus.front().time_ns.empty())
    start_ns = std::max(start_ns, sensors.imus.front().time_ns.front());
  if (kind == Kind::slam && !sensors.lidars.empty() && !sensors.lidars.front().sweep_start_ns.empty())
    start_ns = std::max(start_ns, sensors.lidars.front().sweep_start_ns.front());
  return start_ns;
}

template <typename State>
bool reaches(const std::vector<State>& states, std::int64_t start_ns, std::int64_t end_ns) {
  const double hole_max = kHoleMaxShare * static_cast<double>(end_ns);
  std::int64_t previous = start_ns;
  for (const State& state : states) {
    if (static_cast<double>(state.time_ns - previous) > hole_max) return false;
    previous = state.time_ns;
  }
  return !states.empty() && static_cast<double>(end_ns - previous) <= hole_max;
}

bool rates_hold(const ScoredEstimate& scored) {
  const std::vector<PairedRate>& pairs = paired_rates(scored);
  for (const AngularRateState& rate : scored.estimate().rates) {
    if (!rate.w_WI_I_rad_s.allFinite() || !rate.covariance_rad2_s2.allFinite()) return false;
  }
  const auto answered =
      std::count_if(pairs.begin(), pairs.end(), [](const PairedRate& pair) { return pair.truth.has_value(); });
  return static_cast<double>(answered) >= kAnsweredMin * static_cast<double>(clipping_truth(scored).known_samples());
}

bool attitudes_hold(const ScoredEstimate& scored) {
  const TruthTrack& truth = truth_track(scored);
  for (const AttitudeState& attitude : scored.estimate().attitudes) {
    if (!attitude.orientation_W.coeffs().allFinite()) return false;
  }
  return reaches(scored.estimate().attitudes, sensors_start_ns(scored.sensors(), Kind::attitude), truth.last_ns());
}

constexpr double kFarthest_m = 1e7;

bool poses_hold(const ScoredEstimate& scored) {
  for (const PoseState& pose : scored.estimate().poses) {
    if (!pose.position_W_m.allFinite() || !pose.orientation_W.coeffs().allFinite()) return false;
    if (pose.position_W_m.cwiseAbs().maxCoeff() > kFarthest_m) return false;
  }
  const PairedTrack& track = paired_track(scored);
  if (track.poses.empty()) return false;
  const PairedPose& end = track.poses.back();
  const double path_m = end.path_m - track.poses.front().path_m;
  return (end.estimate.position_W_m - end.truth.position_W_m).norm() <= std::max(path_m, kEndErrorFloorM);
}

bool poses_reach_and_hold(Kind kind, const ScoredEstimate& scored) {
  return reaches(scored.estimate().poses, sensors_start_ns(scored.sensors(), kind), truth_track(scored).last_ns()) &&
         poses_hold(scored);
}

bool sweeps_hold(const ScoredEstimate& scored) {
  const Estimate& estimate = scored.estimate();
  for (const auto& sweep : estimate.sweeps) {
    if (!sweep.pose.position_W_m.allFinite() || !sweep.pose.orientation_W.coeffs().allFinite()) return false;
  }
  if (estimate.sweeps.empty() || scored.sensors().lidars.empty()) return true;
  const std::size_t given = scored.sensors().lidars.front().sweep_start_ns.size();
  return given <= kStartSweep || registered_sweeps(estimate).size() >= kStartSweep;
}

bool holds(Kind kind, const ScoredEstimate& scored) {
  switch (kind) {
    case Kind::rate:
      return rates_hold(scored);
    case Kind::attitude:
      return attitudes_hold(scored);
    case Kind::position:
      return poses_reach_and_hold(kind, scored);
    case Kind::slam:
      return poses_reach_and_hold(kind, scored) && sweeps_hold(scored);
  }
  return false;
}

}  // namespace

double rms(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::span<const Metric> metrics() {
  static const std::vector<Metric> all = all_metrics();
  return all;
}

std::vector<Score> score(Kind kind, const ScoredEstimate& scored) {
  std::vector<Score> scores;
  for (const Metric& metric : metrics()) {
    double value = 0.0;
    if (metric.kind == kind && metric.compute(scored, value)) scores.push_back({metric.info.name, value});
  }
  return scores;
}

OutcomeStatus verdict(Kind kind, const ScoredEstimate& scored) {
  return holds(kind, scored) ? OutcomeStatus::ok : OutcomeStatus::diverged;
}

bool trajectory_holds(const ScoredEstimate& scored) {
  return poses_hold(scored);
}

ScoredEstimate::ScoredEstimate(const Estimate& estimate, const ScoringInput& input)
    : estimate_(&estimate), input_(input) {
  if (input.sensors == nullptr || input.truth == nullptr) throw BadInput("scoring needs both sensor data and truth");
}

}  // namespace tumble::scenarios
