// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

/// A row per entry: what, on what, value, bound, unit, verdict (the reason when there is no value).
Table certificate_table(const scenarios::Certificate& certificate);

/// "<= 1e-08", "0.001 to 0.02": the accepted range of a value; nothing is said of a lower end of 0.
std::string bound_text(double low, double high);

}  // namespace tumble::tools
