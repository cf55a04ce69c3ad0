// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/external/turning_sense.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/given_estimate.hpp"
#include "tools/tumble/recording_info.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct ScoreOptions {
  std::filesystem::path estimate, recording;
  std::string frame, kind;
};

void order(ScoreOptions& options) {
  const auto is_recording = [](const std::filesystem::path& file) {
    return file.extension() == ".h5" || file.extension() == ".hdf5";
  };
  if (is_recording(options.estimate) && !is_recording(options.recording)) options.estimate.swap(options.recording);
}

void require_common_time(const ScoreOptions& options, const scenarios::Estimate& estimate, const sim::Truth& truth) {
  const bool known = std::any_of(truth.p_WB_m.begin(), truth.p_WB_m.end(), [](const auto& p) { return p.allFinite(); });
  if (!known)
    throw scenarios::BadInput(
        fmt::format("{}: the truth of this recording contains no known position, so poses cannot be scored",
                    options.recording.string()));
  if (estimate.poses.empty()) return;
  const double end_s = 1e-9 * static_cast<double>(truth.period_ns) * static_cast<double>(truth.p_WB_m.size() - 1);
  const double first_s = 1e-9 * static_cast<double>(estimate.poses.front().time_ns);
  const double last_s = 1e-9 * static_cast<double>(estimate.poses.back().time_ns);
  if (first_s <= end_s && last_s >= 0.0) return;
  throw scenarios::BadInput(
      fmt::format("{}: the poses cover {:.3f} s to {:.3f} s, but the truth of {} covers 0 to {:.3f} s; shift the "
                  "time stamps of the poses to the start of the recording",
                  options.estimate.string(), first_s, last_s, options.recording.string(), end_s));
}

constexpr double kHoleShare = 0.2;  // longer gaps are a divergence
// With fewer poses within the truth, little more than the aligned first pose would be compared.
constexpr std::size_t kComparedMin = 2;
constexpr double kSpannedShareMin = 0.01;

struct Standing {
  double first_s = 0, last_s = 0, end_s = 0;  ///< within the truth; end of the truth
  std::size_t compared = 0, poses = 0;        ///< within the truth; all
  double covered_s = 0;                       ///< without gaps
  scenarios::Alignment alignment;
  double spanned() const { return end_s > 0.0 ? (last_s - first_s) / end_s : 1.0; }
  double share() const { return end_s > 0.0 ? covered_s / end_s : 1.0; }
};

Standing standing_of(const scenarios::Estimate& estimate, const sim::Truth& truth) {
  const scenarios::TruthTrack track(truth, estimate.frame);
  const scenarios::PairedTrack paired = scenarios::pair_poses(estimate, track);
  Standing out;
  out.end_s = 1e-9 * static_cast<double>(track.last_ns());
  out.alignment = paired.alignment;
  out.compared = paired.poses.size();
  out.poses = estimate.poses.size();
  if (paired.poses.empty()) return out;
  out.first_s = 1e-9 * static_cast<double>(paired.poses.front().time_ns);
  out.last_s = 1e-9 * static_cast<double>(paired.poses.back().time_ns);
  for (std::size_t k = 1; k < paired.poses.size(); ++k) {
    const double step_s = 1e-9 * static_cast<double>(paired.poses[k].time_ns - paired.poses[k - 1].time_ns);
    if (step_s <= kHoleShare * out.end_s) out.covered_s += step_s;
  }
  return out;
}

void require_seconds(const ScoreOptions& options, const scenarios::Estimate& estimate, const Standing& standing) {
  constexpr double kNear = 1.5, kLeastStep_s = 0.1;
  if (estimate.poses.size() < 2 || !(standing.end_s > 0.0)) return;
  const double length_s = 1e-9 * static_cast<double>(estimate.poses.back().time_ns - estimate.poses.front().time_ns);
  if (length_s < kLeastStep_s * static_cast<double>(estimate.poses.size() - 1)) return;
  const double factor = length_s / standing.end_s;
  for (const auto& [unit, of_second] : {std::pair("ms", 1e3), std::pair("us", 1e6), std::pair("ns", 1e9)}) {
    if (factor > kNear * of_second || kNear * factor < of_second) continue;
    throw scenarios::BadInput(fmt::format(
        "{}: only {} of {} poses are within the duration of {}, which is {:.3f} s. The poses cover {:.3f} s, which is "
        "{:.0f} times the duration of the recording. The time unit of the file may be {}; the unit must be seconds",
        options.estimate.string(), standing.compared, standing.poses, options.recording.string(), standing.end_s,
        length_s, factor, unit));
  }
}

