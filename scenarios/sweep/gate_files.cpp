// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_text.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/gate.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kKeyCells = 4;  // scenario, kind, method, metric
constexpr const char* kStatusRow = "status";

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

struct GateLine {
  const std::string& file;
  int number;
  std::vector<std::string> cells;
  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput(file + ":" + std::to_string(number) + ": " + what);
  }
};

std::vector<std::uint64_t> read_seeds(const GateLine& line) {
  const std::array<std::string, kKeyCells> head = {"scenario", "kind", "method", "metric"};
  if (line.cells.size() <= kKeyCells || !std::equal(head.begin(), head.end(), line.cells.begin())) {
    line.fail("the header must be 'scenario,kind,method,metric' followed by one seed per column");
  }
  std::vector<std::uint64_t> seeds;
  for (std::size_t i = kKeyCells; i < line.cells.size(); ++i) {
    std::uint64_t seed = 0;
    if (!read_number(line.cells[i], seed))
      line.fail(fmt::format("the header cell is '{}'; it must be a seed (a whole number)", line.cells[i]));
    if (!seeds.empty() && seed <= seeds.back())
      line.fail(fmt::format("seeds must increase from column to column; the header contains {}", line.cells[i]));
    seeds.push_back(seed);
  }
  return seeds;
}

Kind read_kind(const GateLine& line) {
  if (const auto kind = kind_named(line.cells[1])) return *kind;
  std::vector<std::string> known;
  for (const Kind kind : kKinds) known.emplace_back(to_string(kind));
  line.fail("unknown kind '" + line.cells[1] + "'" + suggestion(line.cells[1], known));
}

void require_method(const GateLine& line, const MethodRun& run, std::span<const MethodPointer> described) {
  if (std::any_of(described.begin(), described.end(), [&](const MethodPointer& method) {
        return method->info.kind == run.kind && method->info.name == run.method;
      }))
    return;
  try {
    find_methods(full_name(run.kind, run.method));
  } catch (const BadInput& error) {
    line.fail(fmt::format("{}; if a file describes this method, set --method FILE.yaml", error.what()));
  }
}

void read_statuses(const GateLine& line, MethodRun& run) {
  for (std::size_t i = kKeyCells; i < line.cells.size(); ++i) {
    const auto status = outcome_status_named(line.cells[i]);
    if (!status) line.fail("unknown status '" + line.cells[i] + "'");
    run.status.push_back(status);
  }
}

void read_values(const GateLine& line, MethodRun& run) {
  const std::vector<std::string> known = held_metrics(run.kind);
  const std::string& metric = line.cells[3];
  if (std::find(known.begin(), known.end(), metric) == known.end()) {
    line.fail(fmt::format("'{}' is not a metric that 'tumble gate' checks for methods of kind {}{}", metric,
                          to_string(run.kind), suggestion(metric, known)));
  }
  const auto [place, is_new] = run.values.try_emplace(metric);
  if (!is_new) line.fail("'" + metric + "' occurs twice");
  for (std::size_t i = kKeyCells; i < line.cells.size(); ++i) {
    double value = std::numeric_limits<double>::quiet_NaN();
    const bool none = line.cells[i].empty();
    if (!none && (!read_number(line.cells[i], value) || !std::isfinite(value))) {
      line.fail(fmt::format("the cell '{}' of the accepted results is not a finite number", line.cells[i]));
    }
    place->second.push_back(value);
  }
}

void read_row(const GateLine& line, std::span<const MethodPointer> described, GateRun& run) {
  if (line.cells.size() != kKeyCells + run.seeds.size()) {
    line.fail("has " + std::to_string(line.cells.size()) + " columns; it must have " +
              std::to_string(kKeyCells + run.seeds.size()));
  }
  const Kind kind = read_kind(line);
  const bool opens = line.cells[3] == kStatusRow;
  const MethodRun* known = run.find(line.cells[0], kind, line.cells[2]);
  if (opens && known != nullptr)
    line.fail("the status row of this method occurs twice; each method may have one status row");
  if (!opens && (known == nullptr || known != &run.methods.back()))
    line.fail("this row must follow the status row of its method");
  if (opens) {
    run.methods.push_back({line.cells[0], kind, line.cells[2], {}, {}});
    require_method(line, run.methods.back(), described);
    read_statuses(line, run.methods.back());
  } else {
    read_values(line, run.methods.back());
  }
}

double within(const YamlNode& node, double low, double high) {
  const double value = node.number();
  if (!(value >= low && value <= high)) {
    node.fail(fmt::format("this limit of the accuracy gate is {}; it must be within [{}, {}]", exact_text(value),
                          exact_text(low), exact_text(high)));
  }
  return value;
}

}  // namespace

std::vector<std::string> gate_names(const DataRoot& data) {
  return std::filesystem::is_directory(data.gates()) ? yaml_stems(data.gates()) : std::vector<std::string>{};
}

GateRun parse_gate_run(const std::string& text, const std::string& file, std::span<const MethodPointer> described) {
  GateRun run;
  std::istringstream stream(text);
  std::string content;
  for (int number = 1; std::getline(stream, content); ++number) {
    if (content.empty() || content[0] == '#') continue;
    const GateLine line{file, number, cells_of(content)};
    if (run.seeds.empty())
      run.seeds = read_seeds(line);
    else
      read_row(line, described, run);
  }
  if (run.methods.empty())
    throw BadInput(fmt::format(
        "{}: this table has no accepted results; 'tumble gate SUITE --accept' stores the results of this build", file));
  return run;
}

