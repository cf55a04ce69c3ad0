// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/distribution.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

struct Expectation {
  std::string method;                ///< "slam/tumble"
  bool fails = false;                ///< true: the method is expected to fail
  std::string metric;                ///< checked in addition to the status
  std::optional<double> worse_than;  ///< the check fails above this value
  std::string status;                ///< status of the method on the accepted run
  std::optional<double> drawn;       ///< value of the metric before shrinking
  std::optional<double> value;       ///< on the accepted run
  bool operator==(const Expectation&) const = default;
};

/// NamedCase describes a simulated run on which a method failed, and the expected result of this run. A file of
/// scenarios/regressions contains a NamedCase under the key `case`.
struct NamedCase {
  std::string scenario;    ///< scenario of the original run
  std::uint64_t seed = 0;  ///< for values that the file omits
  std::string version;     ///< version of the program that simplified the run
  std::string command;     ///< command that simplified the run
  std::vector<Expectation> expected;
  bool operator==(const NamedCase&) const = default;
};

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

/// Loads scenarios/catalogue/NAME.yaml or scenarios/regressions/NAME.yaml, or the file `name` if it ends in ".yaml".
Scenario load_scenario(const DataRoot& data, const std::string& name);

/// Draws values for all random parameters of the scenario, with the random seed `seed`. Sensor parameters that the
/// scenario does not set come from the data sheets of the sensors.
sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed);

/// Converts the parameters of a simulated run to YAML. Parsing the YAML restores all parameters bit-exactly.
std::string to_yaml(const sim::Situation& situation);
sim::Situation situation_from_yaml(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
