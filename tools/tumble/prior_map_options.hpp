// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "tools/tumble/verb_options.hpp"

namespace tumble::tools {

struct PriorMapOptions {
  std::filesystem::path map;
  std::vector<double> pose;  ///< x y z [m], heading [rad], deviations
  bool frozen = false;
};

void declare_prior_map(VerbOptions& verb, PriorMapOptions& options);

scenarios::Method with_prior_map(const scenarios::Method& method, const PriorMapOptions& options);

std::string localisation_text(const PriorMapOptions& options, const scenarios::Estimate& estimate);

}  // namespace tumble::tools
