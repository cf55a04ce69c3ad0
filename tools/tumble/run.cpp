// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/estimates/findings.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/sweep/variation.hpp"
#include "tools/pictures/pictures.hpp"
#include "tools/replay/page.hpp"
#include "tools/replay/run_replay.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/recording_info.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::string scenario, seed;  ///< empty seed: 1, or the case's
  std::vector<std::string> methods, parameters;
  std::string vary;
  int threads = 1;
  fs::path folder;
};

bool is_bare(const RunOptions& options) {
  return options.methods.empty() && options.folder.empty() && options.parameters.empty() && options.vary.empty();
}

/// Returns the scenario's name, or the first of NAME_2, NAME_3, ... that does not exist as a folder.
fs::path free_folder(const std::string& name) {
  fs::path folder = name;
  for (int k = 2; fs::exists(fs::symlink_status(folder)); ++k) folder = fmt::format("{}_{}", name, k);
  return folder;
}

template <class Is>
const scenarios::MethodInfo* first_of(scenarios::Kind kind, Is is) {
  for (const scenarios::Method& method : scenarios::methods()) {
    if (method.info.kind == kind && !method.info.needs_truth && is(method.info)) return &method.info;
  }
  return nullptr;
}

const scenarios::MethodInfo* baseline_of(scenarios::Kind kind) {
  const scenarios::MethodInfo* const baseline = first_of(kind, [](const auto& info) { return info.baseline; });
  return baseline != nullptr ? baseline : first_of(kind, [](const auto&) { return true; });
}

/// The first run uses the reference method and `tumble` of each kind in which both can run on this scenario.
RunOptions first_run(RunOptions options, const scenarios::Scenario& scenario) {
  using scenarios::Kind;
  const scenarios::Subject subject = scenarios::subject_of(scenario);
  for (const Kind kind : scenarios::kKinds) {
    const scenarios::MethodInfo* const baseline = baseline_of(kind);
    const scenarios::MethodInfo* const ours = first_of(kind, [](const auto& info) { return info.ours; });
    if (baseline == nullptr || ours == nullptr || !baseline->applies_to(subject) || !ours->applies_to(subject))
      continue;
    options.methods.push_back(full_name(*baseline));
    options.methods.push_back(full_name(*ours));
  }
  options.folder = free_folder(scenario.name);
  return options;
}

void say_what_next(const Session& session, const RunOptions& options, const scenarios::RunResult& result,
                   bool in_catalogue) {
  const std::string folder = options.folder.string();
  session.note("next:");
  const auto say = [&](const std::string& command, const char* what) {
    session.note(fmt::format("  {:<78}  {}", command, what));
  };
  if (std::any_of(result.methods.begin(), result.methods.end(),
                  [](const auto& method) { return method->info.kind == scenarios::Kind::slam; })) {
    say(fmt::format("tumble render {0}/recording.h5 {0}/estimates/slam-* --map -o {0}/maps.png", folder),
        "renders the estimated maps, coloured by error");
  }
  say(fmt::format("tumble run {} --seed 2 -o {}_seed_2", options.scenario, folder),
      "runs every method on another simulated run");
  if (in_catalogue) {
    say(fmt::format("tumble sweep {0} --scenario {0} --seeds 1..8 --db {1}.db", options.scenario, folder),
        "runs every method on eight simulated runs");
    say(fmt::format("tumble report {0}.db -o {0}.html", folder), "prints the tables and writes a page with the tables");
  }
  say("tumble list methods", "lists all methods");
}

void leave_files(const fs::path& folder, const scenarios::RunResult& result) {
  const scenarios::RecordingInfo info = recording_info(result.built->situation(), result.recording_digest);
  scenarios::write_recording(folder / "recording.h5", info, result.recording.sensors, &result.recording.truth);
  scenarios::replace_file(folder / "situation.yaml", info.situation_yaml);
  const std::string sensors_digest = scenarios::digest(result.recording.sensors, nullptr);
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    const scenarios::MethodInfo& method = result.methods[i]->info;
    const fs::path own = folder / "estimates" / (std::string(to_string(method.kind)) + "-" + method.name);
    make_folder(own);
    scenarios::write_estimate(own, method.name, method.kind, result.estimates[i], sensors_digest);
  }
}

void leave_pictures(const fs::path& folder, const scenarios::RunResult& result) {
  Scene scene{&result.built.value(), &result.recording.sensors, &result.recording.truth, {}};
  for (const std::size_t i : shown_methods(result)) {  // as in the replay, so that both have the same colours
    Path path = estimated_path(result.estimates[i], result.recording.sensors, result.recording.truth);
    path.name = full_name(result.methods[i]->info);
    if (!path.empty()) scene.estimates.push_back(std::move(path));
  }
  make_folder(folder / "snapshots");
  save_picture(folder / "snapshots" / "scene.png",
               scene_picture(scene, result.recording.sensors.sphere_radius_m > 0.0 ? 3 : 8, 1280, 720));
  save_picture(folder / "snapshots" / "film.png", film_picture(scene, 8, 4, 480, 360));
  scenarios::replace_file(folder / "replay.html", replay_page(replay_of_run(result)));
}

std::vector<scenarios::MethodPointer> pointers(const std::vector<scenarios::Method>& methods) {
  std::vector<scenarios::MethodPointer> out;
  for (const scenarios::Method& method : methods) out.push_back(scenarios::unowned(method));
  return out;
}

