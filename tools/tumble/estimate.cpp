// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/estimate_file.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/methods/given_parameters.hpp"
#include "scenarios/methods/prior_map_file.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/learnt_file.hpp"
#include "tools/tumble/trouble_place.hpp"
#include "tools/tumble/verbs.hpp"
#include "tools/tumble/verdict_lines.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

struct EstimateOptions {
  std::filesystem::path recording;
  std::string method;
  std::vector<std::string> parameters;
  std::filesystem::path folder;
  std::filesystem::path learnt;
  std::filesystem::path map;
  std::vector<double> map_pose;  ///< x y z [m] and heading [rad], with two standard deviations [m, rad]
  bool map_frozen = false;
};

/// Returns why a run failed; names the required sensors if the recording lacks sensors.
std::string reason(const Status& status, const sim::Sensors& sensors) {
  const std::string field = status.field;
  if (status.trouble == Trouble::empty && field == "imus") return "the method needs an IMU, and the recording has none";
  const std::string place = trouble_place(status, sensors);
  return status.message() + (place.empty() ? "" : ": " + place);
}

/// Returns the method with this name that can run on this recording without the truth.
scenarios::MethodPointer choose(const std::string& name, const scenarios::Subject& subject) {
  std::vector<scenarios::MethodPointer> fitting;
  std::string refused;
  for (const scenarios::MethodPointer& method : scenarios::find_methods(name)) {
    if (method->info.needs_truth) {
      refused = "method '" + full_name(method->info) +
                "' needs the truth, which this verb never reads; use 'tumble run' instead";
    } else if (const std::string why = method->info.why_not(subject); !why.empty()) {
      refused = "method '" + full_name(method->info) + "': it " + why;
    } else {
      fitting.push_back(method);
    }
  }
  if (fitting.empty()) throw BadInput(refused);
  if (fitting.size() > 1) {
    std::string line = "--method " + name + " names several methods; choose one of:";
    for (const scenarios::MethodPointer& method : fitting) line += " " + full_name(method->info);
    throw BadInput(line);
  }
  return fitting.front();
}

/// Returns the prior map of the options.
std::shared_ptr<const PriorMap> read_map_of(const EstimateOptions& options) {
  constexpr std::size_t kPose = 4, kWithSigmas = 6;
  auto map = std::make_shared<PriorMap>();
  map->points = scenarios::read_prior_map(options.map);
  map->extend = !options.map_frozen;
  const std::vector<double>& pose = options.map_pose;
  if (pose.size() != 0 && pose.size() != kPose && pose.size() != kWithSigmas)
    throw BadInput(fmt::format("--map-pose has {} numbers; it needs X Y Z HEADING or X Y Z HEADING SIGMA_M SIGMA_RAD",
                               pose.size()));
  if (!pose.empty()) {
    map->T_MI = Eigen::Translation3d(pose[0], pose[1], pose[2]) * Eigen::AngleAxisd(pose[3], Eigen::Vector3d::UnitZ());
    if (pose.size() == kWithSigmas) map->sigma_m = pose[4], map->sigma_rad = pose[5];
  }
  if (const Status status = check_prior_map(*map); !status.ok())
    throw BadInput(options.map.string() + ": " + status.message());
  return map;
}

/// Returns `method` with the prior map of the options, if any.
scenarios::Method with_prior_map(const scenarios::Method& method, const EstimateOptions& options) {
  if (options.map.empty()) {
    if (!options.map_pose.empty() || options.map_frozen) throw BadInput("--map-pose and --map-frozen need --map");
    return method;
  }
  std::optional<scenarios::Method> localised = scenarios::localised_in(method, read_map_of(options));
  if (!localised)
    throw BadInput("--map is for slam/tumble_live and slam/tumble_lag; '" + full_name(method.info) +
                   "' does not localise itself in a prior map");
  return *localised;
}

/// States from which sweep on the poses are in the prior map.
std::string localisation_text(const scenarios::Estimate& estimate) {
  const auto first = std::find_if(estimate.sweeps.begin(), estimate.sweeps.end(),
                                  [](const SweepReport& sweep) { return sweep.in_prior_map; });
  if (first == estimate.sweeps.end()) return "not localised in the prior map; poses are in a local frame";
  return fmt::format("localised in the prior map; poses are in its frame from sweep {} of {} on",
                     first - estimate.sweeps.begin() + 1, estimate.sweeps.size());
}

/// Converts a failure of an external command to BadInput.
scenarios::Estimate run_of(const scenarios::Method& method, const sim::Sensors& sensors) {
  try {
    return method.run(sensors, {}, {});
  } catch (const scenarios::NoAnswer& error) {
    throw BadInput(full_name(method.info) + ": " + error.what());
  }
}

/// Health counters that the table shows; --json and estimate.json contain all counters.
struct ShownCounter {
  const char *name, *meaning, *unit;
};
constexpr ShownCounter kShownCounters[] = {
    {"readings_missing", "IMU readings that are missing", ""},
    {"sweeps_registered", "sweeps aligned with the map", ""},
    {"end_sigma_m", "standard deviation of the last position", "m"},
    {"end_sigma_rad", "standard deviation of the last attitude", "rad"},
};

