// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>

#include "scenarios/methods/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// ScoringInput contains the parts of a recording that scoring needs. If `surface` is null, map scores are omitted.
struct ScoringInput {
  const sim::Sensors* sensors = nullptr;
  const sim::Truth* truth = nullptr;
  const sim::Surface* surface = nullptr;
};

/// ScoredEstimate refers to an estimate and its recording, and caches results that several metrics share, such as
/// paired poses and map distances. ScoredEstimate is not thread-safe.
class ScoredEstimate {
 public:
  /// Throws BadInput if the sensors or the truth are missing.
  ScoredEstimate(const Estimate& estimate, const ScoringInput& input);

  const Estimate& estimate() const { return *estimate_; }
  const sim::Sensors& sensors() const { return *input_.sensors; }
  const sim::Truth& truth() const { return *input_.truth; }
  const sim::Surface* surface() const { return input_.surface; }

  /// Returns `make(*this)`, which is computed at the first call and then cached. `make` must depend only on this
  /// ScoredEstimate and may call once(). If `make` throws, nothing is cached.
  template <typename Made>
  const Made& once(Made (*make)(const ScoredEstimate&)) const {
    const auto key = reinterpret_cast<void (*)()>(make);  // used as a key, never called
    auto found = made_.find(key);
    if (found == made_.end()) found = made_.emplace(key, std::make_shared<const Made>(make(*this))).first;
    return *static_cast<const Made*>(found->second.get());
  }

 private:
  const Estimate* estimate_;
  ScoringInput input_;
  mutable std::map<void (*)(), std::shared_ptr<const void>> made_;  ///< by the function that computes the value
};

}  // namespace tumble::scenarios
