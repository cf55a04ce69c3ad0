// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::tools {

struct CostRow {
  std::string scenario, method;  ///< method: KIND/NAME
  double cpu_s = 0.0;            ///< of one estimate
  /// Median of recording duration / CPU time over the simulated runs; above 1, the method is faster than real time on
  /// one processor
  double real_time_factor = 0.0;
};

std::vector<CostRow> cost_rows(const scenarios::Summary& summary, std::span<const scenarios::DrawValues> draws);

std::string costs_html(const std::vector<CostRow>& rows);

std::string certificate_summary(const scenarios::Certificate& certificate);

std::string certificates_html(std::span<const scenarios::Certificate> certificates);

}  // namespace tumble::tools
