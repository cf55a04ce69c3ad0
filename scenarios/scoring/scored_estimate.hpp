// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>

#include "scenarios/methods/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// What scoring needs of a recording. `surface` may be null: map scores are left out then.
struct ScoringInput {
  const sim::Sensors* sensors = nullptr;
  const sim::Truth* truth = nullptr;
  const sim::Surface* surface = nullptr;
};

/// An estimate beside the recording that it is held to, and what several metrics make of the two, each of it once: the
/// poses beside the truth, a map's distances to the surface. It is made for one estimate and lives as long as that is
/// scored; it refers to what it is made from. Of one thread.
class ScoredEstimate {
 public:
  /// Throws BadInput without sensors or truth.
  ScoredEstimate(const Estimate& estimate, const ScoringInput& input);

  const Estimate& estimate() const { return *estimate_; }
  const sim::Sensors& sensors() const { return *input_.sensors; }
  const sim::Truth& truth() const { return *input_.truth; }
  const sim::Surface* surface() const { return input_.surface; }

  /// What `make` makes of it, a function of it alone: called by the first who asks, the same object for all others.
  /// `make` may ask for what others make. When it throws, nothing is kept.
  template <typename Made>
  const Made& once(Made (*make)(const ScoredEstimate&)) const {
    const auto key = reinterpret_cast<void (*)()>(make);  // a key alone: never called
    auto found = made_.find(key);
    if (found == made_.end()) found = made_.emplace(key, std::make_shared<const Made>(make(*this))).first;
    return *static_cast<const Made*>(found->second.get());
  }

 private:
  const Estimate* estimate_;
  ScoringInput input_;
  mutable std::map<void (*)(), std::shared_ptr<const void>> made_;  ///< by the function that made it
};

}  // namespace tumble::scenarios
