// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/shrink.hpp"
#include "scenarios/methods/registry.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/cases/hold_case.hpp"
#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::BadInput;
using scenarios::Fate;
using scenarios::ShrinkLine;
using scenarios::Shrunk;

struct ShrinkVerbOptions {
  std::string scenario, seed, method, failure, control;
  int budget = scenarios::ShrinkOptions{}.budget;
  std::filesystem::path file;
};

/// A run on which even the oracle (method with true input) fails is no useful case.
scenarios::MethodPointer control_of(const ShrinkVerbOptions& options, const scenarios::Method& method,
                                    const scenarios::Scenario& scenario, double time_limit_s) {
  if (options.control == "none") return nullptr;
  if (!options.control.empty()) return one_method(options.control, time_limit_s);
  for (const scenarios::Method& each : scenarios::methods()) {
    const scenarios::MethodInfo& info = each.info;
    const bool other = info.kind != method.info.kind || info.name != method.info.name;
    if (other && info.kind == method.info.kind && info.name == "oracle" &&
        info.applies_to(scenarios::subject_of(scenario)))
      return scenarios::unowned(each);
  }
  return nullptr;
}

std::string amount_text(const std::optional<double>& value) {
  return value ? number_text(*value) : "";
}

Table lines_table(const Shrunk& shrunk, const std::string& metric) {
  Table table("", {"part of the simulated run", "fate", "from", "to", "without it: status", metric});
  for (const ShrinkLine& line : shrunk.lines) {
    table.add_row({line.what, to_string(line.fate), amount_text(line.from), amount_text(line.to),
                   line.without ? to_string(line.without->status) : "",
                   line.without ? number_text(value_of(line.without->scores, metric)) : ""});
  }
  return table;
}

Table outcomes_table(const Shrunk& shrunk, const std::string& metric) {
  Table table("", {"simulated run", "status", metric, "estimate took [s]"});
  const auto add = [&](const char* name, const scenarios::Outcome& outcome) {
    table.add_row({name, to_string(outcome.status), number_text(value_of(outcome.scores, metric)),
                   number_text(value_of(outcome.scores, "estimate_cpu_s"))});
  };
  add("as drawn", shrunk.drawn);
  add("shrunk", shrunk.left);
  return table;
}

json to_json(const Shrunk& shrunk, const std::string& metric, const ShrinkVerbOptions& options) {
  json lines = json::array();
  for (const ShrinkLine& line : shrunk.lines) {
    json row = {{"what", line.what}, {"fate", to_string(line.fate)}};
    if (line.from) row["from"] = *line.from;
    if (line.to) row["to"] = *line.to;
    if (line.without) {
      row["without"] = {{"status", to_string(line.without->status)},
                        {"value", finite(value_of(line.without->scores, metric))}};
    }
    lines.push_back(std::move(row));
  }
  const auto side = [&](const scenarios::Outcome& outcome) {
    return json{{"status", to_string(outcome.status)}, {"value", finite(value_of(outcome.scores, metric))}};
  };
  return {{"failure", shrunk.failure},       {"metric", metric},    {"drawn", side(shrunk.drawn)},
          {"shrunk", side(shrunk.left)},     {"runs", shrunk.runs}, {"complete", shrunk.complete},
          {"controlled", shrunk.controlled}, {"cure", shrunk.cure}, {"lines", std::move(lines)},
          {"case", options.file.string()}};
}

std::string command_of(const ShrinkVerbOptions& options, std::uint64_t seed) {
  using scenarios::shell_word;
  std::string words = "tumble shrink " + shell_word(options.scenario) + " --seed " + std::to_string(seed) +
                      " --method " + shell_word(options.method);
  if (!options.failure.empty()) words += " --failure " + shell_word(options.failure);
  if (!options.control.empty()) words += " --control " + shell_word(options.control);
  return words + fmt::format(" --budget {} -o ", options.budget) + shell_word(options.file.filename().string());
}

std::string name_of(const std::filesystem::path& file) {
  const std::string name = file.stem().string();
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  const bool good = file.extension() == ".yaml" && !name.empty() && name[0] >= 'a' && name[0] <= 'z' &&
                    std::all_of(name.begin(), name.end(), allowed);
  if (good) return name;
  throw BadInput(
      fmt::format("-o {}: the file must be NAME.yaml. NAME must start with a lower-case letter, and contain only "
                  "lower-case letters, digits and underscores",
                  file.string()));
}

