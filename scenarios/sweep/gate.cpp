// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/gate.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric_sense.hpp"
#include "scenarios/sweep/statistics.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The outcomes that a bound speaks of, by their seeds' scores.
struct Selection {
  std::vector<double> values;  ///< of outcomes that are ok, and the worst value for those that are not
  std::size_t outcomes = 0, not_ok = 0;
};

class Draws {
 public:
  Draws(const Results& results, std::uint64_t first, std::uint64_t last)
      : outcomes_(results.outcomes()), rows_(results.scores()) {
    std::erase_if(outcomes_, [&](const Outcome& row) { return row.seed < first || row.seed > last; });
    std::erase_if(rows_, [&](const ScoreRow& row) { return row.seed < first || row.seed > last; });
  }

  Selection select(const GateBound& bound) const {
    Selection out;
    const Sense sense = metric_sense(bound.metric);
    for (const Outcome& outcome : outcomes_) {
      if (outcome.scenario != bound.scenario || outcome.kind != bound.kind || outcome.method != bound.method) continue;
      ++out.outcomes;
      if (outcome.status == "ok") continue;
      ++out.not_ok;
      if (sense != Sense::neither) out.values.push_back(sense == Sense::more ? -kInfinity : kInfinity);
    }
    for (const ScoreRow& row : rows_) {
      const bool speaks = row.scenario == bound.scenario && row.kind == to_string(bound.kind) &&
                          row.method == bound.method && row.metric == bound.metric && row.status == "ok";
      if (speaks && !std::isnan(row.value)) out.values.push_back(row.value);
    }
    return out;
  }

  const std::vector<Outcome>& outcomes() const { return outcomes_; }

 private:
  std::vector<Outcome> outcomes_;
  std::vector<ScoreRow> rows_;
};

GateResult hold(const Draws& draws, const GateBound& bound) {
  const Selection selection = draws.select(bound);
  GateResult result{bound, std::nan(""), selection.values.size()};
  switch (bound.statistic) {
    case Statistic::median:
      result.value = quantile(selection.values, 0.5);
      break;
    case Statistic::quantile_05:
      result.value = quantile(selection.values, 0.05);
      break;
    case Statistic::quantile_95:
      result.value = quantile(selection.values, 0.95);
      break;
    case Statistic::share_not_ok:
      result.draws = selection.outcomes;
      if (selection.outcomes > 0) {
        result.value = static_cast<double>(selection.not_ok) / static_cast<double>(selection.outcomes);
      }
      break;
  }
  return result;
}

std::string place_of(const GateBound& bound) {
  return bound.scenario + ", " + to_string(bound.kind) + "/" + bound.method + ", " + to_string(bound.statistic) +
         (bound.metric.empty() ? "" : " of " + bound.metric);
}

}  // namespace

const char* to_string(Statistic statistic) {
  switch (statistic) {
    case Statistic::median:
      return "median";
    case Statistic::quantile_05:
      return "quantile_05";
    case Statistic::quantile_95:
      return "quantile_95";
    case Statistic::share_not_ok:
      return "share_not_ok";
  }
  return "";
}

std::vector<GateResult> hold_to_gate(const Results& results, const Gate& gate, std::uint64_t first,
                                     std::uint64_t last) {
  const Draws draws(results, first, last);
  std::vector<GateResult> held;
  for (const GateBound& bound : gate.bounds) held.push_back(hold(draws, bound));
  return held;
}

Gate accept(const Gate& gate, const std::vector<GateResult>& results, double margin) {
  if (!(margin >= 0.0 && margin <= 10.0)) {
    throw BadInput("the margin is " + std::to_string(margin) + ", must be within [0, 10]");
  }
  Gate accepted{gate.suite, margin, {}};
  for (const GateResult& result : results) {
    GateBound bound = result.bound;
    if (!std::isfinite(result.value)) {
      throw BadInput("cannot accept this run: " + place_of(bound) + " is " + std::to_string(result.value));
    }
    bound.accepted = result.value;
    bound.low = -kInfinity;
    bound.high = kInfinity;
    const double room = margin * std::abs(result.value);
    if (bound.statistic == Statistic::share_not_ok) {
      // where none failed none may: a margin would let failures in that a user meets
      bound.high = result.value > 0.0 ? std::min(1.0, result.value + margin) : 0.0;
    } else {
      const Sense sense = metric_sense(bound.metric);
      if (sense != Sense::more) bound.high = result.value + room;
      if (sense != Sense::less) bound.low = result.value - room;
    }
    accepted.bounds.push_back(bound);
  }
  return accepted;
}

Gate proposed_gate(const Results& results, const std::string& suite) {
  Gate gate{suite, 0.0, {}};
  std::set<std::pair<std::string, Kind>> seen;
  for (const Outcome& outcome : results.outcomes()) {
    if (outcome.method != "tumble" || !seen.insert({outcome.scenario, outcome.kind}).second) continue;
    GateBound bound{outcome.scenario, outcome.kind, outcome.method, Statistic::share_not_ok, "", 0.0,
                    -kInfinity,       kInfinity};
    gate.bounds.push_back(bound);
    for (const std::string& metric : headline_metrics(outcome.kind)) {
      bound.metric = metric;
      bound.statistic = Statistic::median;
      gate.bounds.push_back(bound);
      bound.statistic = metric_sense(metric) == Sense::more ? Statistic::quantile_05 : Statistic::quantile_95;
      gate.bounds.push_back(bound);
    }
    for (const std::string& metric : consistency_metrics(outcome.kind)) {
      bound.metric = metric;
      bound.statistic = Statistic::median;
      gate.bounds.push_back(bound);
    }
  }
  return gate;
}

}  // namespace tumble::scenarios
