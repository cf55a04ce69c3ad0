// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

Table certificate_table(const scenarios::Certificate& certificate);

std::string bound_text(double low, double high);

}  // namespace tumble::tools