void require_compared(const ScoreOptions& options, const Standing& standing) {
  if (standing.compared >= kComparedMin && standing.spanned() >= kSpannedShareMin) return;
  throw scenarios::BadInput(fmt::format(
      "{}: {} of {} poses are within the duration of {}. These poses cover {:.1f} % of {:.3f} s; a score needs at "
      "least {} poses that cover {:.0f} % of the recording. Check the time unit and the clock of the file",
      options.estimate.string(), standing.compared, standing.poses, options.recording.string(),
      100.0 * standing.spanned(), standing.end_s, kComparedMin, 100.0 * kSpannedShareMin));
}

std::string alignment_text(const Standing& standing) {
  const Eigen::Vector3d& t = standing.alignment.translation_m;
  return fmt::format(
      "the estimate is aligned in position and yaw at the first pose within the truth ({:.3f} s): rotation {:.6g} rad "
      "about the vertical, translation ({:.6g}, {:.6g}, {:.6g}) m. Scale and tilt are not aligned",
      standing.first_s, standing.alignment.yaw_rad, t.x(), t.y(), t.z());
}

std::string cover_text(const Standing& standing) {
  return fmt::format("{:.1f} % of the recording's time ({:.3f} s to {:.3f} s of {:.3f} s) with {} of {} poses",
                     100.0 * standing.share(), standing.first_s, standing.last_s, standing.end_s, standing.compared,
                     standing.poses);
}

/// The status "partial" means no divergence in the trajectory's part of the truth's time, but a gap of more than a
/// fifth of the recording.
std::string judge_trajectory(const Session& session, const Standing& standing, const scenarios::ScoredEstimate& scored,
                             scenarios::Outcome& outcome) {
  std::string status = to_string(outcome.status);
  if (outcome.status == scenarios::OutcomeStatus::diverged && scenarios::trajectory_holds(scored)) {
    status = "partial";
    outcome.status = scenarios::OutcomeStatus::ok;
    outcome.message = "covers " + cover_text(standing);
  }
  session.note("scored as " + std::string(to_string(outcome.kind)) + ", covers " + cover_text(standing));
  session.note(alignment_text(standing));
  return status;
}

nlohmann::json to_json(const Standing& standing) {
  const Eigen::Vector3d& t = standing.alignment.translation_m;
  return {{"covered",
           {{"first_s", standing.first_s},
            {"last_s", standing.last_s},
            {"share", standing.share()},
            {"compared", standing.compared},
            {"poses", standing.poses}}},
          {"alignment",
           {{"of", "position and yaw"},
            {"at_s", standing.first_s},
            {"yaw_rad", standing.alignment.yaw_rad},
            {"translation_m", {t.x(), t.y(), t.z()}}}}};
}

void add_cover(const Standing& standing, Table& table) {
  table.add_row({"covered_share", number_text(standing.share())});
  table.add_row({"poses_compared", fmt::format("{} of {}", standing.compared, standing.poses)});
}

scenarios::Kind kind_of(const std::string& name, const sim::Sensors& sensors) {
  if (name.empty()) {
    return sensors.lidars.empty() || sensors.sphere_radius_m > 0.0 ? scenarios::Kind::position : scenarios::Kind::slam;
  }
  const std::vector<std::string> known = {"position", "slam"};
  require_known("kind of a trajectory", name, known);
  return name == "slam" ? scenarios::Kind::slam : scenarios::Kind::position;
}

struct Claim {
  scenarios::RecordingInfo info;
  sim::Sensors sensors;
  sim::Truth truth;
  scenarios::Estimate estimate;
  scenarios::Kind kind = scenarios::Kind::position;
  std::string method;
  bool foreign = false;  ///< external, without its method
};

void complete_foreign(const Session& session, const ScoreOptions& options, Claim& claim) {
  claim.kind = kind_of(options.kind, claim.sensors);
  for (const auto& complain : {scenarios::turning_complaint, scenarios::clock_complaint}) {
    const std::string complaint = complain(claim.estimate, claim.sensors);
    if (!complaint.empty()) session.note("caution: " + complaint);
  }
}

