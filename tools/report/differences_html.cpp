// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/differences_html.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tools/html/html.hpp"
#include "tools/report/score_html.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

namespace {

using html::cell;
using html::escaped;
using scenarios::Contest;
using scenarios::FailureComparison;
using scenarios::Finding;
using scenarios::MetricComparison;

std::string finding_cell(Finding finding) {
  return cell(to_string(finding), finding == Finding::better ? "good" : finding == Finding::worse ? "bad" : "");
}

std::string row_html(const MetricComparison& row) {
  return "<tr><td><code>" + escaped(row.metric) + "</code></td>" + cell(row.contest.method) +
         cell(std::to_string(row.pairs), "number") + cell(styled_value(row.metric, row.median, true), "number") +
         cell(styled_value(row.metric, row.against_median, true), "number") +
         cell(styled_value(row.metric, row.difference.value, false) + " " + styled_interval(row.metric, row.difference),
              "number") +
         cell(fmt::format("{} : {}", row.better, row.worse), "number") + cell(chance_text(row.corrected), "number") +
         finding_cell(row.finding) +
         cell(more_draws_text(row.pairs_needed, row.pairs, row.finding == Finding::undecided), "number") + "</tr>\n";
}

std::string percent(const scenarios::Interval& share) {
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high);
}

std::string row_html(const FailureComparison& row) {
  return "<tr><td>" + escaped(row.what) + "</td>" + cell(row.contest.method) +
         cell(std::to_string(row.pairs), "number") + cell(percent(row.share), "number") +
         cell(percent(row.against_share), "number") + cell(std::to_string(row.only_method), "number") +
         cell(std::to_string(row.only_against), "number") + cell(chance_text(row.corrected), "number") +
         finding_cell(row.finding) + "</tr>\n";
}

template <class Row>
std::string folded_tables(const std::vector<Row>& rows, const std::vector<std::string>& columns) {
  std::string out;
  for (auto row = rows.begin(); row != rows.end();) {
    const Contest& contest = row->contest;
    out += fmt::format("<details><summary>{} · {}, compared with <code>{}</code></summary>\n",
                       escaped(contest.scenario), to_string(contest.kind), escaped(contest.against)) +
           html::table_head(columns, 2);
    for (; row != rows.end() && one_section(row->contest, contest); ++row) out += row_html(*row);
    out += "</tbody></table></div></details>\n";
  }
  return out;
}

}  // namespace

std::string differences_html(const std::vector<MetricComparison>& rows) {
  if (rows.empty()) return "<p>No method can be compared with a baseline.</p>\n";
  return fmt::format(
             "<p>Each method is compared with the baseline of its task on the same simulated runs. The tables show the "
             "median of the paired differences with its 95 % bootstrap interval (BCa). They also show the number of "
             "runs on which the method was better and worse. The last column is the p-value of the signed-rank test, "
             "with Holm’s correction for the {} comparisons of this page. A failed run ranks as the worst.</p>\n",
             rows.size()) +
         folded_tables(rows, {"metric", "method", "simulated runs", "median", "baseline", "median difference [95 %]",
                              "better : worse", "p (Holm)", "finding", "more runs needed"});
}

std::string paired_failures_html(const std::vector<FailureComparison>& rows) {
  std::vector<FailureComparison> failed;
  for (const FailureComparison& row : rows) {
    if (row.share.value > 0.0 || row.against_share.value > 0.0) failed.push_back(row);
  }
  if (failed.empty()) return "";
  return "<p>The table shows the shares of simulated runs with a failed method run (status other than <i>ok</i>) or a "
         "negative verdict, with 95 % intervals (Clopper–Pearson). Further columns count the simulated runs on which "
         "only the method failed, and on which only the baseline failed. The last column shows McNemar’s paired test "
         "with Holm’s correction. The table leaves out pairs of methods without a failure.</p>\n" +
         folded_tables(failed, {"failure", "method", "simulated runs", "share [95 %]", "baseline [95 %]",
                                "method alone", "baseline alone", "p (Holm)", "finding"});
}

}  // namespace tumble::tools
