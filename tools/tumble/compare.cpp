// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/asked.hpp"
#include "tools/tumble/score_tables.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::BadInput;
using scenarios::Comparison;
using scenarios::Contest;
using scenarios::FailureComparison;
using scenarios::Finding;
using scenarios::MetricComparison;

struct CompareOptions {
  std::filesystem::path database;
  std::vector<std::string> methods, metrics;
  std::string against, margin;
  double risk = 0.05, power = 0.8;
};

scenarios::ComparisonOptions read(const CompareOptions& options) {
  scenarios::ComparisonOptions out;
  out.methods = options.methods;
  out.against = options.against;
  if (out.against.empty() && out.methods.size() > 1) {
    out.against = out.methods.back();
    out.methods.pop_back();
  }
  out.metrics = options.metrics;
  if (!options.margin.empty()) out.margin = parse_margin("--margin", options.margin);
  if (out.margin && !out.margin->relative && out.metrics.empty())
    throw BadInput(
        fmt::format("--margin {} is in the unit of a metric, but no metric is named; add --metric, or give a "
                    "percentage such as 10%",
                    options.margin));
  out.risk = options.risk;
  out.power = options.power;
  return out;
}

std::string title_of(const Contest& contest, const std::string& what) {
  return fmt::format("{}: {}, {}", contest.scenario, to_string(contest.kind), what);
}

struct ComparisonRow {
  std::vector<std::string> heads = {}, cells = {};

  void add(const std::string& head, std::string cell) {
    heads.push_back(head);
    cells.push_back(std::move(cell));
  }
  void add_ends(const std::string& head, const scenarios::Interval& interval, double unit = 1.0) {
    const auto end = [&](double value) { return std::isfinite(value) ? fmt::format("{:.6g}", unit * value) : ""; };
    add(head + " low", end(interval.low));
    add(head + " high", end(interval.high));
  }
};

ComparisonRow cells_of(const MetricComparison& row, bool margin, bool apart) {
  ComparisonRow out;
  out.add("metric", row.metric);
  out.add("method", row.contest.method);
  out.add("draws", std::to_string(row.pairs));
  out.add("median", number_text(row.median));
  out.add("against", number_text(row.against_median));
  out.add("median difference", number_text(row.difference.value));
  if (apart) {
    out.add_ends("95 % (BCa)", row.difference);
    out.add("better", std::to_string(row.better));
    out.add("worse", std::to_string(row.worse));
  } else {
    out.add("95 % (BCa)", interval_text(row.difference));
    out.add("better : worse", fmt::format("{} : {}", row.better, row.worse));
  }
  out.add("sign p", chance_text(row.sign_chance));
  out.add("signed rank p", chance_text(row.rank_chance));
  out.add("Holm p", chance_text(row.corrected));
  out.add("finding", to_string(row.finding));
  out.add("more draws", more_draws_text(row.pairs_needed, row.pairs, row.finding == Finding::undecided));
  if (margin) {
    out.add("no worse p", chance_text(row.not_inferior_chance));
    out.add(apart ? "no worse Holm p" : "Holm p", chance_text(row.not_inferior_corrected));
    out.add("no worse", row.not_inferior ? "yes" : "not shown");
  }
  return out;
}

std::string share_text(const scenarios::Interval& share) {
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high);
}

ComparisonRow cells_of(const FailureComparison& row, bool apart) {
  ComparisonRow out;
  out.add("failure", row.what);
  out.add("method", row.contest.method);
  out.add("draws", std::to_string(row.pairs));
  for (const auto& [head, share] : {std::pair{"share", row.share}, std::pair{"against", row.against_share}}) {
    if (apart) {
      out.add(head + std::string(" %"), fmt::format("{:.6g}", 100.0 * share.value));
      out.add_ends(head + std::string(" % 95 %"), share, 100.0);
    } else {
      out.add(head + std::string(" [95 %]"), share_text(share));
    }
  }
  out.add("method alone", std::to_string(row.only_method));
  out.add("the other alone", std::to_string(row.only_against));
  out.add("McNemar p", chance_text(row.chance));
  out.add("Holm p", chance_text(row.corrected));
  out.add("finding", to_string(row.finding));
  out.add("more draws", more_draws_text(row.pairs_needed, row.pairs, row.finding == Finding::undecided));
  return out;
}

template <typename Comparisons, typename Cells>
std::vector<Table> tables_of(const Comparisons& rows, const std::string& what, const Cells& cells) {
  std::vector<Table> tables;
  const Contest* open = nullptr;
  for (const auto& row : rows) {
    ComparisonRow own = cells(row);
    if (open == nullptr || !one_section(*open, row.contest)) {
      tables.emplace_back(title_of(row.contest, what + row.contest.against), std::move(own.heads));
      tables.back().align_right_from(2);
      open = &row.contest;
    }
    tables.back().add_row(std::move(own.cells));
  }
  return tables;
}