Claim read_claim(const Session& session, const ScoreOptions& options) {
  Claim claim;
  claim.info = scenarios::read_info(options.recording);
  if (!claim.info.has_truth)
    throw scenarios::BadInput(
        fmt::format("{}: this recording contains no truth, so estimates cannot be scored; give a recording with truth",
                    options.recording.string()));
  claim.sensors = scenarios::read_sensors(options.recording);
  if (!scenarios::states_digest(options.recording))
    session.note(fmt::format("{}: this recording contains no digest of its data, so the program cannot detect damage",
                             options.recording.string()));
  claim.truth = scenarios::read_truth(options.recording);
  claim.estimate = read_given({options.estimate, options.recording, frame_of(options.frame, !claim.truth.imus.empty())},
                              claim.sensors, &claim.truth, claim.kind, claim.method);
  claim.foreign = !std::filesystem::is_directory(options.estimate);
  if (!claim.foreign && scenarios::estimated_sensors(options.estimate).empty())
    session.note(
        fmt::format("caution: {} does not name its recording, so the program cannot check that the estimate belongs to "
                    "the recording",
                    options.estimate.string()));
  if (!claim.foreign && !options.kind.empty())
    throw scenarios::BadInput(fmt::format("--kind applies to a TUM file only; {} states its own kind, so remove --kind",
                                          options.estimate.string()));
  if (claim.foreign) complete_foreign(session, options, claim);
  if (claim.kind == scenarios::Kind::position || claim.kind == scenarios::Kind::slam)
    require_common_time(options, claim.estimate, claim.truth);
  return claim;
}

/// Returns null if there is no map, because only maps need the surface, which takes long to build.
std::unique_ptr<const sim::Surface> surface_of(const Session& session, const ScoreOptions& options,
                                               const Claim& claim) {
  if (claim.kind != scenarios::Kind::slam || claim.foreign || claim.info.situation_yaml.empty()) return nullptr;
  return std::make_unique<const sim::Surface>(built_from(claim.info, options.recording.string(), session.data()));
}

scenarios::MethodInfo info_of(const Claim& claim) {
  for (const scenarios::Method& method : scenarios::methods())
    if (method.info.kind == claim.kind && method.info.name == claim.method) return method.info;
  scenarios::MethodInfo other;
  other.name = claim.method;
  other.kind = claim.kind;
  return other;
}

scenarios::Outcome outcome_of(const Claim& claim, const scenarios::ScoredEstimate& scored) {
  scenarios::Outcome outcome;
  outcome.kind = claim.kind;
  outcome.method = claim.method;
  outcome.scenario = claim.info.scenario;
  outcome.seed = claim.info.seed;
  outcome.scores = scenarios::score(claim.kind, scored);
  scenarios::judge_without_truth(info_of(claim), claim.estimate, outcome);
  const scenarios::OutcomeStatus by_truth = scenarios::verdict(claim.kind, scored);
  if (outcome.status == scenarios::OutcomeStatus::ok) outcome.status = by_truth;
  return outcome;
}

void print_scores(const Session& session, const ScoreOptions& options, const scenarios::Outcome& outcome,
                  const std::string& status, const std::optional<Standing>& standing) {
  const std::vector<scenarios::Outcome> outcomes = {outcome};
  nlohmann::json document = {{"kind", to_string(outcome.kind)},
                             {"method", outcome.method},
                             {"status", status},
                             {"scores", score_rows(outcomes)}};
  std::vector<Table> tables = score_tables(options.estimate.string(), outcomes, status);
  if (standing) {
    document.update(to_json(*standing));
    add_cover(*standing, tables.front());
  }
  session.print(tables, document);
}

int score_estimate(const Session& session, const ScoreOptions& options) {
  const Claim claim = read_claim(session, options);
  const std::unique_ptr<const sim::Surface> surface = surface_of(session, options, claim);
  std::optional<Standing> standing;
  if (claim.foreign) {
    standing = standing_of(claim.estimate, claim.truth);
    require_seconds(options, claim.estimate, *standing);
    require_compared(options, *standing);
  }
  const scenarios::ScoredEstimate scored(claim.estimate, {&claim.sensors, &claim.truth, surface.get()});
  scenarios::Outcome outcome = outcome_of(claim, scored);
  std::string status = to_string(outcome.status);
  if (standing) status = judge_trajectory(session, *standing, scored, outcome);
  print_scores(session, options, outcome, status, standing);
  return kDone;
}

}  // namespace

Action declare_score(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<ScoreOptions>();
  verb.add("ESTIMATE", options->estimate, "scores this estimate: a folder, or a TUM file (t x y z qx qy qz qw)")
      .required();
  verb.add("RECORDING", options->recording,
           "compares with the truth of this recording, FILE.h5; estimate and recording may be in any order")
      .required();
  verb.add("--frame", options->frame,
           "sets the frame of the poses in a TUM file: imu, lidar, body or centre [default: imu; body if the recording "
           "has no IMU]");
  verb.add("--kind", options->kind,
           "sets the kind of a TUM file: position or slam. The kind slam also scores the rotation at the end [default: "
           "slam if the recording has a lidar and no rolling sphere, otherwise position]");
  return [&session, options] {
    order(*options);
    a_recording(options->recording.string());
    return score_estimate(session, *options);
  };
}

}  // namespace tumble::tools
