// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "sim/situation.hpp"

namespace tumble::sim {

namespace engine {
struct World;
}

/// A situation whose world and robot were compiled once to a MuJoCo model. Simulation, start pose, true surface and
/// pictures all use the compiled model. The compiled model is constant: code that steps the model or changes its look
/// uses a copy. Copies of a BuiltSituation share the compiled model and may be used from several threads.
class BuiltSituation {
 public:
  /// Reads the robot's MJCF from the folder `models` and composes the world around the robot. The composition takes
  /// milliseconds for a floor and tenths of a second for a hill. Throws InvalidSituation with the message of MuJoCo's
  /// compiler.
  BuiltSituation(ResolvedSituation situation, const std::filesystem::path& models);

  const ResolvedSituation& situation() const;

  /// Only code in the folder sim can use the type engine::World.
  const engine::World& world() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace tumble::sim
