// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "sim/situation.hpp"

namespace tumble::sim {

namespace engine {
struct World;
}

/// BuiltSituation is a situation whose world and robot are compiled to one MuJoCo model. Simulation, start pose, true
/// surface and pictures all use this model. The model is constant; code that changes a model works on a copy. Copies of
/// a BuiltSituation share the compiled model, also between threads.
class BuiltSituation {
 public:
  /// Reads the robot's MJCF from the folder `models`, and composes the world around the robot. The construction takes
  /// milliseconds for a floor and tenths of a second for a hill. Throws InvalidSituation with the message of MuJoCo's
  /// model compiler.
  BuiltSituation(ResolvedSituation situation, const std::filesystem::path& models);

  const ResolvedSituation& situation() const;

  /// Returns the compiled world, for code in the folder sim.
  const engine::World& world() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace tumble::sim
