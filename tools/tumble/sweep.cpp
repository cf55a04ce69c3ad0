// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep.hpp"
#include "scenarios/methods/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "tools/examples/leave_examples.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/asked.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/recording_info.hpp"
#include "tools/tumble/sweeping.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

constexpr std::uint64_t kExamplesMax = 3, kDrawsPerExample = 8, kFailuresMax = 8, kDrawsPerFailure = 4;

struct SweepVerbOptions {
  std::string suite;
  std::string seeds, shard;
  std::vector<std::string> scenarios, methods, again;
  int jobs = available_processors();
  std::optional<std::size_t> examples, failures;  ///< default: by the size
  std::filesystem::path database, recordings;
  double memory_mib = scenarios::kWorkerMemoryMib;
  std::string keep = "none";
  std::string until;
  double risk = 0.05;
};

void say_what_it_holds(const Session& session, const SweepVerbOptions& options, const scenarios::Suite& suite) {
  if (!options.scenarios.empty() || suite.scenarios.size() < 2) return;
  if (std::ranges::count(suite.scenarios, options.suite) == 0) return;
  session.note(fmt::format("suite '{0}' contains the scenarios {1}; use --scenario {0} to run only the scenario '{0}'",
                           options.suite, fmt::join(suite.scenarios, " ")));
}

bool select(const scenarios::DataRoot& data, const SweepVerbOptions& options, scenarios::Suite& suite) {
  suite = scenarios::load_suite(data, options.suite);
  take_scenarios(options.scenarios, suite);
  const bool recorded = !suite.recordings.empty();
  if (recorded && (!options.seeds.empty() || !options.shard.empty()))
    throw scenarios::BadInput(
        "--seeds and --shard do not apply, because a suite of recordings has no seeds; remove both options");
  if (!suite.classes.empty() && !options.seeds.empty())
    throw scenarios::BadInput(fmt::format(
        "--seeds does not apply to suite '{}', because the suite file lists the simulated runs", suite.name));
  if (!options.seeds.empty()) std::tie(suite.first_seed, suite.last_seed) = parse_seeds(options.seeds);
  if (!recorded && !options.recordings.empty())
    throw scenarios::BadInput(
        fmt::format("--data does not apply to suite '{}', because the suite has no recordings", suite.name));
  if (!options.recordings.empty()) suite.recordings_folder = options.recordings;
  if (!options.methods.empty()) {
    for (const std::string& name : options.methods) scenarios::find_methods(name);
    suite.methods = options.methods;
  }
  return options.shard.empty() || shard_seeds(parse_shard(options.shard), suite.first_seed, suite.last_seed);
}

std::string command_of(const SweepVerbOptions& options) {
  using scenarios::shell_word;
  std::string words = shell_word(options.suite);
  for (const std::string& scenario : options.scenarios) words += " --scenario " + shell_word(scenario);
  if (!options.seeds.empty()) words += " --seeds " + shell_word(options.seeds);
  for (const std::string& method : options.methods) words += " --method " + shell_word(method);
  if (!options.recordings.empty()) words += " --data " + shell_word(options.recordings.string());
  return words;
}

void note_command(scenarios::Results results, const SweepVerbOptions& options) {
  const std::string known = results.note(scenarios::kCommandNote);
  results.set_note(scenarios::kCommandNote, scenarios::with_commands(known, command_of(options)));
}

/// Examples require the complete suite, because typical runs of a part may be untypical of the suite.
bool leave_examples(const Session& session, const scenarios::DataRoot& data, const scenarios::Suite& suite,
                    const SweepVerbOptions& options, std::uint64_t draws, const std::atomic<bool>& stop) {
  if (!options.shard.empty()) return true;
  LeaveOptions leave;
  leave.count = options.examples.value_or(std::min(kExamplesMax, draws / kDrawsPerExample));
  const bool wants_none = options.examples && *options.examples == 0;
  leave.failures =
      options.failures.value_or(wants_none ? 0 : std::clamp(draws / kDrawsPerFailure, std::uint64_t{1}, kFailuresMax));
  leave.jobs = options.jobs;
  leave.stop = &stop;
  leave.note = [&](std::string_view line) { session.note(line); };
  try {
    return tools::leave_examples(data, suite, options.database, leave);
  } catch (const scenarios::BadInput& error) {
    std::fprintf(stderr, "tumble: the pictures of single simulated runs could not be created: %s\n", error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "tumble: the pictures of single simulated runs could not be created: %s\n", error.what());
  }
  return true;
}

