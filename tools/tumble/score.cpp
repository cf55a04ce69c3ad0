// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/estimate_file.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/score.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::Frame;

struct Options {
  std::filesystem::path estimate, recording;
  std::string frame;
};

/// Of the poses in a TUM file: as named, else of the first IMU, of the body where the recording has none.
Frame frame_of(const std::string& name, const sim::Truth& truth) {
  if (name.empty()) return truth.imus.empty() ? Frame::body : Frame::imu;
  std::vector<std::string> known;
  for (const Frame frame : {Frame::imu, Frame::lidar, Frame::body, Frame::centre}) {
    if (name == to_string(frame)) return frame;
    known.emplace_back(to_string(frame));
  }
  require_known("frame", name, known);
  return Frame::imu;
}

/// Somebody else's poses may bear the stamps of the recording's source: they are moved to the recording's own clock
/// when its origin is nearer to them than its zero.
void move_to_clock(std::int64_t origin_ns, scenarios::Estimate& estimate) {
  const std::int64_t first = estimate.poses.empty() ? 0 : estimate.poses.front().time_ns;
  if (std::abs(first - origin_ns) >= std::abs(first)) return;
  for (PoseState& pose : estimate.poses) pose.time_ns -= origin_ns;
}

/// An estimate says which sensors it was made from.
void require_own(const Options& options, const sim::Sensors& sensors) {
  const std::string made_from = scenarios::estimated_sensors(options.estimate);
  const std::string own = scenarios::digest(sensors, nullptr);
  if (made_from.empty() || made_from == own) return;
  throw scenarios::BadInput(options.estimate.string() +
                            ": was made from another recording (its sensors have the digest " + made_from +
                            ", those of " + options.recording.string() + " " + own + ")");
}

/// What was seen and what is claimed must share some time, and the truth must know something.
void require_common_time(const Options& options, const scenarios::Estimate& estimate, const sim::Truth& truth) {
  const bool known = std::any_of(truth.p_WB_m.begin(), truth.p_WB_m.end(), [](const auto& p) { return p.allFinite(); });
  if (!known) throw scenarios::BadInput(options.recording.string() + ": its truth holds no known place");
  if (estimate.poses.empty()) return;
  const double end_s = 1e-9 * static_cast<double>(truth.period_ns) * static_cast<double>(truth.p_WB_m.size() - 1);
  const double first_s = 1e-9 * static_cast<double>(estimate.poses.front().time_ns);
  const double last_s = 1e-9 * static_cast<double>(estimate.poses.back().time_ns);
  if (first_s <= end_s && last_s >= 0.0) return;
  throw scenarios::BadInput(
      fmt::format("{}: poses from {:.3f} s to {:.3f} s, but the truth of {} goes from 0 to {:.3f} s: another clock?",
                  options.estimate.string(), first_s, last_s, options.recording.string(), end_s));
}

int score_estimate(const Session& session, const Options& options) {
  const scenarios::RecordingInfo info = scenarios::read_info(options.recording);
  if (!info.has_truth) throw scenarios::BadInput(options.recording.string() + ": holds no truth to score against");
  const sim::Sensors sensors = scenarios::read_sensors(options.recording);
  const sim::Truth truth = scenarios::read_truth(options.recording);
  scenarios::Outcome outcome;
  scenarios::Estimate estimate =
      scenarios::read_estimate(options.estimate, outcome.kind, outcome.method, frame_of(options.frame, truth));
  require_own(options, sensors);
  if (!std::filesystem::is_directory(options.estimate)) move_to_clock(info.origin_ns, estimate);

  if (outcome.kind == scenarios::Kind::position || outcome.kind == scenarios::Kind::slam) {
    require_common_time(options, estimate, truth);
  }

  // the true surface matters to maps alone, and building it takes a while
  std::optional<sim::Surface> surface;
  if (outcome.kind == scenarios::Kind::slam && !info.situation_yaml.empty()) {
    surface.emplace(scenarios::situation_from_yaml(info.situation_yaml, options.recording.string()),
                    session.data().models());
  }
  const scenarios::ScoringInput input{&sensors, &truth, surface ? &*surface : nullptr};
  outcome.scenario = info.scenario;
  outcome.seed = info.seed;
  outcome.status =
      estimate.status.ok() ? scenarios::verdict(outcome.kind, estimate, input) : scenarios::OutcomeStatus::failed;
  outcome.message = estimate.status.ok() ? "" : estimate.status.message();
  outcome.scores = scenarios::score(outcome.kind, estimate, input);

  const std::vector<scenarios::Outcome> outcomes = {outcome};
  const nlohmann::json document = {{"kind", to_string(outcome.kind)},
                                   {"method", outcome.method},
                                   {"status", to_string(outcome.status)},
                                   {"scores", score_rows(outcomes)}};
  session.print(score_tables(options.estimate.string(), outcomes), document);
  return kDone;
}

}  // namespace

Action declare_score(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  app.add_option("ESTIMATE", options->estimate, "folder of an estimate, or a TUM file (t x y z qx qy qz qw)")
      ->required();
  app.add_option("RECORDING", options->recording, "the recording with its truth, FILE.h5")->required();
  app.add_option("--frame", options->frame,
                 "whose poses a TUM file holds: imu, lidar, body or centre [imu; body where the recording has none]");
  return [&session, options] { return score_estimate(session, *options); };
}

}  // namespace tumble::tools