Gate load_gate(const DataRoot& data, const std::string& name, std::span<const MethodPointer> described) {
  const bool is_file = name.ends_with(".yaml");
  const std::filesystem::path path = is_file ? std::filesystem::path(name) : data.gates() / (name + ".yaml");
  if (!std::filesystem::exists(path)) {
    throw BadInput(fmt::format("there are no accepted results of '{}'{}; create them with 'tumble gate {} --accept'",
                               name, suggestion(name, gate_names(data)), name));
  }
  const YamlNode root = YamlNode::parse(read_text_file(path), path.string());
  const std::array<std::string, 6> required = {"suite", "risk", "margin", "share_margin", "time_margin_s", "worst"};
  const auto fields = root.fields(required);
  Gate gate;
  gate.suite = fields.at("suite").text();
  if (!is_file && gate.suite != name)
    fields.at("suite").fail(
        fmt::format("the key 'suite' is '{}'; it must be '{}', as in the name of the file", gate.suite, name));
  gate.policy.risk = within(fields.at("risk"), 1e-6, 0.5);
  gate.policy.margin = within(fields.at("margin"), 0.0, 10.0);
  gate.policy.share_margin = within(fields.at("share_margin"), 0.0, 1.0);
  gate.policy.time_margin_s = within(fields.at("time_margin_s"), 0.0, 1.0);
  gate.policy.worst = within(fields.at("worst"), 1.0, 1000.0);
  const std::filesystem::path table = std::filesystem::path(path).replace_extension(".csv");
  gate.accepted = parse_gate_run(read_text_file(table), table.string(), described);
  return gate;
}

std::string to_yaml(const Gate& gate) {
  return "# SPDX-License-Identifier: BSD-3-Clause\n"
         "# Limits for the comparison of each simulated run with its accepted result. scenarios/sweep/gate.hpp defines "
         "each number.\n"
         "suite: " +
         gate.suite + "\nrisk: " + exact_text(gate.policy.risk) + "\nmargin: " + exact_text(gate.policy.margin) +
         "\nshare_margin: " + exact_text(gate.policy.share_margin) +
         "\ntime_margin_s: " + exact_text(gate.policy.time_margin_s) + "\nworst: " + exact_text(gate.policy.worst) +
         "\n";
}

std::string to_csv(const GateRun& run) {
  std::string text =
      "# Accepted run, written by 'tumble gate SUITE --accept': status and metrics of each method, one column per "
      "seed.\n";
  text += "scenario,kind,method,metric";
  for (const std::uint64_t seed : run.seeds) text += "," + std::to_string(seed);
  text += "\n";
  for (const MethodRun& method : run.methods) {
    const std::string key = method.scenario + "," + to_string(method.kind) + "," + method.method + ",";
    text += key + kStatusRow;
    for (const auto& status : method.status) text += std::string(",") + (status ? to_string(*status) : "");
    text += "\n";
    for (const auto& [metric, values] : method.values) {
      text += key + metric;
      for (const double value : values) text += "," + (std::isfinite(value) ? exact_text(value) : std::string());
      text += "\n";
    }
  }
  return text;
}

namespace {

constexpr std::uint64_t kDrawsMax = 1000;  // the exact tests take cubic time

MethodRun& method_run(const Outcome& outcome, GateRun& run) {
  for (MethodRun& each : run.methods) {
    if (each.scenario == outcome.scenario && each.kind == outcome.kind && each.method == outcome.method) return each;
  }
  run.methods.push_back({outcome.scenario, outcome.kind, outcome.method, {}, {}});
  run.methods.back().status.resize(run.seeds.size());
  return run.methods.back();
}

void add(const Outcome& outcome, GateRun& run) {
  const auto seed = std::lower_bound(run.seeds.begin(), run.seeds.end(), outcome.seed);
  if (seed == run.seeds.end() || *seed != outcome.seed || !outcome.setting.is_plain()) return;
  const auto draw = static_cast<std::size_t>(seed - run.seeds.begin());
  MethodRun& method = method_run(outcome, run);
  method.status[draw] = outcome.status;
  if (outcome.status != OutcomeStatus::ok) return;
  const std::vector<std::string> held = held_metrics(outcome.kind);
  for (const Score& score : outcome.scores) {
    if (std::find(held.begin(), held.end(), score.metric) == held.end()) continue;
    std::vector<double>& values = method.values[score.metric];
    values.resize(run.seeds.size(), std::numeric_limits<double>::quiet_NaN());
    values[draw] = score.value;
  }
}

}  // namespace

GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last) {
  if (last < first || last - first >= kDrawsMax) {
    throw BadInput(
        fmt::format("'tumble gate' compares 1 to {} seeds, but the given range is {} to {}", kDrawsMax, first, last));
  }
  GateRun run;
  for (std::uint64_t seed = first; seed <= last; ++seed) run.seeds.push_back(seed);
  for (const Outcome& outcome : outcomes) add(outcome, run);
  std::sort(run.methods.begin(), run.methods.end(), [](const MethodRun& a, const MethodRun& b) {
    return std::tie(a.scenario, a.kind, a.method) < std::tie(b.scenario, b.kind, b.method);
  });
  return run;
}

GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last) {
  std::vector<Outcome> outcomes = results.outcomes();
  std::size_t at = 0;
  for (const ScoreRow& row : results.scores()) {
    if (row.kind.empty()) continue;  // rejected run
    const auto is_of = [&](const Outcome& outcome) {
      return outcome.scenario == row.scenario && outcome.seed == row.seed && row.kind == to_string(outcome.kind) &&
             outcome.method == row.method;
    };
    while (at < outcomes.size() && !is_of(outcomes[at])) ++at;
    if (at == outcomes.size()) break;
    outcomes[at].scores.push_back({row.metric, row.value});
  }
  return gate_run(outcomes, first, last);
}

}  // namespace tumble::scenarios
