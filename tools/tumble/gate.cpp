// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/gate.hpp"
#include "scenarios/methods/registry.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/certified_results.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "tools/report/cost_html.hpp"
#include "tools/tables/certificate_table.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/gate_cases.hpp"
#include "tools/tumble/gate_database.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/sweeping.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using scenarios::GateResult;

struct GateOptions {
  std::string suite;
  int jobs = available_processors();
  fs::path database, accepted;
  std::vector<std::string> methods;
  bool accept = false;
};

fs::path gate_file(const scenarios::DataRoot& data, const GateOptions& options, const std::string& suite) {
  return options.accepted.empty() ? data.gates() / (suite + ".yaml") : options.accepted;
}

bool is_of(const scenarios::MethodRun& run, const scenarios::MethodPointer& method) {
  return run.kind == method->info.kind && run.method == method->info.name;
}

/// Without --accept, only external methods may be named, because the accepted results determine which methods of this
/// build run.
std::vector<scenarios::MethodPointer> given_methods(const GateOptions& options) {
  for (const std::string& name : options.methods) {
    if (!options.accept && !scenarios::is_method_file(name))
      throw scenarios::BadInput(
          fmt::format("--method {}: give a FILE.yaml that describes an external method, or add --accept. Without "
                      "--accept, only external methods and methods with accepted results run",
                      name));
  }
  return scenarios::find_methods(options.methods);
}

void keep_accepted(const scenarios::Gate& gate, const GateOptions& options,
                   const std::vector<scenarios::MethodPointer>& given, scenarios::Suite& suite) {
  std::vector<std::string> methods = options.methods, names;
  const auto add = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  const std::vector<scenarios::MethodRun>& accepted = gate.accepted.methods;
  for (const scenarios::MethodRun& run : accepted) {
    const auto is_it = [&](const scenarios::MethodPointer& method) { return is_of(run, method); };
    if (std::none_of(given.begin(), given.end(), is_it)) add(methods, full_name(run.kind, run.method));
    add(names, run.scenario);
  }
  suite.methods = methods;
  if (options.accept) return;  // accepts new scenarios too
  for (const scenarios::MethodPointer& method : given) {
    if (std::none_of(accepted.begin(), accepted.end(), [&](const auto& run) { return is_of(run, method); }))
      throw scenarios::BadInput(fmt::format(
          "{}: the accuracy gate of suite {} has no accepted results of this method; add the results with --accept",
          full_name(method->info), suite.name));
  }
  for (const std::string& name : names) require_known("scenario of suite " + suite.name, name, suite.scenarios);
  suite.scenarios = names;
}

/// Only the given methods, and methods with accepted results of the scenario, can be compared.
std::function<bool(const std::string&, const scenarios::MethodInfo&)> comparable(
    const scenarios::Gate& gate, const std::vector<scenarios::MethodPointer>& given) {
  return [&](const std::string& scenario, const scenarios::MethodInfo& info) {
    const auto is_given = [&](const auto& method) { return full_name(method->info) == full_name(info); };
    const auto is_accepted = [&](const scenarios::MethodRun& run) {
      return run.scenario == scenario && run.kind == info.kind && run.method == info.name;
    };
    return std::any_of(given.begin(), given.end(), is_given) || std::ranges::any_of(gate.accepted.methods, is_accepted);
  };
}

scenarios::GateRun of_suite(scenarios::GateRun run, const scenarios::Suite& suite) {
  const std::vector<scenarios::MethodPointer> methods = scenarios::find_methods(suite.methods);
  std::erase_if(run.methods, [&](const scenarios::MethodRun& each) {
    const bool known =
        std::find(suite.scenarios.begin(), suite.scenarios.end(), each.scenario) != suite.scenarios.end();
    return !known || std::none_of(methods.begin(), methods.end(),
                                  [&](const scenarios::MethodPointer& method) { return is_of(each, method); });
  });
  return run;
}