/// Lists the content of an estimate, with units.
Table summary(const scenarios::Estimate& estimate) {
  Table table("", {"estimate", "value", "unit"});
  table.align_right_from(1);
  table.add_row({"status", estimate.status.message(), ""});
  const auto count = [&](const char* what, const auto& rows) {
    if (!rows.empty()) table.add_row({what, std::to_string(rows.size()), ""});
  };
  const auto cover = [&](const char* what, const auto& states) {
    count(what, states);
    if (states.empty()) return;
    const double covered_s = 1e-9 * static_cast<double>(states.back().time_ns - states.front().time_ns);
    table.add_row({std::string("time from the first to the last of the ") + what, number_text(covered_s), "s"});
  };
  cover("angular rates", estimate.rates);
  cover("attitudes", estimate.attitudes);
  cover("poses", estimate.poses);
  count("sweeps", estimate.sweeps);
  count("map points", estimate.map);
  for (const ShownCounter& shown : kShownCounters) {
    for (const auto& [name, value] : estimate.health)
      if (name == shown.name) table.add_row({shown.meaning, number_text(value), shown.unit});
  }
  return table;
}

int run_estimate(const Session& session, const EstimateOptions& options) {
  const sim::Sensors sensors = scenarios::read_sensors(options.recording);
  const scenarios::MethodPointer chosen = choose(options.method, {sensors.robot, !sensors.lidars.empty()});
  const scenarios::Method& method = *chosen;
  if (!options.learnt.empty() && !method.info.learns_rig) {
    throw BadInput("--learnt is for " + LearntFile::learning_methods() + "; '" + full_name(method.info) +
                   "' does not calibrate the rig");
  }
  LearntFile learnt(options.learnt);
  const scenarios::Method learning = learnt.wrap(with_prior_map(method, options));
  const scenarios::MethodPointer selected[] = {scenarios::unowned(learning)};
  const std::vector<scenarios::Method> methods = scenarios::with_parameters(selected, options.parameters);
  scenarios::OutputFolder folder(options.folder);
  learnt.require_place();
  note_time_limits(session, std::span(&options.method, 1));
  scenarios::Estimate estimate = run_of(methods.front(), sensors);
  if (!scenarios::states_digest(options.recording)) add_doubt({scenarios::Doubt::About::digest}, estimate);
  scenarios::write_estimate(options.folder, method.info.name, method.info.kind, estimate,
                            scenarios::digest(sensors, nullptr));
  if (!estimate.map.empty()) scenarios::write_prior_map(options.folder / scenarios::kPriorMapName, estimate.map);
  learnt.keep(session);
  folder.keep();

  const nlohmann::json document = {{"method", method.info.name},
                                   {"kind", to_string(method.info.kind)},
                                   {"status", estimate.status.ok() ? "ok" : "failed"},
                                   {"message", estimate.status.message()},
                                   {"digest", scenarios::digest(estimate)},
                                   {"health", estimate.health}};
  session.print({summary(estimate)}, document);
  session.note(fmt::format("all {} health counters: --json, or {}", estimate.health.size(),
                           (options.folder / "estimate.json").string()));
  if (const std::string caution = learnt.caution(sensors); !caution.empty()) session.note(caution);
  if (!options.map.empty()) session.note(options.map.string() + ": " + localisation_text(estimate));
  // printed also after a failure, because a sensor fault may be the cause
  for (const std::string& line : verdict_lines(estimate)) session.note(full_name(method.info) + ": " + line);
  if (estimate.status.ok()) return kDone;
  // the estimate is kept for inspection; the cause is in the recording
  throw BadInput(options.recording.string() + ": " + full_name(method.info) +
                 " failed: " + reason(estimate.status, sensors));
}

}  // namespace

Action declare_estimate(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<EstimateOptions>();
  verb.add("RECORDING", options->recording, "recording, FILE.h5").required().check(a_recording);
  verb.add("--method", options->method, "method, for example 'saave' or 'rate/saave'").required();
  verb.add("--set", options->parameters,
           "METHOD.PARAMETER=NUMBER, for example rate/tumble_lag.lag_s=0.5; repeat for more ('tumble list methods "
           "NAME')")
      .one_at_a_time();
  verb.add("-o,--output", options->folder, "folder for the estimate").required();
  verb.add("--learnt", options->learnt,
           "FILE.json with the calibration of the rig from an earlier run of 'rate/tumble' or 'rate/tumble_lag', if it "
           "exists; receives the calibration of this run");
  verb.add(
      "--map", options->map,
      "map of an earlier run, in which 'slam/tumble_live' or 'slam/tumble_lag' localises itself: map.tumblemap of an "
      "estimate, or a PCD or PLY file");
  verb.add("--map-pose", options->map_pose,
           "X Y Z HEADING of the IMU in the map at the start [m, rad], and its standard deviations SIGMA_M SIGMA_RAD "
           "[exact; without the option, the whole map is searched]");
  verb.add_flag("--map-frozen", options->map_frozen, "keeps the map unchanged; otherwise sweeps extend the map");
  return [&session, options] { return run_estimate(session, *options); };
}

}  // namespace tumble::tools
