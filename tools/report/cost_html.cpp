// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/cost_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenarios/scoring/metric.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "tools/html/html.hpp"
#include "tools/tables/certificate_table.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

namespace {

using Durations = std::map<std::pair<std::string, std::uint64_t>, double>;

Durations durations_of(std::span<const scenarios::DrawValues> draws) {
  Durations out;
  for (const scenarios::DrawValues& draw : draws) {
    for (const scenarios::Score& value : draw.values)
      if (value.metric == "motion_duration_s") out[{draw.scenario, draw.seed}] = value.value;
  }
  return out;
}

}  // namespace

std::vector<CostRow> cost_rows(const scenarios::Summary& summary, std::span<const scenarios::DrawValues> draws) {
  const Durations durations = durations_of(draws);
  std::vector<CostRow> rows;
  for (const scenarios::Section& section : summary.sections) {
    for (const scenarios::MethodSummary& method : section.methods) {
      const scenarios::MetricSummary* cost = method.find(scenarios::estimate_cost().name);
      if (cost == nullptr || cost->values.empty()) continue;
      std::vector<double> factors;
      for (std::size_t k = 0; k < cost->values.size(); ++k) {
        const auto duration = durations.find({section.scenario, cost->seeds[k]});
        if (duration != durations.end() && cost->values[k] > 0.0) factors.push_back(duration->second / cost->values[k]);
      }
      rows.push_back({section.scenario, full_name(section.kind, method.method), scenarios::quantile(cost->values, 0.5),
                      scenarios::quantile(factors, 0.5)});
    }
  }
  return rows;
}

std::string costs_html(const std::vector<CostRow>& rows) {
  if (rows.empty()) return "";
  std::string out =
      "<p>The real-time factor is the duration of a recording divided by the CPU time of its estimate (median over the "
      "simulated runs). A method with a factor above 1 is faster than real time on one "
      "processor.</p>\n<details><summary>Real-time factors</summary>\n" +
      html::table_head({"scenario", "method", "CPU time [s]", "real-time factor"}, 2);
  for (const CostRow& row : rows) {
    out += "<tr>" + html::cell(row.scenario) + "<td><code>" + html::escaped(row.method) + "</code></td>" +
           html::cell(number_text(row.cpu_s), "number") +
           html::cell(std::isnan(row.real_time_factor) ? "–" : number_text(row.real_time_factor), "number") + "</tr>\n";
  }
  return out + "</tbody></table></div></details>\n";
}

namespace {

using html::cell;
using html::escaped;

std::string row_html(const scenarios::CertificateEntry& entry) {
  const std::string unit = entry.unit == "1" ? "" : entry.unit;
  const std::string verdict = (entry.passes() ? "pass" : "fail") + (entry.note.empty() ? "" : ": " + entry.note);
  return "<tr><td>" + escaped(entry.row) + "</td>" + cell(entry.subject) + cell(number_text(entry.value), "number") +
         cell(bound_text(entry.low, entry.high), "number") + cell(unit, "unit") +
         cell(verdict, entry.passes() ? "" : "bad") + cell(entry.law, "law") + "</tr>\n";
}

}  // namespace

std::string certificate_summary(const scenarios::Certificate& certificate) {
  if (certificate.entries.empty()) return "none";
  const auto passed = std::count_if(certificate.entries.begin(), certificate.entries.end(),
                                    [](const scenarios::CertificateEntry& entry) { return entry.passes(); });
  return fmt::format("{} of {} values are within their bounds", passed, certificate.entries.size());
}

std::string certificates_html(std::span<const scenarios::Certificate> certificates) {
  std::string out =
      "<p>The table shows how well the simulation agrees with physics and with its data sheets. <code>tumble "
      "certify</code> measured the values for the build that computed these scores.</p>\n";
  if (certificates.empty()) out += "<p class=\"warning\">These results contain no certificate.</p>\n";
  for (const scenarios::Certificate& certificate : certificates) {
    out += "<details><summary>Build <code>" + escaped(certificate.build) +
           "</code>: " + escaped(certificate_summary(certificate)) + "</summary>\n" +
           "<div class=\"scroll\"><table><thead><tr><th>quantity</th><th>measured on</th><th "
           "class=\"number\">value</th><th class=\"number\">bound</th><th>unit</th><th>verdict</th><th>source of the "
           "bound</th></tr></thead><tbody>\n";
    for (const scenarios::CertificateEntry& entry : certificate.entries) out += row_html(entry);
    out += "</tbody></table></div></details>\n";
  }
  return out;
}

}  // namespace tumble::tools
