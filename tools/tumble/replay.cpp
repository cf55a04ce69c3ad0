// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/replay.hpp"

#include <fmt/format.h>

#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "sim/lidar/surface.hpp"
#include "tools/replay/page.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/given_estimate.hpp"
#include "tools/tumble/recording_info.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct ReplayOptions {
  std::filesystem::path recording, page;
  std::vector<std::filesystem::path> estimates;
  std::string frame;
  std::size_t points = ReplayLimits{}.points;
};

struct ReplayContent {
  sim::Sensors sensors;
  std::optional<sim::Truth> truth;
  std::optional<sim::BuiltSituation> built;
  std::optional<sim::Surface> surface;
  std::list<scenarios::Estimate> estimates;
};

void load_recording(const Session& session, const ReplayOptions& options, const scenarios::RecordingInfo& info,
                    ReplayContent& content) {
  content.sensors = scenarios::read_sensors(options.recording);
  if (info.has_truth) content.truth = scenarios::read_truth(options.recording);
  if (info.situation_yaml.empty()) return;
  content.built = built_from(info, options.recording.string(), session.data());
  content.surface.emplace(*content.built);
}

void load_estimates(const Session& session, const ReplayOptions& options, ReplayContent& content, ReplayInput& input) {
  const scenarios::Frame frame = frame_of(options.frame, !content.sensors.imus.empty());
  for (const std::filesystem::path& path : options.estimates) {
    scenarios::Kind kind;
    std::string method;
    scenarios::Estimate estimate = read_given({path, options.recording, frame}, content.sensors,
                                              content.truth ? &*content.truth : nullptr, kind, method);
    if (estimate.poses.empty() && estimate.rates.empty()) {
      session.note(
          fmt::format("{}: this estimate is left out, because it contains neither poses nor rates", path.string()));
      continue;
    }
    content.estimates.push_back(std::move(estimate));
    const std::string name = std::filesystem::is_directory(path) ? full_name(kind, method) : method;
    input.estimates.push_back({name, &content.estimates.back()});
  }
}

std::string title_of(const scenarios::RecordingInfo& info, const std::filesystem::path& recording) {
  return info.scenario.empty() ? recording.filename().string() : fmt::format("{}, seed {}", info.scenario, info.seed);
}

int make_replay(const Session& session, const ReplayOptions& options) {
  std::vector<std::filesystem::path> inputs = {options.recording};
  inputs.insert(inputs.end(), options.estimates.begin(), options.estimates.end());
  prepare_file(options.page, inputs, {".html"});
  const scenarios::RecordingInfo info = scenarios::read_info(options.recording);
  ReplayContent content;
  load_recording(session, options, info, content);
  ReplayInput input;
  input.title = title_of(info, options.recording);
  if (!info.attribution.empty()) input.facts.emplace_back("recorded by", info.attribution);
  input.sensors = &content.sensors;
  input.truth = content.truth ? &*content.truth : nullptr;
  input.built = content.built ? &*content.built : nullptr;
  input.surface = content.surface ? &*content.surface : nullptr;
  load_estimates(session, options, content, input);
  ReplayLimits limits;
  limits.points = options.points;
  const Replay replay = replay_of(input, limits);
  const std::string page = replay_page(replay);
  scenarios::replace_file(options.page, page);

  Table table("", {"replay", options.page.string()});
  nlohmann::json document = {{"page", options.page.string()},
                             {"bytes", page.size()},
                             {"points", {{"shown", replay.points.p_B_m.size()}, {"of", replay.points.of}}},
                             {"triangles", {{"shown", replay.triangles.shown}, {"of", replay.triangles.of}}},
                             {"paths", nlohmann::json::array()}};
  table.add_row({"bytes", std::to_string(page.size())});
  table.add_row({"points", fmt::format("{} of {}", replay.points.p_B_m.size(), replay.points.of)});
  table.add_row({"triangles of the world", fmt::format("{} of {}", replay.triangles.shown, replay.triangles.of)});
  for (const ReplayActor& actor : replay.actors) {
    table.add_row({actor.name, actor.colour});
    document["paths"].push_back({{"path", actor.name}, {"colour", actor.colour}});
  }
  session.print({table}, document);
  return kDone;
}

}  // namespace

Action declare_replay(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<ReplayOptions>();
  verb.add("RECORDING", options->recording, "plays this recording, FILE.h5, with or without truth")
      .required()
      .check(a_recording);
  verb.add("ESTIMATE", options->estimates,
           "shows these estimates: folders of estimates, or TUM files (t x y z qx qy qz qw)");
  verb.add("-o,--output", options->page, "writes this page, FILE.html").required();
  verb.add("--frame", options->frame,
           "sets the frame of the poses in a TUM file: imu, lidar, body or centre [default: imu; body if the recording "
           "has no IMU]");
  verb.add("--points", options->points,
           "limits the number of lidar points. The page may show fewer points, because the size of the page is limited "
           "to 3 MB")
      .whole(0, 200000)
      .shows_default();
  return [&session, options] { return make_replay(session, *options); };
}

}  // namespace tumble::tools
