// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>

#include "scenarios/methods/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct ScoringInput {
  const sim::Sensors* sensors = nullptr;
  const sim::Truth* truth = nullptr;
  const sim::Surface* surface = nullptr;
};

class ScoredEstimate {
 public:
  ScoredEstimate(const Estimate& estimate, const ScoringInput& input);

  const Estimate& estimate() const { return *estimate_; }
  const sim::Sensors& sensors() const { return *input_.sensors; }
  const sim::Truth& truth() const { return *input_.truth; }
  const sim::Surface* surface() const { return input_.surface; }

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
