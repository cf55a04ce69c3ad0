// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim {

/// Motion moves a robot from a start pose by a wrench (force and torque). A Motion never sets a velocity, because the
/// simulated accelerometers would not measure the jump.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Returns the pose at rest just above the ground. From this pose, the robot settles under gravity before the
  /// recording starts.
  virtual BodyState start() const = 0;
  /// Returns the wrench from `state.time_s` to the next step. Before time 0, the robot settles into its contacts.
  virtual Wrench wrench(const BodyState& state) = 0;
};

/// MotionType is a kind of motion, with its parameters and its factory for a world. `world` must outlive the motion.
struct MotionType {
  ComponentType component;
  std::unique_ptr<Motion> (*make)(const Values& values, const engine::World& world);
};

/// Returns the motion type of a short push by force and torque, followed by free motion.
const MotionType& push_motion();
/// Returns the motion type in which a hand holds the robot above the ground, swings it and releases it.
const MotionType& throw_motion();
/// Returns the motion type in which a hand holds the robot above the ground and releases it.
const MotionType& drop_motion();
/// Returns the motion type in which a hand leads a sphere along two straight legs.
const MotionType& hand_roll_motion();
/// Returns the motion type in which a hand leads a sphere along a path of selectable shape.
const MotionType& hand_path_motion();
/// Returns the motion type in which a hand carries a robot and twirls it about its x axis.
const MotionType& twirl_motion();
/// Returns the motion type in which a walker carries a robot along a horizontal figure of eight.
const MotionType& stroll_motion();
/// Returns the motion type in which a hand repeatedly leads a hanging robot aside and releases it.
const MotionType& swing_motion();

/// Returns all motion types in the order of registration. A new motion type needs a source file and a line in
/// motion_type.cpp.
std::span<const MotionType* const> all_motion_types();
/// Returns the motion type with this name. For an unknown name, throws InvalidSituation with the nearest known name.
const MotionType& find_motion_type(std::string_view name);

}  // namespace tumble::sim
