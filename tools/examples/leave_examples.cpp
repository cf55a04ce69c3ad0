// SPDX-License-Identifier: BSD-3-Clause
#include "tools/examples/leave_examples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/processes/process_pool.hpp"
#include "scenarios/summary/example_choice.hpp"
#include "tools/examples/make_example.hpp"

namespace tumble::tools {

namespace {

namespace fs = std::filesystem;

/// Time limit for simulation and rendering, in multiples of the time limit of one method
constexpr double kOtherTimeouts = 3.0;
constexpr const char* kTypical = "This simulated run has the median score of its scenario";
constexpr const char* kFailed = "This is the simulated run on which most methods failed";
constexpr const char* kAlsoFailed = "Methods failed on this simulated run";

enum class Extent { whole, of_failure };

struct Making {
  scenarios::ExampleDraw draw;
  scenarios::Scenario scenario;
  std::vector<scenarios::MethodPointer> methods;
  std::string choice;
  std::string made_of;
  scenarios::Lidars lidars;
  Moving moving;
  Extent extent;
  std::string text;
  bool done = false;
};

std::vector<scenarios::MethodPointer> methods_of(const std::vector<scenarios::Outcome>& rows,
                                                 const scenarios::Suite& suite) {
  std::vector<scenarios::MethodPointer> all, found;
  for (const scenarios::Method& method : scenarios::methods()) all.push_back(scenarios::unowned(method));
  for (scenarios::MethodPointer& method : scenarios::find_methods_within(suite.methods, suite.timeout_s)) {
    if (!method->info.version.empty()) all.push_back(std::move(method));
  }
  for (scenarios::MethodPointer& method : all) {
    if (std::any_of(rows.begin(), rows.end(), [&](const scenarios::Outcome& row) {
          return row.kind == method->info.kind && row.method == method->info.name;
        }))
      found.push_back(std::move(method));
  }
  return found;
}

std::vector<scenarios::Outcome> rows_of_failure(std::vector<scenarios::Outcome> rows) {
  std::set<scenarios::Kind> kinds;
  for (const scenarios::Outcome& row : rows) {
    if (row.status != scenarios::OutcomeStatus::ok) kinds.insert(row.kind);
  }
  std::erase_if(rows, [&](const scenarios::Outcome& row) {
    return row.status == scenarios::OutcomeStatus::ok && (row.method != "tumble" || !kinds.contains(row.kind));
  });
  return rows;
}

std::vector<Making> plan(const scenarios::DataRoot& data, const scenarios::Suite& suite,
                         const scenarios::Results& results, const LeaveOptions& options) {
  std::vector<scenarios::Scenario> all;
  std::vector<scenarios::ExampleCandidate> candidates;
  for (const std::string& name : suite.scenarios) {
    all.push_back(scenarios::load_scenario(data, name));
    candidates.push_back({all.back().name, all.back().robot.type});
  }
  const scenarios::Summary summary = scenarios::summarize(results);
  std::vector<Making> makings;
  const auto add = [&](const scenarios::ExampleDraw& draw, const char* choice, Extent extent) {
    if (std::any_of(makings.begin(), makings.end(), [&](const Making& making) { return making.draw == draw; })) return;
    std::vector<scenarios::Outcome> rows = scenarios::rows_to_show(results, draw);
    const bool lidars = std::ranges::any_of(rows, [](const auto& row) { return row.kind != scenarios::Kind::rate; });
    if (extent == Extent::of_failure) rows = rows_of_failure(std::move(rows));
    const auto scenario = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.name == draw.scenario; });
    makings.push_back({draw,
                       *scenario,
                       methods_of(rows, suite),
                       choice,
                       scenarios::digest_of_rows(results, draw),
                       lidars ? scenarios::Lidars::simulated : scenarios::Lidars::left_out,
                       makings.empty() ? Moving::drawn : Moving::left_out,
                       extent,
                       {},
                       false});
  };
  for (const scenarios::ExampleDraw& draw : scenarios::choose_examples(summary, candidates, options.count))
    add(draw, kTypical, Extent::whole);
  bool first = true;
  for (const scenarios::ExampleDraw& draw : scenarios::choose_failures(summary, candidates, options.failures)) {
    add(draw, first ? kFailed : kAlsoFailed, first ? Extent::whole : Extent::of_failure);
    first = false;
  }
  return makings;
}

