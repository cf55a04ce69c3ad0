// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tables/certificate_table.hpp"

#include <cmath>

namespace tumble::tools {

namespace {

std::string verdict(const scenarios::CertificateEntry& entry) {
  return entry.passes() ? "pass" : "FAIL";
}

}  // namespace

std::string bound_text(double low, double high) {
  if (low == high) return number_text(low);
  if (low == 0.0) return "<= " + number_text(high);
  if (std::isinf(high)) return ">= " + number_text(low);
  if (std::isinf(low)) return "<= " + number_text(high);
  return number_text(low) + " to " + number_text(high);
}

Table certificate_table(const scenarios::Certificate& certificate) {
  Table table("", {"row", "on", "value", "bound", "unit", "verdict"});
  for (const scenarios::CertificateEntry& entry : certificate.entries) {
    table.add_row({entry.row, entry.subject, number_text(entry.value), bound_text(entry.low, entry.high), entry.unit,
                   verdict(entry) + (entry.note.empty() ? "" : ": " + entry.note)});
  }
  return table;
}

}  // namespace tumble::tools
