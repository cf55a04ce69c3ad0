// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "sim/situation.hpp"

namespace tumble::sim {

namespace engine {
struct World;
}

/// BuiltSituation contains world and robot as a MuJoCo model. Copies of a BuiltSituation share the constant model, also
/// between threads.
class BuiltSituation {
 public:
  /// Builds the MuJoCo model, which takes milliseconds for a flat floor, and tenths of a second for a hill.
  BuiltSituation(ResolvedSituation situation, const std::filesystem::path& models);

  const ResolvedSituation& situation() const;

  const engine::World& world() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace tumble::sim
