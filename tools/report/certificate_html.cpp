// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/certificate_html.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/html/html.hpp"
#include "tools/tables/certificate_table.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

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
