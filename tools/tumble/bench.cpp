// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/bench/bench.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/provenance/build_id.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "tools/tables/table.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/sweeping.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct BenchPage {
  std::vector<scenarios::BenchResult> ran, stored;
  std::vector<std::string> left_out;  ///< with reasons
};

using scenarios::BenchCell;
using scenarios::BenchResult;

constexpr const char* kCost = "estimate_cpu_s";
constexpr std::size_t kVersionShown = 40;

struct MethodRow {
  const BenchResult* result;
  std::string label;
};

std::vector<MethodRow> rows_of(const BenchPage& page) {
  std::vector<MethodRow> rows;
  for (const BenchResult& each : page.ran) rows.push_back({&each, each.method + " (now)"});
  for (const BenchResult& each : page.stored) rows.push_back({&each, each.method});
  return rows;
}

const BenchResult* baseline_of(const std::vector<MethodRow>& rows) {
  const BenchResult* first = nullptr;
  for (const scenarios::Method& method : scenarios::methods()) {
    if (method.info.kind != rows.front().result->kind) continue;
    const auto is_it = [&](const MethodRow& row) { return row.result->method == method.info.name; };
    const auto row = std::find_if(rows.begin(), rows.end(), is_it);
    if (row == rows.end()) continue;
    if (method.info.baseline) return row->result;
    if (first == nullptr) first = row->result;
  }
  return first;
}

std::string cell_text(const BenchCell& cell) {
  if (cell.draws == 0) return "";
  if (std::isinf(cell.median)) return fmt::format("failed (on {} of {} runs)", cell.lost, cell.draws);
  const std::string median = number_text(cell.median);
  return cell.lost == 0 ? median : fmt::format("{} (failed on {} of {} runs)", median, cell.lost, cell.draws);
}

Table metric_table(const scenarios::Suite& suite, const std::string& metric, const std::vector<MethodRow>& rows,
                   const std::vector<BenchResult>& all) {
  const BenchResult* baseline = baseline_of(rows);
  std::vector<std::string> header = {"method"};
  for (const scenarios::DrawClass& each : suite.classes)
    header.push_back(fmt::format("{} ({})", each.name, each.draws.size()));
  header.emplace_back("all");
  if (baseline != nullptr) header.push_back("better than " + baseline->method + " in");
  Table table(fmt::format("{}: median, {}", metric, sense_text(scenarios::metric_info(metric))), header);
  table.align_right_from(1);
  for (const MethodRow& row : rows) {
    std::vector<std::string> cells = {row.label};
    for (const scenarios::DrawClass& each : suite.classes)
      cells.push_back(cell_text(scenarios::bench_cell(*row.result, metric, each.name, all)));
    cells.push_back(cell_text(scenarios::bench_cell(*row.result, metric, "", all)));
    if (baseline != nullptr && row.result != baseline) {
      const scenarios::BenchWins wins = scenarios::bench_wins(*row.result, *baseline, metric, all);
      cells.push_back(wins.draws == 0 ? "" : fmt::format("{} of {}", wins.better, wins.draws));
    }
    table.add_row(std::move(cells));
  }
  return table;
}

Table origin_table(const scenarios::Suite& suite, const std::vector<MethodRow>& rows,
                   const std::vector<BenchResult>& all) {
  Table table(
      fmt::format("origin of the results of suite {} (digest {})", suite.name, scenarios::bench_suite_digest(suite)),
      {"method", "ok", "not ok", "CPU s per draw", "date", "version", "build"});
  for (const MethodRow& row : rows) {
    std::map<std::string, int> counts;
    for (const scenarios::BenchDraw& draw : row.result->draws) ++counts[to_string(draw.status)];
    const int ok = counts["ok"];
    counts.erase("ok");
    std::string others;
    for (const auto& [status, count] : counts)
      others += fmt::format("{}{} {}", others.empty() ? "" : ", ", count, status);
    const std::string version = row.result->version.empty() ? "this build's" : row.result->version;
    table.add_row({row.label, std::to_string(ok), others, number_text(bench_cell(*row.result, kCost, "", all).median),
                   row.result->date, version.substr(0, kVersionShown), row.result->build});
  }
  return table;
}

Table failure_table(const std::vector<BenchResult>& ran, std::span<const scenarios::Outcome> outcomes) {
  Table table("failed runs", {"method", "draw", "class", "status", "message"});
  for (const BenchResult& result : ran) {
    for (const scenarios::BenchDraw& draw : result.draws) {
      if (draw.status == scenarios::OutcomeStatus::ok) continue;
      const auto is_it = [&](const scenarios::Outcome& outcome) {
        return outcome.scenario == draw.scenario && outcome.seed == draw.seed && outcome.kind == result.kind &&
               outcome.method == result.method;
      };
      const auto outcome = std::find_if(outcomes.begin(), outcomes.end(), is_it);
      table.add_row({result.method, fmt::format("{} {}", draw.scenario, draw.seed), draw.group, to_string(draw.status),
                     outcome == outcomes.end() ? "" : outcome->message});
    }
  }
  return table;
}

