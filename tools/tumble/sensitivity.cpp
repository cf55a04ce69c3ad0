// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "tools/tumble/numbers_of_draws.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::BadInput;
using scenarios::Influence;
using scenarios::Sensitivity;

constexpr std::size_t kShown = 3;

struct SensitivityVerbOptions {
  std::filesystem::path database;
  std::vector<std::string> methods, metrics;
  bool motion = false, all = false, dependence = false;
};

void require_same_data(const scenarios::Results& results, const scenarios::DataRoot& data,
                       const std::filesystem::path& database) {
  const std::string made_of = results.note("data"), found = scenarios::data_digest(data);
  if (made_of != found)
    throw BadInput(
        fmt::format("{}: these results come from models and scenarios with digest '{}', but this installation has "
                    "models and scenarios with digest {}. The random parameters of the simulated runs are therefore "
                    "unknown. Use --motion for the influence of the motions",
                    database.string(), made_of, found));
}

std::map<std::string, scenarios::NumbersOfDraws> numbers_of(const Session& session,
                                                            const SensitivityVerbOptions& options,
                                                            const scenarios::Results& results,
                                                            const scenarios::Summary& summary) {
  if (options.motion) return numbers_of_motions(results.draws(), summary);
  const scenarios::DataRoot data = session.data();
  require_same_data(results, data, options.database);
  return numbers_of_catalogue(session, data, summary);
}

std::vector<Influence> shown(const Sensitivity& row, bool all) {
  std::vector<Influence> out;
  for (const Influence& each : row.influences) {
    if (all || (out.size() < kShown && each.corrected < scenarios::kInfluenceRisk)) out.push_back(each);
  }
  return out;
}

std::vector<Table> tables_of(const std::vector<Sensitivity>& rows, bool all) {
  std::vector<Table> tables;
  const Sensitivity* open = nullptr;
  for (const Sensitivity& row : rows) {
    if (open == nullptr || open->scenario != row.scenario || open->kind != row.kind) {
      tables.emplace_back(
          fmt::format("{}: influence of the random parameters on scores of {} methods", row.scenario,
                      to_string(row.kind)),
          std::vector<std::string>{"method", "metric", "draws", "number", "first order", "rank correlation", "95 %",
                                   "Holm p", "median, lowest quarter", "highest"});
      tables.back().align_right_from(4);
      open = &row;
    }
    const std::vector<Influence> strongest = shown(row, all);
    if (strongest.empty())
      tables.back().add_row({row.method, row.metric, std::to_string(row.draws), "(no significant influence)"});
    bool first = true;
    for (const Influence& each : strongest) {
      tables.back().add_row({first ? row.method : "", first ? row.metric : "", first ? std::to_string(row.draws) : "",
                             each.number, fmt::format("{:.2f}", each.first_order.index),
                             fmt::format("{:+.2f}", each.correlation.rho),
                             fmt::format("[{:+.2f}, {:+.2f}]", each.correlation.low, each.correlation.high),
                             chance_text(each.corrected), number_text(each.median_low), number_text(each.median_high)});
      first = false;
    }
  }
  return tables;
}

Table dependence_table(const std::vector<Sensitivity>& rows, bool all) {
  Table table("partial dependence: median score, or share of failures, for each interval of a parameter's values",
              {"scenario", "method", "metric", "number", "from", "to", "draws", "score", "95 %"});
  table.align_right_from(4);
  for (const Sensitivity& row : rows) {
    for (const Influence& each : shown(row, all)) {
      bool first = true;
      for (const scenarios::DependenceClass& part : each.dependence) {
        const auto once = [&](const std::string& text) { return first ? text : std::string(); };
        table.add_row({once(row.scenario), once(full_name(row.kind, row.method)), once(row.metric), once(each.number),
                       number_text(part.low), number_text(part.high), std::to_string(part.draws),
                       number_text(part.centre.value),
                       "[" + number_text(part.centre.low) + ", " + number_text(part.centre.high) + "]"});
        first = false;
      }
    }
  }
  return table;
}

json to_json(const std::vector<scenarios::DependenceClass>& dependence) {
  json out = json::array();
  for (const scenarios::DependenceClass& part : dependence) {
    out.push_back({{"from", part.low},
                   {"to", part.high},
                   {"draws", part.draws},
                   {"score", finite(part.centre.value)},
                   {"low", finite(part.centre.low)},
                   {"high", finite(part.centre.high)}});
  }
  return out;
}

json to_json(const std::vector<Sensitivity>& rows) {
  json out = json::array();
  for (const Sensitivity& row : rows) {
    json numbers = json::array(), breaks = json::array();
    for (const Influence& each : row.influences) {
      numbers.push_back({{"number", each.number},
                         {"first_order", each.first_order.index},
                         {"classes", each.first_order.classes},
                         {"rho", each.correlation.rho},
                         {"rho_low", each.correlation.low},
                         {"rho_high", each.correlation.high},
                         {"holm_p", each.corrected},
                         {"median_lowest_quarter", finite(each.median_low)},
                         {"median_highest_quarter", finite(each.median_high)},
                         {"dependence", to_json(each.dependence)}});
    }
    for (const Influence& each : shown(row, false)) breaks.push_back(each.number);
    out.push_back({{"scenario", row.scenario},
                   {"kind", to_string(row.kind)},
                   {"method", row.method},
                   {"metric", row.metric},
                   {"draws", row.draws},
                   {"breaks_it", std::move(breaks)},
                   {"numbers", std::move(numbers)}});
  }
  return out;
}

int sensitivity(const Session& session, const SensitivityVerbOptions& options) {
  const scenarios::Results results(options.database, scenarios::Results::Mode::read_only);
  const scenarios::Summary summary = scenarios::summarize(results);
  const std::vector<Sensitivity> rows = scenarios::sensitivities(
      summary, numbers_of(session, options, results, summary), {options.methods, options.metrics});
  if (rows.empty())
    throw BadInput(
        fmt::format("{}: this database contains too few simulated runs; a scenario needs at least {} simulated runs "
                    "and one random parameter",
                    options.database.string(), scenarios::kSensitivityDrawsMin));
  std::vector<Table> tables = tables_of(rows, options.all);
  if (options.dependence) tables.push_back(dependence_table(rows, options.all));
  session.print(tables, {{"sensitivity", to_json(rows)}});
  session.note(
      "a correlation above 0 means that larger values of the parameter give worse scores; see "
      "docs/maths/statistics.md");
  return kDone;
}

}  // namespace

Action declare_sensitivity(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<SensitivityVerbOptions>();
  verb.add("DATABASE", options->database, "reads this results database, FILE.db").required();
  verb.add("--method", options->methods,
           "shows this method; repeat the option for more methods [default: all methods that need no truth]")
      .one_at_a_time();
  verb.add("--metric", options->metrics,
           "shows this metric; repeat the option for more metrics [default: the most important metrics of the kind]")
      .one_at_a_time();
  verb.add_flag("--motion", options->motion,
                "shows the influence of the motions (for example the largest rate) instead of the random parameters");
  verb.add_flag("--all", options->all,
                "lists every parameter [default: the three parameters with the strongest significant influence]");
  verb.add_flag("--dependence", options->dependence,
                "also divides the values of each listed parameter into intervals, and lists the score (with confidence "
                "interval) per interval");
  return [&session, options] { return sensitivity(session, *options); };
}

}  // namespace tumble::tools
