// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/built_situation.hpp"
#include "tests/tree.hpp"

namespace tumble::sim {

/// A world with a robot from the models of this tree.
inline BuiltSituation built_world(const std::string& world, const std::string& robot) {
  Situation situation;
  situation.seed = 3;
  situation.world.type = world;
  situation.robot.type = robot;
  situation.motion.type = robot == "sphere" ? "hand_roll" : "push";
  return {resolve(situation), test::source_dir() / "models"};
}

}  // namespace tumble::sim
