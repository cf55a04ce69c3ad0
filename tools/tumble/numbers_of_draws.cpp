// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/numbers_of_draws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::tools {

NumbersByScenario numbers_of_catalogue(const Session& session, const scenarios::DataRoot& data,
                                       const scenarios::Summary& summary) {
  NumbersByScenario out;
  const std::vector<std::string> known = scenarios::scenario_names(data);
  for (const std::string& scenario : summary.scenarios) {
    if (std::find(known.begin(), known.end(), scenario) == known.end()) {
      session.note(
          fmt::format("{}: this scenario is left out, because the catalogue has no scenario of this name", scenario));
      continue;
    }
    out[scenario] = scenarios::numbers_of_draws(summary, scenarios::load_scenario(data, scenario));
  }
  return out;
}

NumbersByScenario numbers_of_motions(std::span<const scenarios::DrawValues> draws, const scenarios::Summary& summary) {
  NumbersByScenario out;
  for (const std::string& scenario : summary.scenarios) out[scenario] = scenarios::numbers_of_motion(draws, scenario);
  return out;
}

}  // namespace tumble::tools
