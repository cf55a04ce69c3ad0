// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "tools/pictures/map_pictures.hpp"
#include "tools/pictures/moving.hpp"
#include "tools/pictures/pictures.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/given_estimate.hpp"
#include "tools/tumble/progress.hpp"
#include "tools/tumble/recording_info.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

struct RenderOptions {
  std::string what, seed;
  std::vector<std::filesystem::path> estimates;
  std::filesystem::path output;
  int film = 0;
  bool map = false, video = false;
  double fps = 20.0, speed = 0.5;
  int columns = 4;
  int robots = 8;
  int width = 1280, height = 720;
};

struct RenderContent {
  std::optional<sim::BuiltSituation> built;
  sim::Sensors sensors;
  sim::Truth truth;
  Scene scene;
};

bool is_recording(const std::string& what) {
  // A folder is no recording, because the folder from 'tumble run hill' must not hide the scenario 'hill'.
  if (std::filesystem::exists(what) && !std::filesystem::is_directory(what)) return !what.ends_with(".yaml");
  return what.ends_with(".h5") || what.ends_with(".hdf5");
}

void load_situation(const scenarios::DataRoot& data, const RenderOptions& options, RenderContent& content) {
  const scenarios::RecordingInfo info = scenarios::read_info(options.what);
  if (info.situation_yaml.empty())
    throw BadInput(
        fmt::format("{}: this recording contains no description of its world, so its world cannot be rendered; give a "
                    "simulated recording",
                    options.what));
  content.built = built_from(info, options.what, data);
  content.sensors = scenarios::read_sensors(options.what);
  if (!info.has_truth)
    throw BadInput(
        fmt::format("{}: this recording contains no truth, so its path cannot be shown; give a recording with truth",
                    options.what));
  content.truth = scenarios::read_truth(options.what);
}

void load_recording(const scenarios::DataRoot& data, const RenderOptions& options, RenderContent& content) {
  load_situation(data, options, content);
  content.scene.sensors = &content.sensors;
  content.scene.truth = &content.truth;
  for (const std::filesystem::path& folder : options.estimates) {
    scenarios::Kind kind;
    std::string method;
    const scenarios::Estimate estimate =
        read_given({folder, options.what, scenarios::Frame::imu}, content.sensors, &content.truth, kind, method);
    Path path = estimated_path(estimate, content.sensors, content.truth);
    if (path.empty())
      throw BadInput(fmt::format("{}: this estimate contains no poses, so its path cannot be shown", folder.string()));
    path.name = scenarios::full_name(kind, method);
    content.scene.estimates.push_back(std::move(path));
  }
}

void load_draw(const scenarios::DataRoot& data, const RenderOptions& options, RenderContent& content) {
  const scenarios::Scenario scenario = scenarios::load_scenario(data, options.what);
  if (!options.estimates.empty())
    throw BadInput("estimates can be shown only with a recording; give FILE.h5 instead of a scenario");
  if (options.film > 0) throw BadInput(fmt::format("--film needs a recording; '{}' is a scenario", options.what));
  content.built.emplace(scenarios::draw(data, scenario, seed_of(scenario, options.seed)), data.models());
}

int render_maps(const Session& session, const RenderOptions& options, const scenarios::DataRoot& data) {
  if (!is_recording(options.what) || options.estimates.empty()) {
    throw BadInput("--map needs a recording and at least one estimate: FILE.h5 ESTIMATE...");
  }
  RenderContent content;
  load_situation(data, options, content);
  const sim::Surface surface(*content.built);
  std::vector<ErrorMap> maps;
  Table table("", {"map", "points", "within 0.1 m", "within 0.25 m"});
  table.align_right_from(1);
  nlohmann::json rows = nlohmann::json::array();
  for (const std::filesystem::path& folder : options.estimates) {
    scenarios::Kind kind;
    std::string method;
    const scenarios::Estimate estimate =
        read_given({folder, options.what, scenarios::Frame::imu}, content.sensors, &content.truth, kind, method);
    maps.push_back(map_by_error(full_name(kind, method), estimate, content.truth, surface));
    const ErrorMap& map = maps.back();
    if (map.points_W_m.empty())
      throw BadInput(fmt::format("{}: this estimate contains no map; give estimates of slam methods", folder.string()));
    const double fine = map.share_within(0.1f), coarse = map.share_within(0.25f);
    table.add_row({map.name, std::to_string(map.points_W_m.size()), fmt::format("{:.1f} %", 100.0 * fine),
                   fmt::format("{:.1f} %", 100.0 * coarse)});
    rows.push_back(
        {{"map", map.name}, {"points", map.points_W_m.size()}, {"within_0_10", fine}, {"within_0_25", coarse}});
  }
  save_picture(options.output, map_picture(maps, content.truth, options.width, options.height));
  session.print({table}, {{"picture", options.output.string()}, {"maps", rows}});
  return kDone;
}

/// More video frames than this would take minutes to render and to watch.
constexpr std::size_t kFramesMax = 3000;

constexpr double kSayEvery_s = 10.0;

