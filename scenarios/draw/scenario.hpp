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

/// A parsed scenario file: a family of situations.
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

/// Returns the names of the catalogue's scenarios, sorted.
std::vector<std::string> scenario_names(const DataRoot& data);

/// Returns the names of the named cases (scenarios/regressions/NAME.yaml), sorted. A case name can be used wherever a
/// scenario name can; the two sets are disjoint.
std::vector<std::string> case_names(const DataRoot& data);

/// Loads scenarios/catalogue/NAME.yaml, the named case scenarios/regressions/NAME.yaml, or a file if `name` ends in
/// ".yaml". Throws BadInput with file and line; for an unknown name or key, the message suggests the nearest known one.
Scenario load_scenario(const DataRoot& data, const std::string& name);

/// Fixes every number: applies the device data sheets, then the scenario's changes, then draws. Each draw uses the
/// stream named by the number's place ("world.slope_rad", "sensors.imu.mount_error.x_m"). Throws BadInput.
sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed);

/// Convert a resolved situation to and from YAML without loss (doubles round-trip). Reading rejects unknown keys;
/// sim::resolve checks whether this build knows the types and numbers. Both throw BadInput; messages start with
/// `place`.
std::string to_yaml(const sim::Situation& situation);
sim::Situation situation_from_yaml(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