std::vector<Table> bench_tables(const scenarios::Suite& suite, const BenchPage& page,
                                std::span<const scenarios::Outcome> outcomes) {
  const std::vector<MethodRow> rows = rows_of(page);
  std::vector<BenchResult> all = page.ran;
  all.insert(all.end(), page.stored.begin(), page.stored.end());
  std::vector<Table> tables;
  const std::vector<std::string> metrics =
      suite.shown_metrics.empty() ? scenarios::headline_metrics(page.ran.front().kind) : suite.shown_metrics;
  for (const std::string& metric : metrics) tables.push_back(metric_table(suite, metric, rows, all));
  tables.push_back(origin_table(suite, rows, all));
  Table failures = failure_table(page.ran, outcomes);
  if (!failures.empty()) tables.push_back(std::move(failures));
  if (!page.left_out.empty()) {
    Table table("not compared", {"stored result"});
    for (const std::string& each : page.left_out) table.add_row({each});
    tables.push_back(std::move(table));
  }
  return tables;
}

namespace fs = std::filesystem;
using scenarios::BadInput;
using scenarios::BenchResult;

constexpr std::size_t kDigestShown = 8;

struct BenchOptions {
  std::vector<std::string> methods;
  std::string suite;
  std::vector<fs::path> beside;
  fs::path database, lines;
  int jobs = available_processors();
  bool store = false;
};

std::vector<scenarios::MethodPointer> methods_of(const BenchOptions& options) {
  std::vector<scenarios::MethodPointer> methods = scenarios::find_methods(options.methods);
  for (const scenarios::MethodPointer& each : methods)
    if (each->info.kind != methods.front()->info.kind)
      throw BadInput(
          fmt::format("{}/{} and {}/{} are methods of two kinds; all methods of a benchmark must have the same kind",
                      to_string(each->info.kind), each->info.name, to_string(methods.front()->info.kind),
                      methods.front()->info.name));
  return methods;
}

scenarios::Suite suite_of(const scenarios::DataRoot& data, const BenchOptions& options, scenarios::Kind kind) {
  scenarios::Suite suite =
      scenarios::load_suite(data, options.suite.empty() ? scenarios::bench_suite_name(kind) : options.suite);
  if (suite.classes.empty())
    throw BadInput(fmt::format(
        "suite {} has no classes (named groups of seeds per scenario); add the key 'draws' to the suite file",
        suite.name));
  suite.methods = options.methods;
  return suite;
}

/// The name of the database depends on suite, methods and build: a stopped run continues in its database, and a changed
/// method or build starts a new one.
fs::path database_of(const scenarios::DataRoot& data, const BenchOptions& options, const scenarios::Suite& suite,
                     const std::vector<scenarios::MethodPointer>& methods) {
  if (!options.database.empty()) return options.database;
  std::vector<std::string> texts = {scenarios::build_id(), scenarios::data_digest(data),
                                    scenarios::bench_suite_digest(suite)};
  for (const scenarios::MethodPointer& each : methods) texts.push_back(each->info.name + " " + each->info.version);
  const std::string whose =
      methods.size() == 1 ? methods.front()->info.name : fmt::format("{}_methods", methods.size());
  return fmt::format("{}_{}_{}.db", suite.name, whose, scenarios::digest_of_texts(texts).substr(0, kDigestShown));
}

std::vector<BenchResult> stored_results(const scenarios::DataRoot& data, const BenchOptions& options,
                                        const scenarios::Suite& suite) {
  std::vector<BenchResult> all = scenarios::read_bench_results(scenarios::bench_results_file(data, suite.name));
  for (const fs::path& file : options.beside) {
    const std::vector<BenchResult> more = scenarios::read_bench_results(file);
    if (more.empty())
      throw BadInput(fmt::format(
          "{}: this file contains no bench results; 'tumble bench METHOD -o FILE.jsonl' writes bench results",
          file.string()));
    all.insert(all.end(), more.begin(), more.end());
  }
  for (const BenchResult& each : all) scenarios::require_of_suite(each, suite);
  return all;
}

/// The command contains file names only, so that the page contains no path of this machine.
std::string command_of(const BenchOptions& options) {
  std::string words = "tumble bench";
  for (const std::string& method : options.methods) {
    const fs::path path = method;
    words += " " + scenarios::shell_word(path.is_absolute() ? path.filename().string() : method);
  }
  if (!options.suite.empty()) words += " --suite " + scenarios::shell_word(fs::path(options.suite).filename().string());
  return words;
}

BenchPage page_of(const scenarios::Results& results, const scenarios::Suite& suite, const BenchOptions& options,
                  const std::vector<scenarios::MethodPointer>& methods, std::vector<BenchResult> stored) {
  BenchPage page;
  for (const scenarios::MethodPointer& method : methods) {
    page.ran.push_back(scenarios::collect_bench_result(results, suite, method->info));
    page.ran.back().command = command_of(options);
    page.ran.back().date =
        fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  }
  for (BenchResult& each : stored) {
    const std::string draw = scenarios::other_recording(page.ran.front(), each);
    if (draw.empty())
      page.stored.push_back(std::move(each));
    else
      page.left_out.push_back(
          fmt::format("{}: run {} of these results was simulated by another build, whose recording differs from the "
                      "recording of this build",
                      each.method, draw));
  }
  return page;
}

