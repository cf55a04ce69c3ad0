// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "sim/situation.hpp"

namespace tumble::sim {

namespace engine {
struct World;
}

/// A situation whose world and robot are composed and compiled once. Simulation, start pose, true surface and pictures
/// all use this model. The model is constant; code that steps the model or changes its look uses a copy. Copies of this
/// object share the model and may be used from several threads.
class BuiltSituation {
 public:
  /// Reads the robot's MJCF from the folder `models` and composes the world around the robot. The composition takes
  /// milliseconds for a floor and tenths of a second for a hill. Throws InvalidSituation with the compiler's message.
  BuiltSituation(ResolvedSituation situation, const std::filesystem::path& models);

  const ResolvedSituation& situation() const;

  /// Only code of sim can use this type.
  const engine::World& world() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace tumble::sim
