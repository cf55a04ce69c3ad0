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
    int line = 0;  ///< line in the file, for messages
  };
  struct Sensor {
    std::string name, kind, device, site;
    std::map<std::string, Distribution> numbers;
    std::map<std::string, Distribution> mount_error;
    int line = 0;
  };
  std::string name;
  std::string doc;
  std::string file;  ///< path of the file, for messages
  Distribution duration_s;
  Part world, robot, motion;
  std::vector<Sensor> sensors;
  std::optional<NamedCase> named_case;  ///< set for files in scenarios/regressions, whose parameters are constants
};

std::vector<std::string> scenario_names(const DataRoot& data);

/// Functions that accept a scenario name also accept the name of a named case.
std::vector<std::string> case_names(const DataRoot& data);

/// Loads the scenario scenarios/catalogue/NAME.yaml, the named case scenarios/regressions/NAME.yaml, or the file `name`
/// if it ends in ".yaml". Throws BadInput, with file and line, if the file is missing or invalid.
Scenario load_scenario(const DataRoot& data, const std::string& name);

/// Draws all random parameters of the scenario with `seed`, and adds the numbers of the sensors' data sheets. Throws
/// BadInput if the scenario contradicts a data sheet or contains a component that this build lacks.
sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed);

/// The functions to_yaml and situation_from_yaml convert a resolved situation to and from YAML without loss of bits. On
/// invalid text or values, both throw BadInput with a message that starts with `place`.
std::string to_yaml(const sim::Situation& situation);
sim::Situation situation_from_yaml(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