scenarios::Setting setting_of(const scenarios::DataRoot& data, const RunOptions& options, std::uint64_t seed) {
  if (options.vary.empty()) return {};
  const scenarios::Setting setting = scenarios::setting_from(options.vary);
  scenarios::Variation variation{{}, {setting.value}};
  std::stringstream keys(setting.key);
  for (std::string key; std::getline(keys, key, '+');) variation.keys.push_back(key);
  scenarios::check(variation, data, std::vector<std::string>{options.scenario}, seed);
  return setting;
}

void say_troubles(const Session& session, const scenarios::RunResult& result) {
  for (std::size_t i = 0; i < result.outcomes.size(); ++i) {
    const scenarios::Outcome& outcome = result.outcomes[i];
    const std::string name = fmt::format("{}/{}: ", to_string(outcome.kind), outcome.method);
    if (outcome.status != scenarios::OutcomeStatus::ok)
      session.note(fmt::format("{}{}: {}", name, to_string(outcome.status), outcome.message));
    if (outcome.status == scenarios::OutcomeStatus::failed) continue;
    for (const HealthFinding& each : result.estimates[i].faults.findings)
      session.note(name + scenarios::report_text(each));
  }
}

std::uint64_t asked_seed(const RunOptions& options, const scenarios::Scenario& scenario) {
  const bool any_draw = options.seed.empty() && !scenario.named_case;
  return any_draw ? 1 : seed_of(scenario, options.seed);
}

std::vector<scenarios::MethodPointer> asked_methods(const RunOptions& options, const scenarios::Scenario& scenario) {
  std::vector<scenarios::MethodPointer> selected = select_methods(options.methods);
  if (!options.methods.empty() && scenarios::applicable(selected, scenarios::subject_of(scenario)).empty())
    scenarios::require_applies(*selected.front(), scenario);
  return selected;
}

void print_result(const Session& session, const scenarios::RunResult& result, std::uint64_t seed) {
  const std::string digest = scenarios::run_digest(result);
  const nlohmann::json document = {{"scenario", result.scenario},
                                   {"seed", seed},
                                   {"digest", digest},
                                   {"recording_digest", result.recording_digest},
                                   {"status", overall_status(result.outcomes)},
                                   {"scores", score_rows(result.outcomes)},
                                   {"outcomes", outcome_rows(result.outcomes)}};
  std::vector<Table> tables = score_tables(fmt::format("{}, seed {}", result.scenario, seed), result.outcomes);
  Table closing("", {"digest of the run", digest});
  closing.add_row({"digest of the recording", result.recording_digest});
  tables.push_back(std::move(closing));
  session.print(tables, document);
}

int run(const Session& session, const RunOptions& given) {
  const scenarios::DataRoot data = session.data();
  const scenarios::Scenario scenario = scenarios::load_scenario(data, given.scenario);
  const bool first = is_bare(given);
  const RunOptions options = first ? first_run(given, scenario) : given;
  const std::uint64_t seed = asked_seed(options, scenario);
  const std::vector<scenarios::MethodPointer> asked = asked_methods(options, scenario);
  const std::vector<scenarios::Method> methods = scenarios::with_parameters(asked, options.parameters);
  std::optional<scenarios::OutputFolder> folder;
  if (!options.folder.empty()) folder.emplace(options.folder);

  note_time_limits(session, options.methods);
  const scenarios::Setting setting = setting_of(data, options, seed);
  const scenarios::RunResult result = scenarios::run_situation(data, scenario, seed, pointers(methods), options.threads,
                                                               scenarios::Lidars::simulated, setting);
  if (folder) {
    leave_files(options.folder, result);
    leave_pictures(options.folder, result);
    folder->keep();
  }
  print_result(session, result, seed);
  say_troubles(session, result);
  if (const std::string moving = end_in_motion(result.recording.truth); !moving.empty()) session.note(moving);
  if (folder)
    session.note(
        fmt::format("the results are in {}/: recording.h5, situation.yaml, estimates/, snapshots/scene.png and "
                    "film.png, replay.html",
                    options.folder.string()));
  session.note("'tumble list metrics' explains the metrics");
  if (first) say_what_next(session, options, result, !given.scenario.ends_with(".yaml"));
  return kDone;
}

}  // namespace

Action declare_run(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<RunOptions>();
  verb.add("SCENARIO", options->scenario, "simulates this scenario of the catalogue, or this scenario file")
      .required()
      .check(a_scenario(session));
  verb.add("--seed", options->seed,
           "sets the seed of the simulated run [default: 1; for a named case, the seed of the case]");
  verb.add("--method", options->methods,
           "runs this method, for example 'saave' or 'rate/saave'; repeat the option for more methods [default: all "
           "methods that apply; exception: see the end of this help]")
      .one_at_a_time();  // one word per --method
  verb.add("--set", options->parameters,
           "sets a parameter of a method: METHOD.PARAMETER=NUMBER, for example rate/tumble_lag.lag_s=0.5; repeat the "
           "option for more parameters ('tumble list methods NAME' lists them)")
      .one_at_a_time();
  verb.add("--vary", options->vary,
           "sets a parameter of the scenario or an error of the methods' inputs: KEY=NUMBER, for example "
           "world.rock_count=10 or given.lever_arm_error_m=0.03");
  verb.add("--threads", options->threads,
           "uses this number of threads to simulate the lidar; the result is the same for any number")
      .whole(1, 1024)
      .shows_default();
  verb.add("-o,--output", options->folder,
           "writes recording, estimates, pictures and replay to this folder [default: writes nothing; exception: see "
           "the end of this help]");
  verb.footer(
      "With only a scenario and a seed, the program runs 'tumble' and the baseline method of each kind. The program "
      "then writes all results to a folder with the scenario's name.");
  return [&session, options] { return run(session, *options); };
}

}  // namespace tumble::tools