std::vector<std::uint8_t> video_of(const Session& session, const RenderOptions& options, const Scene& scene) {
  MovingOptions moving;
  moving.width = options.width;
  moving.height = options.height;
  moving.frames_per_s = options.fps;
  moving.speed = options.speed;
  moving.strobe = options.robots;
  const Span span = moving_span(*scene.truth, 0.3);
  const std::size_t frames = frame_count(span, moving);
  if (frames > kFramesMax)
    throw BadInput(
        fmt::format("the video would have {} frames, but the maximum is {}; increase --speed or decrease --fps", frames,
                    kFramesMax));
  const double began_s = scenarios::now_s();
  double said_s = began_s;
  moving.drawn = [&](std::size_t done) {
    const double now_s = scenarios::now_s();
    if (now_s - said_s < kSayEvery_s) return;
    said_s = now_s;
    const double left_s = (now_s - began_s) * static_cast<double>(frames - done) / static_cast<double>(done);
    session.note(fmt::format("frame {} of {}, time left {}", done, frames, duration_text(left_s)));
  };
  return moving_picture(scene, span, moving);
}

void require_video(const RenderOptions& options) {
  if (!is_recording(options.what))
    throw BadInput(fmt::format("--video needs a recording; '{}' is a scenario", options.what));
  if (options.film > 0 || options.map) throw BadInput("--video, --film and --map exclude each other; give only one");
}

void write_picture(const Session& session, const RenderOptions& options, const Scene& scene) {
  if (options.video) {
    const std::vector<std::uint8_t> bytes = video_of(session, options, scene);
    scenarios::replace_file(options.output, std::as_bytes(std::span(bytes)));
  } else if (options.film > 0) {
    save_picture(options.output, film_picture(scene, options.film, options.columns, options.width, options.height));
  } else {
    save_picture(options.output, scene_picture(scene, options.robots, options.width, options.height));
  }
}

int render(const Session& session, const RenderOptions& options) {
  const scenarios::DataRoot data = session.data();
  if (options.video) require_video(options);
  std::vector<std::filesystem::path> inputs = options.estimates;
  inputs.emplace_back(options.what);
  prepare_file(options.output, inputs, {options.video ? ".webp" : ".png"});
  if (is_recording(options.what) && !options.seed.empty()) {
    throw BadInput(fmt::format("--seed applies to a scenario; '{}' is a recording of one simulated run", options.what));
  }
  if (options.map) return render_maps(session, options, data);
  RenderContent content;
  if (is_recording(options.what)) {
    load_recording(data, options, content);
  } else {
    load_draw(data, options, content);
  }
  content.scene.built = &content.built.value();
  write_picture(session, options, content.scene);
  Table legend("", {"path", "colour"});
  nlohmann::json document = {{"picture", options.output.string()}, {"paths", nlohmann::json::array()}};
  const auto add = [&](const std::string& name, Colour colour) {
    legend.add_row({name, colour.hex});
    document["paths"].push_back({{"path", name}, {"colour", colour.hex}});
  };
  if (content.scene.truth != nullptr) add("truth", truth_colour());
  for (std::size_t i = 0; i < options.estimates.size(); ++i) add(options.estimates[i].string(), method_colour(i));
  session.print(legend.empty() ? std::vector<Table>{} : std::vector<Table>{legend}, document);
  return kDone;
}

}  // namespace

Action declare_render(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<RenderOptions>();
  verb.add("WHAT", options->what,
           "renders this recording, FILE.h5. With --seed, renders one simulated run of this scenario")
      .required()
      .check([&session](const std::string& text) {
        if (is_recording(text)) return a_recording(text);
        scenarios::load_scenario(session.data(), text);
      });
  verb.add("ESTIMATE", options->estimates, "also shows the estimates in these folders");
  verb.add("--seed", options->seed,
           "sets the seed of the simulated run [default: for a named case, the seed of the case]");
  verb.add("-o,--output", options->output, "writes this picture, FILE.png, or with --video this animation, FILE.webp")
      .required();
  verb.add("--film", options->film, "renders a film strip with this number of frames").whole(1, 64);
  verb.add_flag("--map", options->map,
                "renders the maps of the estimates next to each other, coloured by error from 0 (blue) to 1 m (red)");
  verb.add_flag("--video", options->video,
                "writes an animated WebP: the camera follows the robot, and copies of the robot mark its path");
  verb.add("--fps", options->fps, "sets the number of frames per second of a video").within(1.0, 60.0).shows_default();
  verb.add("--speed", options->speed, "sets the speed of a video: seconds of motion per second of video")
      .within(0.01, 10.0)
      .shows_default();
  verb.add("--columns", options->columns, "sets the number of frames per row of the film strip")
      .whole(1, 64)
      .shows_default();
  verb.add("--robots", options->robots, "shows this number of robots along the path").whole(1, 64).shows_default();
  verb.add("--width", options->width, "sets the width of a picture or frame, pixels").whole(64, 4096).shows_default();
  verb.add("--height", options->height, "sets the height of a picture or frame, pixels")
      .whole(64, 4096)
      .shows_default();
  return [&session, options] { return render(session, *options); };
}

}  // namespace tumble::tools