nlohmann::json to_json(const scenarios::SweepProgress& p, const std::string& database) {
  nlohmann::json failures = nlohmann::json::object();
  for (const auto& [status, count] : p.failures) failures[to_string(status)] = count;
  return {{"database", database},         {"draws_done", p.draws_done},
          {"draws_total", p.draws_total}, {"outcomes", p.outcomes},
          {"not_ok", p.not_ok()},         {"failures", std::move(failures)},
          {"rejected", p.rejected},       {"kept", p.kept},
          {"to_keep", p.to_keep},         {"peak_mib", p.peak_mib},
          {"elapsed_s", p.elapsed_s}};
}

Table to_table(const scenarios::SweepProgress& p, const std::string& database) {
  Table table("", {"database", "draws done", "draws total", "outcomes", "not ok", "draws rejected", "peak MiB"});
  table.align_right_from(1);
  table.add_row({database, std::to_string(p.draws_done), std::to_string(p.draws_total), std::to_string(p.outcomes),
                 std::to_string(p.not_ok()), std::to_string(p.rejected), fmt::format("{:.0f}", p.peak_mib)});
  return table;
}

std::vector<scenarios::OutcomeStatus> statuses_named(const std::vector<std::string>& names) {
  std::vector<scenarios::OutcomeStatus> statuses;
  std::vector<std::string> known;
  for (const scenarios::OutcomeStatus status : scenarios::outcome_statuses()) known.emplace_back(to_string(status));
  for (const std::string& name : names) {
    require_known("status to run again", name, known);
    statuses.push_back(*scenarios::outcome_status_named(name));
  }
  return statuses;
}

scenarios::SweepOptions sweep_options(const SweepVerbOptions& options, const std::atomic<bool>& stop) {
  scenarios::SweepOptions out;
  out.jobs = options.jobs;
  out.memory_mib = options.memory_mib;
  out.stop = &stop;
  out.again = statuses_named(options.again);
  out.keep = scenarios::parse_keep(options.keep);
  out.versions = recording_versions();
  return out;
}

class NewDatabase {
 public:
  explicit NewDatabase(const std::filesystem::path& path) : path_(path), is_new_(!exists_at(path)) {}
  ~NewDatabase() {
    if (!is_new_ || kept_ || holds_rows()) return;
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  NewDatabase(const NewDatabase&) = delete;
  NewDatabase& operator=(const NewDatabase&) = delete;
  void keep() { kept_ = true; }

 private:
  static bool exists_at(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
  }
  /// An unreadable database is kept, except for an empty file from a full disk.
  bool holds_rows() const {
    try {
      const scenarios::Results results(path_, scenarios::Results::Mode::read_only);
      return results.has_rows();
    } catch (const std::exception&) {
      std::error_code error;
      return std::filesystem::file_size(path_, error) > 0 || error;
    }
  }

  std::filesystem::path path_;
  bool is_new_, kept_ = false;
};

std::optional<scenarios::Question> ask(const SweepVerbOptions& options, const scenarios::DataRoot& data,
                                       const scenarios::Suite& suite) {
  if (options.until.empty()) return std::nullopt;
  if (!options.shard.empty())
    throw scenarios::BadInput(
        "--until does not apply with --shard, because a shard contains only a part of the simulated runs");
  if (!suite.recordings.empty() || !suite.curves.empty())
    throw scenarios::BadInput(
        fmt::format("--until does not apply to suite '{}', because the suite contains recordings or varied parameters",
                    suite.name));
  if (!suite.classes.empty())
    throw scenarios::BadInput(
        fmt::format("--until does not apply to suite '{}', because the suite file lists the simulated runs instead of "
                    "a range of seeds",
                    suite.name));
  const scenarios::Question question = parse_question(options.until, options.risk, suite);
  scenarios::Results results = scenarios::open_results(data, suite, options.database);
  scenarios::claim(results, question, options.database);
  return question;
}

void say_what_is_kept(const Session& session, const SweepVerbOptions& options,
                      const scenarios::SweepProgress& progress) {
  if (options.keep == "none") return;
  session.note(fmt::format("{} of {} selected simulated runs are stored in {}.files/kept/SCENARIO/SEED", progress.kept,
                           progress.to_keep, options.database.string()));
  if (progress.kept < progress.to_keep)
    std::fprintf(stderr, "tumble: %llu selected simulated runs could not be stored: %s\n",
                 static_cast<unsigned long long>(progress.to_keep - progress.kept),
                 progress.not_kept.empty() ? "stopped early" : progress.not_kept.c_str());
}

int run_sweep(const Session& session, const SweepVerbOptions& options) {
  scenarios::parse_keep(options.keep);
  const scenarios::DataRoot data = session.data();
  scenarios::Suite suite;
  const bool any = select(data, options, suite);
  say_what_it_holds(session, options, suite);
  if (options.database.has_parent_path()) make_folder(options.database.parent_path());
  const InterruptFlag interrupt;
  const scenarios::DatabaseOwner owner(options.database);
  NewDatabase made(options.database);
  if (!any) {
    scenarios::Results results = scenarios::open_results(data, suite, options.database);
    if (options.keep != "none") results.set_note(scenarios::kKeepNote, options.keep);
    made.keep();
    session.note(fmt::format("shard {} has no seeds, so there is nothing to do", options.shard));
    session.print({to_table({}, options.database.string())}, to_json({}, options.database.string()));
    return kDone;
  }

  const scenarios::SweepOptions how = sweep_options(options, interrupt.raised());
  scenarios::require_sound(suite, how);
  const std::optional<scenarios::Question> question = ask(options, data, suite);
  note_command(scenarios::open_results(data, suite, options.database), options);
  if (suite.recordings.empty()) certify_results_file(session, data, options.database, interrupt.raised());
  AskedSweep swept;
  if (question) {
    swept = sweep_until(session, data, suite, owner, how, *question);
  } else {
    swept.progress = sweep_with_progress(session, data, suite, owner, how);
  }
  made.keep();
  const scenarios::SweepProgress& final = swept.progress;
  if (question && scenarios::all_answered(swept.answers))
    suite.last_seed = suite.first_seed + swept.progress.draws_total / suite.scenarios.size() - 1;

  const bool complete = final.draws_done >= final.draws_total;
  const bool shown = !complete || leave_examples(session, data, suite, options, final.draws_total, interrupt.raised());
  std::vector<Table> tables = {to_table(final, options.database.string())};
  nlohmann::json document = to_json(final, options.database.string());
  if (question) {
    tables.push_back(table_of(swept.answers, *question));
    document["until"] = json_of(swept.answers, *question);
  }
  session.print(tables, document);
  say_what_is_kept(session, options, final);
  if (!complete) return say_stopped(final);
  if (shown) return kDone;
  std::fputs(
      "tumble: stopped: all simulated runs are stored, but their pictures are missing; run again to create the "
      "pictures\n",
      stderr);
  return kCheckFailed;
}

}  // namespace