json contest_json(const Contest& contest) {
  return {{"scenario", contest.scenario},
          {"kind", to_string(contest.kind)},
          {"method", contest.method},
          {"against", contest.against}};
}

json to_json(const Comparison& comparison, bool margin) {
  json metrics = json::array(), failures = json::array();
  for (const MetricComparison& row : comparison.metrics) {
    json each = contest_json(row.contest);
    each.update({{"metric", row.metric},
                 {"pairs", row.pairs},
                 {"better", row.better},
                 {"worse", row.worse},
                 {"median", finite(row.median)},
                 {"against_median", finite(row.against_median)},
                 {"difference", interval_json(row.difference)},
                 {"sign_p", row.sign_chance},
                 {"signed_rank_p", row.rank_chance},
                 {"holm_p", finite(row.corrected)},
                 {"finding", to_string(row.finding)},
                 {"pairs_needed", finite(row.pairs_needed)}});
    if (margin) {
      each["not_inferior_p"] = finite(row.not_inferior_chance);
      each["not_inferior_holm_p"] = finite(row.not_inferior_corrected);
      each["not_inferior"] = row.not_inferior;
    }
    metrics.push_back(std::move(each));
  }
  for (const FailureComparison& row : comparison.failures) {
    json each = contest_json(row.contest);
    each.update({{"failure", row.what},
                 {"pairs", row.pairs},
                 {"share", interval_json(row.share)},
                 {"against_share", interval_json(row.against_share)},
                 {"only_method", row.only_method},
                 {"only_against", row.only_against},
                 {"mcnemar_p", row.chance},
                 {"holm_p", row.corrected},
                 {"finding", to_string(row.finding)},
                 {"pairs_needed", finite(row.pairs_needed)}});
    failures.push_back(std::move(each));
  }
  return {{"metrics", std::move(metrics)}, {"failures", std::move(failures)}};
}

int compare(const Session& session, const CompareOptions& options) {
  const scenarios::ComparisonOptions asked = read(options);
  const scenarios::Results results(options.database, scenarios::Results::Mode::read_only);
  const Comparison comparison = scenarios::compare(scenarios::summarize(results), asked);
  if (comparison.failures.empty())
    throw BadInput(
        fmt::format("{}: no simulated run of this database has results of two of the named methods; name methods that "
                    "ran on the same simulated runs",
                    options.database.string()));
  const bool apart = session.format == TableFormat::csv;
  std::vector<Table> tables = tables_of(comparison.metrics, "paired with ", [&](const MetricComparison& row) {
    return cells_of(row, asked.margin.has_value(), apart);
  });
  for (Table& table : tables_of(comparison.failures, "failures, paired with ",
                                [&](const FailureComparison& row) { return cells_of(row, apart); }))
    tables.push_back(std::move(table));
  session.print(tables, to_json(comparison, asked.margin.has_value()));
  session.note(
      fmt::format("the probability of at least one wrong conclusion in the {1} comparisons of metrics is at most "
                  "{0:g}. The same limit applies to the {2} comparisons of failures. The p-values are corrected with "
                  "Holm's method (docs/maths/statistics.md)",
                  options.risk, comparison.metrics.size(), comparison.failures.size()));
  return kDone;
}

}  // namespace

Action declare_compare(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<CompareOptions>();
  verb.add("DATABASE", options->database, "reads this results database, FILE.db").required();
  verb.add("--method", options->methods,
           "compares this method with the method of --against; repeat the option for more methods [default: all "
           "methods that need no truth]")
      .one_at_a_time();
  verb.add("--against", options->against,
           "compares the other methods with this method [default: the last --method if there are several, otherwise "
           "the baseline method]");
  verb.add("--metric", options->metrics,
           "compares this metric; repeat the option for more metrics [default: the most important metrics of the "
           "method's kind]")
      .one_at_a_time();
  verb.add("--margin", options->margin,
           "sets the margin: a method counts as 'not worse' if it is worse than the other method by less than the "
           "margin. Write a number in the metric's unit, or a percentage of the other method's value, for example 10%");
  verb.add("--risk", options->risk, "sets the maximum probability that a table contains a wrong conclusion")
      .within(1e-6, 0.5)
      .shows_default();
  verb.add("--power", options->power,
           "sets the power of the tests, from which the program computes the needed number of simulated runs")
      .within(0.5, 0.999)
      .shows_default();
  return [&session, options] { return compare(session, *options); };
}

}  // namespace tumble::tools