std::vector<std::string> keep_known(const scenarios::DataRoot& data, const fs::path& folder,
                                    const scenarios::Suite& suite, const LeaveOptions& options,
                                    std::vector<Making>& makings) {
  std::set<std::string> within;
  for (const std::string& name : suite.scenarios) within.insert(scenarios::load_scenario(data, name).name);
  std::vector<std::string> others;
  const FoundExamples found = read_examples(folder, Pictures::read);
  for (const Example& known : found.examples) {
    if (!within.contains(known.scenario)) others.push_back(to_json(known));
    for (Making& making : makings) {
      if (known.made_of != making.made_of || known.scenario != making.draw.scenario || known.seed != making.draw.seed)
        continue;
      if (making.moving == Moving::drawn && known.moving.empty()) continue;
      if (known.of_failure != (making.extent == Extent::of_failure)) continue;
      making.text = to_json(known);
      making.done = true;
    }
  }
  if (found.unreadable.empty()) return others;
  const fs::path aside = set_damaged_aside(folder);
  if (!options.note) return others;
  for (const std::string& what : found.unreadable)
    options.note(
        fmt::format("an existing example cannot be read and is left out: {}. A copy of the damaged list is in {}", what,
                    aside.string()));
  return others;
}

void make(const scenarios::DataRoot& data, const fs::path& folder, const Making& making, int fd) {
  try {
    const scenarios::RunResult run =
        scenarios::run_situation(data, making.scenario, making.draw.seed, making.methods, 1, making.lidars);
    Example example = making.extent == Extent::whole ? example_of(run, making.moving) : failure_example_of(run);
    example.choice = making.choice;
    example.made_of = making.made_of;
    write_pictures(folder, example);
    scenarios::write_all(fd, to_json(example));
  } catch (const std::exception& error) {
    scenarios::write_all(fd, error.what());
  }
}

/// Returns false if the user stopped the program.
bool make_all(const scenarios::DataRoot& data, const fs::path& folder, double timeout_s, const LeaveOptions& options,
              std::vector<Making>& makings) {
  const auto say = [&](const std::string& line) {
    if (options.note) options.note(line);
  };
  std::vector<Making*> begun;
  auto next = makings.begin();
  const auto next_work = [&]() -> std::optional<scenarios::PooledWork> {
    next = std::find_if(next, makings.end(), [](const Making& making) { return !making.done; });
    if (next == makings.end()) return std::nullopt;
    const Making& making = *begun.emplace_back(&*next++);
    say(fmt::format("scenario {}, seed {}: the program simulates this run again to create its pictures",
                    making.draw.scenario, making.draw.seed));
    return scenarios::PooledWork{[&](int fd) { make(data, folder, making, fd); },
                                 timeout_s * (static_cast<double>(making.methods.size()) + kOtherTimeouts)};
  };
  scenarios::run_in_processes(next_work, {options.jobs, options.stop}, [&](const scenarios::PooledEnd& ended) {
    Making& making = *begun[ended.index];
    making.text = ended.output;
    making.done = !ended.late && ended.end.normal && making.text.starts_with('{');
    if (ended.late) making.text = "the simulated run exceeded its time limit";
    if (!ended.late && !ended.end.normal) making.text = "its process " + ended.end.describe();
    if (!making.done)
      say(fmt::format("the pictures of scenario {}, seed {} could not be created: {}", making.draw.scenario,
                      making.draw.seed, making.text));
  });
  return options.stop == nullptr || !options.stop->load();
}

class Unfinished {
 public:
  explicit Unfinished(const fs::path& folder) : folder_(folder) { discard_unfinished(folder_); }
  ~Unfinished() {
    discard_unfinished(folder_);
    std::error_code ignored;
    if (fs::is_empty(folder_, ignored) && !ignored) fs::remove(folder_, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  const fs::path& folder_;
};

}  // namespace

bool leave_examples(const scenarios::DataRoot& data, const scenarios::Suite& suite, const fs::path& database,
                    const LeaveOptions& options) {
  if (!suite.recordings.empty() || options.count + options.failures == 0) return true;
  const fs::path folder = examples_folder(database);
  std::vector<Making> makings;
  {
    const scenarios::Results results(database, scenarios::Results::Mode::read_only);
    makings = plan(data, suite, results, options);
  }
  if (makings.empty()) return true;
  std::vector<std::string> texts = keep_known(data, folder, suite, options, makings);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw scenarios::BadInput(folder.string() + ": " + error.message());
  const Unfinished unfinished(folder);
  if (!make_all(data, folder, suite.timeout_s, options, makings)) return false;
  for (Making& making : makings) {
    if (making.done) texts.push_back(std::move(making.text));
  }
  write_examples(folder, texts);
  return true;
}

}  // namespace tumble::tools
