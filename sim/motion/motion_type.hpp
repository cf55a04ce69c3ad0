// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim {

/// Cause of a robot's motion: the robot's start pose and the wrench that acts on the robot. Velocities are never set
/// directly, because accelerometers would not measure a jump of the velocity.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Returns the pose at rest just above the ground, from which the robot settles under gravity before the recording
  /// starts.
  virtual BodyState start() const = 0;
  /// Returns the wrench from `state.time_s` to the next step. At negative times, the robot settles before the recording
  /// starts.
  virtual Wrench wrench(const BodyState& state) = 0;
};

/// A kind of motion with its parameters and its factory for a world. `world` must outlive the motion.
struct MotionType {
  ComponentType component;
  std::unique_ptr<Motion> (*make)(const Values& values, const engine::World& world);
};

/// A push by force and torque for a short time, then free motion.
const MotionType& push_motion();
/// A hand holds the robot above the ground, swings the robot and releases it.
const MotionType& throw_motion();
/// A hand holds the robot above the ground and releases the robot.
const MotionType& drop_motion();
/// A hand leads a sphere along two straight legs.
const MotionType& hand_roll_motion();
/// A hand leads a sphere along a path of selectable shape.
const MotionType& hand_path_motion();
/// A hand carries a robot and twirls the robot about its x axis.
const MotionType& twirl_motion();
/// A walker carries a robot along a horizontal figure of eight.
const MotionType& stroll_motion();
/// A hand repeatedly leads a hanging robot aside and releases the robot.
const MotionType& swing_motion();

/// Returns all kinds of motion in the order of registration. A new kind of motion needs a source file and a line in
/// motion_type.cpp.
std::span<const MotionType* const> all_motion_types();
/// Returns the kind of motion with this name. For an unknown name, throws InvalidSituation with the nearest known name.
const MotionType& find_motion_type(std::string_view name);

}  // namespace tumble::sim