std::string change_text(const GateResult& result) {
  if (std::isnan(result.change)) return "";
  const scenarios::MetricInfo& info = scenarios::metric_info(result.metric);
  if (info.unit == scenarios::Unit::time_offset) {
    const scenarios::MetricStyle style = scenarios::style_of(info.unit);
    return fmt::format("{:+.2f} {}", style.factor * result.change, style.unit);
  }
  const bool ratio = !result.metric.empty() && std::abs(result.change) < 10.0;
  return ratio ? fmt::format("{:+.1f} %", 100.0 * result.change) : number_text(result.change);
}

std::string verdict_text(const GateResult& result) {
  if (!result.passes()) return "FAIL: " + result.fault;
  return result.better ? "pass, better" : "pass";
}

Table result_table(const std::vector<GateResult>& results) {
  Table table("", {"scenario", "method", "held", "draws", "accepted", "now", "pairs", "chance", "verdict"});
  for (const GateResult& result : results) {
    table.add_row({result.scenario.empty() ? "together" : result.scenario, full_name(result.kind, result.method),
                   result.metric.empty() ? "outcomes" : result.metric, std::to_string(result.draws),
                   number_text(result.accepted), number_text(result.value), change_text(result),
                   result.metric.empty() ? "" : fmt::format("{:.2g}", result.chance), verdict_text(result)});
  }
  return table;
}

std::string command_again(const GateResult& result, const std::map<std::string, std::string>& notes) {
  return scenarios::command_again({result.scenario, *result.seed, to_string(result.kind), result.method}, notes);
}

json to_json(const std::vector<GateResult>& results, bool passes) {
  const auto finite = [](double value) { return std::isfinite(value) ? json(value) : json(); };
  json rows = json::array();
  for (const GateResult& result : results) {
    rows.push_back({{"scenario", result.scenario},
                    {"kind", to_string(result.kind)},
                    {"method", result.method},
                    {"metric", result.metric},
                    {"draws", result.draws},
                    {"accepted", finite(result.accepted)},
                    {"value", finite(result.value)},
                    {"change", finite(result.change)},
                    {"chance", finite(result.chance)},
                    {"better", result.better},
                    {"fault", result.fault},
                    {"verdict", result.passes() ? "pass" : "fail"}});
  }
  return {{"verdict", passes ? "pass" : "fail"}, {"held", std::move(rows)}};
}

std::optional<scenarios::Gate> load(const scenarios::DataRoot& data, const GateOptions& options,
                                    const std::vector<scenarios::MethodPointer>& given, const std::string& suite) {
  const fs::path file = gate_file(data, options, suite);
  if (options.accept && !(fs::exists(file) && fs::exists(fs::path(file).replace_extension(".csv"))))
    return std::nullopt;
  const scenarios::Gate gate =
      scenarios::load_gate(data, options.accepted.empty() ? suite : options.accepted.string(), given);
  if (gate.suite != suite) {
    throw scenarios::BadInput(
        fmt::format("{}: this file contains accepted results of suite '{}', but the requested suite is '{}'",
                    options.accepted.string(), gate.suite, suite));
  }
  return gate;
}

void write_accepted(const fs::path& file, const scenarios::Gate& gate) {
  if (file.has_parent_path()) make_folder(file.parent_path());
  scenarios::replace_file(fs::path(file).replace_extension(".csv"), scenarios::to_csv(gate.accepted));
  if (!fs::exists(file)) scenarios::replace_file(file, scenarios::to_yaml(gate));
}

std::string certificate_text(const Session& session, const scenarios::DataRoot& data, const fs::path& database) {
  scenarios::Results results(database, scenarios::Results::Mode::create_or_append);
  const auto certificate = scenarios::known_certificate(results, scenarios::CertificateStore(session.cache(), data));
  return certificate ? certificate_summary(*certificate)
                     : "the agreement of this build's simulation with physics was not measured on this machine; "
                       "'tumble certify' or 'tumble sweep' measures the agreement";
}

int run_case_gate(const Session& session, const scenarios::DataRoot& data, const GateOptions& options) {
  if (!options.accepted.empty() || !options.methods.empty())
    throw scenarios::BadInput(
        "--against and --method do not apply to a named case, because the case contains its own expectations; remove "
        "both options");
  return hold_cases(session, data, {options.suite, options.jobs, options.database, options.accept});
}

