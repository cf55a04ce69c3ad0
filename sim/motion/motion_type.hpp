// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim {

/// Motion moves the robot by a wrench (force and torque). A Motion never sets a velocity, because the simulated
/// accelerometers would not measure the jump of the velocity.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual BodyState start() const = 0;
  /// Returns the force and torque from `state.time_s` to the next simulation step. Before time 0, the robot comes to
  /// rest on its contacts.
  virtual Wrench wrench(const BodyState& state) = 0;
};

/// MotionType describes a kind of motion. `world` must outlive the Motion that make() returns.
struct MotionType {
  ComponentType component;
  std::unique_ptr<Motion> (*make)(const Values& values, const engine::World& world);
};

const MotionType& push_motion();
const MotionType& throw_motion();
const MotionType& drop_motion();
const MotionType& hand_roll_motion();
const MotionType& hand_path_motion();
const MotionType& twirl_motion();
const MotionType& stroll_motion();
const MotionType& swing_motion();
const MotionType& launch_motion();

std::span<const MotionType* const> all_motion_types();
const MotionType& find_motion_type(std::string_view name);

}  // namespace tumble::sim
