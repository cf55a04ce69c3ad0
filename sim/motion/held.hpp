// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim {

/// HoldingHand is a hand that holds a robot still in the air, with critically damped springs for position and attitude,
/// and a force that compensates the weight.
class HoldingHand {
 public:
  /// `height_m` is the height of the robot's lowest point above the ground at the start.
  HoldingHand(const engine::World& world, const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& offset_W_m,
              double height_m);

  BodyState start() const { return start_; }
  Wrench hold(const BodyState& state) const;
  Eigen::Vector3d weight_n() const { return weight_n_; }
  double mass_kg() const { return mass_kg_; }
  const Eigen::Matrix3d& inertia_W_kg_m2() const { return inertia_W_kg_m2_; }

 private:
  BodyState start_;
  double mass_kg_;
  Eigen::Matrix3d inertia_W_kg_m2_;
  Eigen::Vector3d weight_n_;
};

}  // namespace tumble::sim
