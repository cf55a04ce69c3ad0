// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/contests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tumble::tools {

namespace {

using scenarios::Finding;
using scenarios::Kind;
using scenarios::metric_info;
using scenarios::MetricComparison;
using scenarios::MetricInfo;
using scenarios::Section;
using scenarios::Sense;
using scenarios::Summary;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_of(const MetricComparison& row, const Section& section) {
  return row.contest.scenario == section.scenario && row.contest.kind == section.kind;
}

std::vector<const MetricComparison*> rows_of(const Section& section, const scenarios::Comparison& comparison) {
  std::vector<const MetricComparison*> rows;
  for (const std::string& metric : scenarios::headline_metrics(section.kind)) {
    if (metric_info(metric).sense == Sense::none) continue;
    for (const MetricComparison& row : comparison.metrics) {
      if (is_of(row, section) && row.metric == metric) rows.push_back(&row);
    }
    if (!rows.empty()) break;
  }
  return rows;
}

double badness(const MetricInfo& info, double difference) {
  return info.sense == Sense::higher ? -difference : difference;
}

ContestResult result_of(const MetricComparison& row) {
  const MetricInfo& info = metric_info(row.metric);
  ContestResult out{row};
  const double low = badness(info, row.difference.low), high = badness(info, row.difference.high);
  if (row.finding != Finding::undecided) {
    out.certainty = Certainty::corrected;
    out.better = row.finding == Finding::better;
  } else {
    out.certainty = low * high > 0.0 ? Certainty::interval : Certainty::open;
    out.better = badness(info, row.difference.value) < 0.0;
  }
  const double scale = info.sense == Sense::two_sided ? kNaN : 100.0 / std::abs(row.against_median);
  const bool known = std::isfinite(row.against_median) && row.against_median != 0.0;
  const double factor = known ? scale : kNaN;
  out.percent = std::isfinite(row.difference.value) ? row.difference.value * factor : kNaN;
  out.percent_low = row.difference.low * factor;
  out.percent_high = row.difference.high * factor;
  if (info.sense == Sense::lower && row.median > 0.0 && std::isfinite(row.against_median))
    out.times = row.against_median / row.median;
  return out;
}

const MetricComparison* best_of(const std::vector<const MetricComparison*>& rows) {
  const MetricComparison* best = nullptr;
  for (const MetricComparison* row : rows) {
    if (best == nullptr || scenarios::is_better(metric_info(row->metric), row->median, best->median)) best = row;
  }
  return best;
}

std::string contests_text(std::size_t count) {
  return count == 1 ? "1 contest" : fmt::format("{} contests", count);
}

}  // namespace

std::vector<ContestResult> contests(const Summary& summary, const scenarios::Comparison& comparison) {
  std::vector<ContestResult> out, of_attitude;
  for (const Section& section : summary.sections) {
    const MetricComparison* best = best_of(rows_of(section, comparison));
    if (best != nullptr) (section.kind == Kind::attitude ? of_attitude : out).push_back(result_of(*best));
  }
  return out.empty() ? of_attitude : out;
}

Tally tally(const std::vector<ContestResult>& results) {
  Tally out;
  out.contests = results.size();
  std::map<std::string, std::size_t> won;
  for (const ContestResult& result : results) {
    out.won += result.won();
    out.lost += result.lost();
    out.open += !result.won() && !result.lost();
    const bool on_every_draw = result.certainty == Certainty::open && result.row.better == result.row.pairs;
    if (result.better && (on_every_draw || result.certainty == Certainty::interval)) {
      const std::string& method = result.row.contest.method;
      out.ahead_by = out.ahead == 0 || out.ahead_by == method ? method : "";
      ++out.ahead;
    }
    if (result.won()) ++won[result.row.contest.method];
  }
  for (const ContestResult& result : results) {
    const std::string& method = result.row.contest.method;
    const auto count = won.find(method);
    if (count == won.end() || count->second <= out.leader_won) continue;
    out.leader = method;
    out.leader_won = count->second;
  }
  return out;
}

std::string tally_text(const Tally& tally) {
  if (tally.contests == 0) return "The results contain no method that can be compared with a baseline";
  if (tally.leader.empty() && tally.lost == tally.contests)
    return fmt::format("The baseline is better in all of {}", contests_text(tally.contests));
  if (tally.leader.empty() && tally.ahead > 0)
    return fmt::format("{} ahead of the baseline in {} of {}, but there are too few simulated runs for certainty",
                       tally.ahead_by.empty() ? "The best methods are" : tally.ahead_by + " is", tally.ahead,
                       contests_text(tally.contests));
  if (tally.leader.empty())
    return fmt::format("No method is significantly better than the baseline in {}", contests_text(tally.contests));
  if (tally.leader_won == tally.contests)
    return fmt::format("{} is better than the baseline in {}", tally.leader,
                       tally.contests == 1 ? "the one contest" : fmt::format("all {} contests", tally.contests));
  std::string out = fmt::format("{} is the best method, and significantly better than the baseline, in {} of {}",
                                tally.leader, tally.leader_won, contests_text(tally.contests));
  if (tally.won > tally.leader_won)
    out += fmt::format("; other methods are better than the baseline in {}", tally.won - tally.leader_won);
  return out;
}

std::string certainty_text(const ContestResult& result, std::size_t comparisons) {
  switch (result.certainty) {
    case Certainty::corrected:
      return fmt::format("The method is significantly {}, after correction for {} comparisons",
                         result.better ? "better" : "worse", comparisons);
    case Certainty::interval:
      return fmt::format(
          "The method is {} according to the interval, but the difference is not significant after correction for {} "
          "comparisons",
          result.better ? "better" : "worse", comparisons);
    case Certainty::open:
      break;
  }
  const double more = result.row.pairs_needed - static_cast<double>(result.row.pairs);
  if (more >= 1.0 && more < 1e6)
    return fmt::format("The difference is not significant; about {:.0f} more simulated runs are needed for a decision",
                       std::ceil(more));
  return "not significant";
}

}  // namespace tumble::tools
