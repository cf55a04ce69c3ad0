// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "sim/situation.hpp"

namespace tumble::sim {

namespace engine {
struct World;
}

/// A situation whose world and robot have been composed and compiled, once: what is simulated, where the robot begins,
/// the true surface and pictures are all made from this one model. It never changes; whoever steps it or dresses it for
/// a picture works on a copy. Copies of this object share the model, and may be used from several threads.
class BuiltSituation {
 public:
  /// Reads the robot's MJCF in `models` and composes the world around it: milliseconds for a floor, tenths of a second
  /// for a hill. Throws InvalidSituation with the compiler's message.
  BuiltSituation(ResolvedSituation situation, const std::filesystem::path& models);

  const ResolvedSituation& situation() const;

  /// For sim itself: no other knows the type.
  const engine::World& world() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace tumble::sim
