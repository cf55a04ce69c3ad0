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

/// A scenario file as read: a family of situations.
struct Scenario {
  struct Part {
    std::string type;
    std::map<std::string, Distribution> numbers;
    int line = 0;  ///< of the file, for messages
  };
  struct Sensor {
    std::string name, kind, device, site;
    std::map<std::string, Distribution> numbers;
    std::map<std::string, Distribution> mount_error;
    int line = 0;
  };
  std::string name;
  std::string doc;
  std::string file;  ///< where it was read, for messages
  Distribution duration_s;
  Part world, robot, motion;
  std::vector<Sensor> sensors;
  std::optional<NamedCase> named_case;  ///< of a file in scenarios/regressions, none of whose numbers is drawn
};

/// Names of the scenarios in the catalogue, sorted.
std::vector<std::string> scenario_names(const DataRoot& data);

/// Names of the named cases, scenarios/regressions/NAME.yaml, sorted. They stand wherever a scenario's may, and no
/// scenario is called as one of them.
std::vector<std::string> case_names(const DataRoot& data);

/// Reads scenarios/catalogue/NAME.yaml, the named case scenarios/regressions/NAME.yaml, or a file when `name` ends in
/// ".yaml". Throws BadInput with file and line; an unknown name or key names the nearest known one.
Scenario load_scenario(const DataRoot& data, const std::string& name);

/// Fixes every number: data sheet of each device, the scenario's changes, draws from streams named by the number's
/// place
/// ("world.slope_rad", "sensors.imu.mount_error.x_m"). Throws BadInput.
sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed);

/// The resolved situation as YAML and back, without loss (doubles round-trip). Reading is strict, but does not ask
/// whether this build knows the types and numbers: sim::resolve does. Both throw BadInput; `place` begins the messages.
std::string to_yaml(const sim::Situation& situation);
sim::Situation situation_from_yaml(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
