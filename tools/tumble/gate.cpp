// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/gate.hpp"

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "tools/report/certificate_html.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/certificate_table.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/sweeping.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using scenarios::GateResult;

struct Options {
  std::string suite;
  int jobs = available_processors();
  fs::path database, bounds;
  bool accept = false;
  double margin = 0.1;
};

/// A database of its own that is gone afterwards, unless the caller named one.
class Database {
 public:
  explicit Database(const fs::path& named) : path_(named), own_(named.empty()) {
    if (own_)
      path_ = fs::temp_directory_path() / fmt::format("tumble_gate_{}.db", getpid());
    else if (path_.has_parent_path())
      make_folder(path_.parent_path());
  }
  ~Database() {
    std::error_code ignored;
    if (own_) fs::remove(path_, ignored);
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool own_;
};

/// Only what the bounds speak of is run.
void keep_bounded(const scenarios::Gate& gate, scenarios::Suite& suite) {
  std::vector<std::string> methods, names;
  const auto add = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const scenarios::GateBound& bound : gate.bounds) {
    add(methods, std::string(to_string(bound.kind)) + "/" + bound.method);
    add(names, bound.scenario);
  }
  for (const std::string& name : names) require_known("scenario of suite " + suite.name, name, suite.scenarios);
  suite.methods = methods;
  suite.scenarios = names;
}

Table result_table(const std::vector<GateResult>& results) {
  Table table("", {"scenario", "method", "statistic", "draws", "value", "bound", "accepted", "verdict"});
  for (const GateResult& result : results) {
    const scenarios::GateBound& bound = result.bound;
    const std::string what =
        std::string(to_string(bound.statistic)) + (bound.metric.empty() ? "" : " of " + bound.metric);
    table.add_row({bound.scenario, std::string(to_string(bound.kind)) + "/" + bound.method, what,
                   std::to_string(result.draws), number_text(result.value), bound_text(bound.low, bound.high),
                   number_text(bound.accepted), result.passes() ? "pass" : "FAIL"});
  }
  return table;
}

json to_json(const std::vector<GateResult>& results, bool passes) {
  const auto finite = [](double value) { return std::isfinite(value) ? json(value) : json(); };
  json rows = json::array();
  for (const GateResult& result : results) {
    const scenarios::GateBound& bound = result.bound;
    rows.push_back({{"scenario", bound.scenario},
                    {"kind", to_string(bound.kind)},
                    {"method", bound.method},
                    {"metric", bound.metric},
                    {"statistic", to_string(bound.statistic)},
                    {"draws", result.draws},
                    {"value", finite(result.value)},
                    {"low", finite(bound.low)},
                    {"high", finite(bound.high)},
                    {"accepted", finite(bound.accepted)},
                    {"verdict", result.passes() ? "pass" : "fail"}});
  }
  return {{"verdict", passes ? "pass" : "fail"}, {"bounds", std::move(rows)}};
}

/// The bounds that are there, or, to be accepted for the first time, none yet.
scenarios::Gate load(const scenarios::DataRoot& data, const Options& options, const std::string& suite) {
  if (!options.bounds.empty() && (!options.accept || fs::exists(options.bounds))) {
    return scenarios::load_gate(data, options.bounds.string());
  }
  const std::vector<std::string> known = scenarios::gate_names(data);
  const bool there = std::find(known.begin(), known.end(), suite) != known.end();
  if (options.accept && (!there || !options.bounds.empty())) return {suite, options.margin, {}};
  return scenarios::load_gate(data, suite);
}

/// The certificate that is known of this build goes with what is kept; it is not measured here: a gate is run often.
/// Says how it stands.
std::string certificate_text(const Session& session, const scenarios::DataRoot& data, const fs::path& database) {
  scenarios::Results results(database, scenarios::Results::Mode::create_or_append);
  const auto certificate = scenarios::known_certificate(results, scenarios::CertificateStore(session.cache(), data));
  return certificate ? certificate_summary(*certificate)
                     : "not measured of this build on this machine ('tumble certify' and 'tumble sweep' do)";
}

int run_gate(const Session& session, const Options& options) {
  const scenarios::DataRoot data = session.data();
  scenarios::Suite suite = scenarios::load_suite(data, options.suite);
  suite.curves.clear();  // bounds speak of the scenarios as they are
  scenarios::Gate gate = load(data, options, suite.name);
  if (gate.bounds.empty())
    suite.methods = {"tumble"};
  else
    keep_bounded(gate, suite);

  const Database database(options.database);
  const InterruptFlag interrupt;
  const scenarios::SweepProgress progress =
      sweep_with_progress(session, data, suite, database.path(), options.jobs, interrupt.raised());
  if (progress.draws_done < progress.draws_total) return say_stopped(progress);

  const std::string certificate = certificate_text(session, data, database.path());
  const scenarios::Results results(database.path(), scenarios::Results::Mode::read_only);
  if (gate.bounds.empty()) gate = scenarios::proposed_gate(results, suite.name);
  std::vector<GateResult> held = scenarios::hold_to_gate(results, gate, suite.first_seed, suite.last_seed);
  if (options.accept) {
    gate = scenarios::accept(gate, held, options.margin);
    const fs::path file = options.bounds.empty() ? data.gates() / (suite.name + ".yaml") : options.bounds;
    if (file.has_parent_path()) make_folder(file.parent_path());
    scenarios::replace_file(file, scenarios::to_yaml(gate));
    session.note("accepted: " + file.string());
    held = scenarios::hold_to_gate(results, gate, suite.first_seed, suite.last_seed);
  }
  const bool passes =
      !held.empty() && std::all_of(held.begin(), held.end(), [](const GateResult& r) { return r.passes(); });
  json document = to_json(held, passes);
  document["certificate"] = certificate;
  session.print({result_table(held)}, document);
  session.note("certificate: " + certificate);
  return passes ? kDone : kCheckFailed;
}

}  // namespace

Action declare_gate(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  app.add_option("SUITE", options->suite, "a suite, a suite file, or a scenario: its fixed seeds are swept")
      ->required()
      ->check(a_suite(session));
  app.add_option("--bounds", options->bounds, "the accepted bounds, FILE.yaml [scenarios/gates/SUITE.yaml]");
  app.add_option("--jobs", options->jobs, "processes at a time [the processors]")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--db", options->database,
                 "keep the results here, and do not run again what it holds [a temporary file]");
  app.add_flag("--accept", options->accept, "write the bounds from this run instead of being held to them");
  app.add_option("--margin", options->margin, "how far a later run may fall behind, as a share of the accepted value")
      ->check(within(0.0, 10.0))
      ->capture_default_str();
  return [&session, options] { return run_gate(session, *options); };
}

}  // namespace tumble::tools
