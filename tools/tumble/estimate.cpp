// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/estimates/findings.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/chosen_method.hpp"
#include "tools/tumble/prior_map_options.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

struct EstimateOptions {
  std::filesystem::path recording;
  std::string method;
  std::vector<std::string> parameters;
  std::filesystem::path folder;
  PriorMapOptions prior_map;
};

struct ShownCounter {
  const char *name, *meaning, *unit;
};
constexpr ShownCounter kShownCounters[] = {
    {"readings_missing", "IMU readings that are missing", ""},
    {"sweeps_registered", "sweeps aligned with the map in all directions", ""},
    {"end_sigma_m", "standard deviation of the last position", "m"},
    {"end_sigma_rad", "standard deviation of the last attitude", "rad"},
};

Table summary(const scenarios::Estimate& estimate, scenarios::OutcomeStatus status) {
  Table table("", {"estimate", "value", "unit"});
  table.align_right_from(1);
  table.add_row({"status", estimate.status.ok() ? to_string(status) : estimate.status.message(), ""});
  const auto count = [&](const char* what, const auto& rows) {
    if (!rows.empty()) table.add_row({what, std::to_string(rows.size()), ""});
  };
  const auto cover = [&](const char* what, const auto& states) {
    count(what, states);
    if (states.empty()) return;
    const double covered_s = 1e-9 * static_cast<double>(states.back().time_ns - states.front().time_ns);
    table.add_row({fmt::format("time from the first to the last of the {}", what), number_text(covered_s), "s"});
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
  const scenarios::MethodPointer chosen = chosen_method(options.method, {sensors.robot, !sensors.lidars.empty()});
  const scenarios::Method& method = *chosen;
  const scenarios::Method asked = with_prior_map(method, options.prior_map);
  const scenarios::MethodPointer selected[] = {scenarios::unowned(asked)};
  const std::vector<scenarios::Method> methods = scenarios::with_parameters(selected, options.parameters);
  scenarios::OutputFolder folder(options.folder);
  note_time_limits(session, std::span(&options.method, 1));
  scenarios::Estimate estimate = run_method(session, methods.front(), sensors);
  const bool with_digest = scenarios::states_digest(options.recording);
  if (!with_digest) estimate.health["recording_without_digest"] = 1.0;
  scenarios::write_estimate(options.folder, method.info.name, method.info.kind, estimate,
                            scenarios::digest(sensors, nullptr), scenarios::read_info(options.recording).origin_ns);
  if (!estimate.map.empty()) scenarios::write_prior_map(options.folder / scenarios::kPriorMapName, estimate.map);
  folder.keep();

  scenarios::Outcome outcome;
  judge_without_truth(method.info, estimate, outcome);
  const nlohmann::json document = {{"method", method.info.name},
                                   {"kind", to_string(method.info.kind)},
                                   {"status", to_string(outcome.status)},
                                   {"message", outcome.message.empty() ? "ok" : outcome.message},
                                   {"digest", scenarios::digest(estimate)},
                                   {"health", estimate.health}};
  session.print({summary(estimate, outcome.status)}, document);
  session.note(fmt::format("--json and {1} contain all {0} health counters", estimate.health.size(),
                           (options.folder / "estimate.json").string()));
  if (!options.prior_map.map.empty()) session.note(localisation_text(options.prior_map, estimate));
  if (!with_digest) session.note("the recording contains no digest of its data, so the program cannot detect damage");
  for (const HealthFinding& each : estimate.faults.findings)
    session.note(full_name(method.info) + ": " + scenarios::report_text(each));
  if (estimate.status.ok()) return kDone;
  throw BadInput(options.recording.string() + ": " + full_name(method.info) +
                 " failed: " + failure_reason(estimate.status, sensors));
}

}  // namespace

Action declare_estimate(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<EstimateOptions>();
  verb.add("RECORDING", options->recording, "reads this recording, FILE.h5").required().check(a_recording);
  verb.add("--method", options->method, "runs this method, for example 'saave' or 'rate/saave'").required();
  verb.add("--set", options->parameters,
           "sets a parameter of a method: METHOD.PARAMETER=NUMBER, for example rate/tumble_lag.lag_s=0.5; repeat the "
           "option for more parameters ('tumble list methods NAME' lists them)")
      .one_at_a_time();
  verb.add("-o,--output", options->folder, "writes the estimate to this folder").required();
  declare_prior_map(verb, options->prior_map);
  return [&session, options] { return run_estimate(session, *options); };
}

}  // namespace tumble::tools
