// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios::testing {

/// kRoll is a scenario of a sphere whose draws are short and have no map to score.
inline constexpr const char* kRoll = R"(name: roll
doc: A short straight way.
duration_s: 3
world: {type: floor, room_half_m: 4, pillar_count: 0, box_count: 0}
robot: {type: sphere}
motion: {type: hand_roll, rest_s: 1.2, leg_1_m: {uniform: [0.3, 0.5]}, leg_2_m: 0}
sensors:
  - {name: imu, kind: imu, device: phidget1044, site: phidget_1}
)";

/// SmallCatalogue has the project's models and a catalogue of that one scenario.
class SmallCatalogue : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    write("scenarios/catalogue/roll.yaml", kRoll);
    fs::create_directory_symlink(test::source_dir() / "models", folder_ / "models");
  }
  DataRoot data() const { return {folder_}; }
};

}  // namespace tumble::scenarios::testing