int run_gate(const Session& session, const GateOptions& options) {
  const scenarios::DataRoot data = session.data();
  if (names_cases(data, options.suite)) return run_case_gate(session, data, options);
  scenarios::Suite suite = scenarios::load_suite(data, options.suite);
  if (!suite.recordings.empty())
    throw scenarios::BadInput(fmt::format(
        "suite '{}' contains recordings, but 'tumble gate' needs simulated runs of scenarios; choose another suite",
        suite.name));
  if (!suite.classes.empty())
    throw scenarios::BadInput(
        fmt::format("the file of suite '{}' lists the simulated runs, but 'tumble gate' needs a range of seeds; choose "
                    "another suite",
                    suite.name));
  if (!options.accepted.empty() && options.accepted.extension() != ".yaml")
    throw scenarios::BadInput(
        fmt::format("--against {}: the accepted results must be in a FILE.yaml", options.accepted.string()));
  suite.curves.clear();  // a gate covers unmodified scenarios only
  const std::vector<scenarios::MethodPointer> given = given_methods(options);
  const std::optional<scenarios::Gate> known = load(data, options, given, suite.name);
  if (known)
    keep_accepted(*known, options, given, suite);
  else
    suite.methods = options.methods.empty() ? std::vector<std::string>{"tumble"} : options.methods;

  const GateDatabase database(options.database);
  const scenarios::DatabaseOwner owner(database.path());
  const InterruptFlag interrupt;
  scenarios::SweepOptions how;
  how.jobs = options.jobs;
  how.stop = &interrupt.raised();
  how.recordings_unseen = options.database.empty();
  if (known && !options.accept) how.selects = comparable(*known, given);
  const scenarios::SweepProgress progress = sweep_with_progress(session, data, suite, owner, how);
  if (progress.draws_done < progress.draws_total) return say_stopped(progress);

  const std::string certificate = certificate_text(session, data, database.path());
  const scenarios::Results results(database.path(), scenarios::Results::Mode::read_only);
  const scenarios::GateRun run = of_suite(scenarios::gate_run(results, suite.first_seed, suite.last_seed), suite);
  scenarios::Gate gate = known ? *known : scenarios::Gate{suite.name, {}, {}};
  if (options.accept) {
    scenarios::require_acceptable(run);
    gate.accepted = run;
    write_accepted(gate_file(data, options, suite.name), gate);
    session.note("accepted: " + gate_file(data, options, suite.name).string());
  }
  const std::vector<GateResult> held = scenarios::hold_to_gate(run, gate);
  const bool passes = std::all_of(held.begin(), held.end(), [](const GateResult& r) { return r.passes(); });
  json document = to_json(held, passes);
  document["certificate"] = certificate;
  session.print({result_table(held)}, document);
  for (const GateResult& result : held) {
    if (result.seed) session.note("again: " + command_again(result, results.notes()));
  }
  session.note("certificate: " + certificate);
  return passes ? kDone : kCheckFailed;
}

}  // namespace

Action declare_gate(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<GateOptions>();
  verb.add("SUITE", options->suite,
           "runs the fixed seeds of this suite or scenario, or this named case (a stored failure). 'regressions' runs "
           "all named cases")
      .required()
      .check(a_suite_or_cases(session));
  verb.add("--against", options->accepted,
           "compares with the accepted results in this FILE.yaml, which needs a FILE.csv in the same folder [default: "
           "scenarios/gates/SUITE.yaml]");
  verb.add("--method", options->methods,
           "also checks the external method in this FILE.yaml. With --accept, adds the results of this external or "
           "built-in method to the accepted results. Repeat the option for more methods")
      .one_at_a_time();
  verb.add("--jobs", options->jobs, "runs this number of processes in parallel [default: number of processors]")
      .whole(1, 1024)
      .shows_default();
  verb.add("--db", options->database,
           "keeps the results in this database, and repeats no stored run [default: a temporary file]");
  verb.add_flag("--accept", options->accept, "stores the results of this run as the accepted results, without a check");
  return [&session, options] { return run_gate(session, *options); };
}

}  // namespace tumble::tools
