// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

/// Returns one row per entry: quantity, subject, value, accepted range, unit, and verdict (or the reason for a missing
/// value).
Table certificate_table(const scenarios::Certificate& certificate);

/// Formats the accepted range of a value: "<= 1e-08" or "0.001 to 0.02". A lower limit of 0 is omitted.
std::string bound_text(double low, double high);

}  // namespace tumble::tools