void print(const Session& session, const std::vector<Table>& tables, const std::string& lines) {
  if (!session.json) return session.print(tables, {});
  if (std::fwrite(lines.data(), 1, lines.size(), stdout) != lines.size() || std::fflush(stdout) != 0)
    throw BadInput(std::string("standard output: ") + std::strerror(errno));
}

std::string sweep_command(const BenchOptions& options, const scenarios::Suite& suite) {
  std::string words = scenarios::shell_word(options.suite.empty() ? suite.name : options.suite);
  for (const std::string& method : options.methods) words += " --method " + scenarios::shell_word(method);
  return words;
}

/// A separate database serves `report`, because a sweep would take stored results in the measured database for
/// completed runs.
fs::path database_to_report(const fs::path& measured, const scenarios::Results& results, const BenchPage& page) {
  std::vector<BenchResult> others = page.stored;
  std::erase_if(others, [&](const BenchResult& stored) {
    return std::ranges::any_of(page.ran, [&](const BenchResult& own) { return own.method == stored.method; });
  });
  if (others.empty()) return measured;
  fs::path path = measured;
  path.replace_filename(measured.stem().string() + "_compared.db");
  scenarios::OutputFile file(path);
  {
    scenarios::Results compared(file.unfinished(), scenarios::Results::Mode::create_or_append);
    for (const auto& [key, text] : results.notes()) compared.set_note(key, text);
    scenarios::MergeCounts counts;
    compared.absorb(results, false, counts);
    scenarios::add_published(others, compared);
  }
  file.move_into_place();
  return path;
}

int bench(const Session& session, const BenchOptions& options) {
  const scenarios::DataRoot data = session.data();
  const std::vector<scenarios::MethodPointer> methods = methods_of(options);
  const scenarios::Suite suite = suite_of(data, options, methods.front()->info.kind);
  std::vector<BenchResult> stored = stored_results(data, options, suite);
  if (!options.lines.empty()) prepare_file(options.lines, {}, {".jsonl"});
  const fs::path database = database_of(data, options, suite, methods);
  if (database.has_parent_path()) make_folder(database.parent_path());
  session.note(
      fmt::format("suite {} has {} simulated runs. The program stores the results in {}. A stopped run continues from "
                  "this database",
                  suite.name, suite.draw_count(), database.string()));
  const scenarios::DatabaseOwner owner(database);
  const InterruptFlag interrupt;
  scenarios::SweepOptions how;
  how.jobs = options.jobs;
  how.stop = &interrupt.raised();
  how.again = {scenarios::OutcomeStatus::killed};  // independent of the method
  const scenarios::SweepProgress final = sweep_with_progress(session, data, suite, owner, how);
  if (final.draws_done < final.draws_total) return say_stopped(final);

  scenarios::open_results(data, suite, database).set_note(scenarios::kCommandNote, sweep_command(options, suite));
  const scenarios::Results results(database, scenarios::Results::Mode::read_only);
  const BenchPage page = page_of(results, suite, options, methods, std::move(stored));
  std::string lines;
  for (const BenchResult& each : page.ran) lines += to_line(each) + "\n";
  if (!options.lines.empty()) scenarios::replace_file(options.lines, lines);
  if (options.store) {
    const fs::path file = scenarios::bench_results_file(data, suite.name);
    make_folder(file.parent_path());
    scenarios::store_bench_results(file, page.ran);
  }
  print(session, bench_tables(suite, page, results.outcomes()), lines);
  if (options.lines.empty() && !session.json)
    session.note("to publish the results, use '-o FILE.jsonl': the file contains one line of JSON per method");
  session.note(fmt::format("this command writes a report page: tumble report {} -o report.html",
                           scenarios::shell_word(database_to_report(database, results, page).string())));
  return kDone;
}

}  // namespace

Action declare_bench(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<BenchOptions>();
  verb.add("METHOD", options->methods,
           "runs this method: the file NAME.yaml or NAME.py of an external method, or the name of a built-in method. "
           "All methods must have the same kind (rate, attitude, position or slam)")
      .required();
  verb.add("--suite", options->suite,
           "runs this suite, which must list its simulated runs [default: the standard suite of the method's kind]");
  verb.add("--beside", options->beside, "also shows the published results in this FILE.jsonl").one_at_a_time();
  verb.add("--jobs", options->jobs, "runs this number of processes in parallel [default: number of processors]")
      .whole(1, 1024)
      .shows_default();
  verb.add("-o,--output", options->lines, "writes the results to this FILE.jsonl, one line of JSON per method");
  verb.add("--db", options->database,
           "stores the results in this database [default: a file in the current folder, named after suite, method and "
           "version]");
  verb.add_flag("--store", options->store, "adds the lines of JSON to the published results in the source tree");
  return [&session, options] { return bench(session, *options); };
}

}  // namespace tumble::tools