void require_own_name(const scenarios::DataRoot& data, const std::string& name) {
  for (const std::vector<std::string>& known : {scenarios::scenario_names(data), scenarios::suite_names(data)}) {
    if (std::find(known.begin(), known.end(), name) != known.end())
      throw BadInput(fmt::format("-o {}.yaml: a scenario or a suite already has this name; choose another name", name));
  }
}

std::string control_text(const Shrunk& shrunk, const scenarios::ShrinkOptions& options) {
  if (!options.control)
    return "no control method was stated (--control), so the recording itself may cause the failure";
  const std::string& name = options.control->info.name;
  return shrunk.controlled ? fmt::format("the control method {} does not fail on the smaller simulated run", name)
                           : fmt::format(
                                 "the control method {} also fails on the simulated run, so the cause of the failure "
                                 "may be outside the method",
                                 name);
}

int run_shrink(const Session& session, const ShrinkVerbOptions& options) {
  const std::string name = name_of(options.file);
  const scenarios::DataRoot data = session.data();
  require_own_name(data, name);
  const scenarios::Scenario scenario = scenarios::load_scenario(data, options.scenario);
  const std::uint64_t seed = seed_of(scenario, options.seed);
  scenarios::ShrinkOptions shrinking;
  const double time_limit_s = 0.9 * shrinking.timeout_s;
  const scenarios::MethodPointer method = one_method(options.method, time_limit_s);
  shrinking.failure = failure_of(*method, options.failure);
  const std::string metric = metric_of(*method, shrinking.failure.metric);
  prepare_file(options.file, std::vector<std::filesystem::path>{options.scenario, options.method}, {".yaml"});
  shrinking.control = control_of(options, *method, scenario, time_limit_s);
  shrinking.budget = options.budget;
  shrinking.on_trial = [&](const scenarios::ShrinkTrial& trial) {
    session.note(fmt::format("run {:>3} of at most {}: {}: the method {} (status {}, {} {}){}", trial.run,
                             options.budget, trial.what, trial.kept ? "fails" : "does not fail",
                             to_string(trial.outcome.status), metric,
                             number_text(value_of(trial.outcome.scores, metric)),
                             trial.outcome.message.empty() ? "" : " (" + trial.outcome.message + ")"));
  };
  const Shrunk shrunk = scenarios::shrink(data, scenario, seed, *method, shrinking);

  const bool own = method->info.version.empty();
  const std::string full = full_name(method->info);
  const scenarios::Scenario made = scenarios::named_case_of(
      shrunk, name, own ? full : options.method, shrinking.failure, program_version(), command_of(options, seed));
  scenarios::replace_file(options.file, scenarios::to_yaml(made));
  session.print({lines_table(shrunk, metric), outcomes_table(shrunk, metric)}, to_json(shrunk, metric, options));
  session.note(fmt::format(
      "the search for a simpler failure ({}) took {} simulated runs: {}; {}; {}; the case file is {}", shrunk.failure,
      shrunk.runs,
      shrunk.complete ? "no further part of the simulated run can be removed"
                      : "the budget of simulated runs is used up; a larger --budget may remove more parts",
      control_text(shrunk, shrinking),
      shrunk.cure.empty() ? "replacing one input by its true value never prevents the failure"
                          : fmt::format("replacing the input {} by its true value prevents the failure", shrunk.cure),
      options.file.string()));
  return kDone;
}

}  // namespace

Action declare_shrink(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<ShrinkVerbOptions>();
  verb.add("SCENARIO", options->scenario,
           "simplifies a failing simulated run of this scenario, named case, or scenario file")
      .required()
      .check(a_scenario(session));
  verb.add("--seed", options->seed,
           "sets the seed of the failing simulated run [default: for a named case, the seed of the case]");
  verb.add("--method", options->method, "names the method that fails on the simulated run").required();
  verb.add("--failure", options->failure, kFailureHelp);
  verb.add("--control", options->control,
           "names the control method, which must succeed on the smaller simulated run; 'none' omits this check "
           "[default: the method of the same kind that receives a true input (oracle)]");
  verb.add("--budget", options->budget, "limits the number of simulated runs").whole(1, 100000).shows_default();
  verb.add("-o,--output", options->file,
           "writes this case file, NAME.yaml; 'tumble gate regressions' checks all cases in scenarios/regressions")
      .required();
  return [&session, options] { return run_shrink(session, *options); };
}

}  // namespace tumble::tools