Action declare_sweep(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<SweepVerbOptions>();
  verb.add("SUITE", options->suite, "runs this suite, suite file, or scenario").required().check(a_suite(session));
  verb.add("--scenario", options->scenarios,
           "runs only this scenario of the suite; repeat the option for more scenarios [default: all]")
      .one_at_a_time();
  verb.add("--seeds", options->seeds, "runs the seeds A..B, both included [default: the seeds of the suite]")
      .filled();  // an empty word would select all
  verb.add("--method", options->methods,
           "runs this method; repeat the option for more methods [default: the methods of the suite]")
      .one_at_a_time();  // one word per option
  verb.add("--jobs", options->jobs, "runs this number of processes in parallel [default: number of processors]")
      .whole(1, 1024)
      .shows_default();
  verb.add("--shard", options->shard, "runs the i-th of n parts of the seeds; write i/n, for example 2/8").filled();
  verb.add("--again", options->again,
           "repeats stored runs that have one of these statuses, for example crashed,timeout,killed")
      .separated_by(',')
      .one_at_a_time();
  verb.add("--examples", options->examples,
           "sets the number of typical simulated runs (with the median score of the scenario) that the sweep repeats "
           "at the end. For these runs, the sweep writes pictures, plots and replays to FILE.db.files for 'tumble "
           "report'. Does not apply to shards [default: one per 8 simulated runs, at most 3]")
      .whole(0, 64);
  verb.add("--failures", options->failures,
           "sets the number of failed simulated runs that the sweep repeats at the end. Runs on which most methods "
           "failed come first. For each of these runs, the sweep writes a picture and a replay [default: one per 4 "
           "simulated runs, at most 8; none with --examples 0]")
      .whole(0, 64);
  verb.add("--memory", options->memory_mib,
           "limits the memory of each worker process and of each method, MiB; a run beyond the limit has status "
           "'killed'")
      .within(64.0, 1e7)
      .shows_default();
  verb.add("--keep", options->keep,
           "stores recording and estimates of the selected simulated runs in FILE.db.files/kept. The selection is "
           "none, failed, all, or worst:N (the N worst runs of each scenario and method)")
      .shows_default();
  verb.add("--until", options->until,
           "stops when the simulated runs show whether method A is better than method B by more than the margin. Write "
           "A:B:METRIC or A:B:METRIC:MARGIN. The margin is in the metric's unit, or a percentage of B's value such as "
           "10%. If a sweep ends without an answer, run the command again with more --seeds")
      .filled();
  verb.add("--risk", options->risk,
           "sets the maximum probability that --until names a better method although neither method is better")
      .within(1e-6, 0.5)
      .shows_default();
  verb.add("--data", options->recordings,
           "reads the recordings of the suite from this folder [default: the folder in the suite's file]");
  verb.add("--db", options->database,
           "stores the results in this database; runs that are already stored are not repeated")
      .required();
  return [&session, options] { return run_sweep(session, *options); };
}

}  // namespace tumble::tools
