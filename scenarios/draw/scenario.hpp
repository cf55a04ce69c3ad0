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

/// Scenario contains the content of a scenario file. Each number of the simulated situation is constant or random.
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
  std::optional<NamedCase> named_case;  ///< set for files in scenarios/regressions, which have no random numbers
};

/// Returns the names of all scenario files, sorted.
std::vector<std::string> scenario_names(const DataRoot& data);

/// Returns the names of the named cases (scenarios/regressions/NAME.yaml), sorted. Every function that accepts a
/// scenario name also accepts the name of a named case. No scenario has the same name as a named case.
std::vector<std::string> case_names(const DataRoot& data);

/// Loads a scenario: scenarios/catalogue/NAME.yaml, the named case scenarios/regressions/NAME.yaml, or a file if `name`
/// ends in ".yaml". Throws BadInput, with file and line, if the file is missing or invalid. The message for an unknown
/// name or key suggests the nearest known name.
Scenario load_scenario(const DataRoot& data, const std::string& name);

/// Draws all random numbers of the scenario with `seed`, and fills in the numbers of the sensors' data sheets. Each
/// number has a random stream that is named after its place ("world.slope_rad", "sensors.imu.mount_error.x_m"). Throws
/// BadInput if the scenario does not fit the data sheets or this build.
sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed);

/// The functions to_yaml and situation_from_yaml convert a resolved situation to and from YAML without loss of bits.
/// Reading rejects unknown keys, and sim::resolve checks that this build has the named types and numbers. On invalid
/// text or numbers, to_yaml and situation_from_yaml throw BadInput with a message that starts with `place`.
std::string to_yaml(const sim::Situation& situation);
sim::Situation situation_from_yaml(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
