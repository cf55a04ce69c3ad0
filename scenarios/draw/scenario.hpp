// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/distribution.hpp"
#include "scenarios/draw/named_case.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

struct Scenario {
  struct Part {
    std::string type;
    std::map<std::string, Distribution> numbers;
    int line = 0;
  };
  struct Sensor {
    std::string name, kind, device, site;
    std::map<std::string, Distribution> numbers;
    std::map<std::string, Distribution> mount_error;
    int line = 0;
  };
  std::string name;
  std::string doc;
  std::string file;
  Distribution duration_s;
  Part world, robot, motion;
  std::vector<Sensor> sensors;
  std::map<std::string, std::uint64_t> streams;  ///< as in sim::Situation
  std::optional<NamedCase> named_case;           ///< for files in scenarios/regressions
};

std::vector<std::string> scenario_names(const DataRoot& data);

std::vector<std::string> case_names(const DataRoot& data);

/// Loads scenarios/catalogue/NAME.yaml, scenarios/regressions/NAME.yaml, or the file `name` if its name ends in
/// ".yaml".
Scenario load_scenario(const DataRoot& data, const std::string& name);

/// Draws all random parameters of the scenario with the random seed `seed`. Parameters of sensors come from their data
/// sheets.
sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed);

/// The conversion of a simulated run's parameters to YAML and back preserves all bits.
std::string to_yaml(const sim::Situation& situation);
sim::Situation situation_from_yaml(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
