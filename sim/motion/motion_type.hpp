// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "sim/body_state.hpp"
#include "sim/engine/model.hpp"

namespace tumble::sim {

/// What sets a robot in motion: where it begins and the wrench that acts on it. Never a jump of velocity: no
/// accelerometer would see it.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Pose from which the robot settles under gravity before the recording begins; at rest, just above the ground.
  virtual BodyState start() const = 0;
  /// Wrench from `state.time_s` to the next step. Negative times are the settling before the recording.
  virtual Wrench wrench(const BodyState& state) = 0;
};

/// A kind of motion: its parameters and how it is made for a world. `world` outlives the motion.
struct MotionType {
  ComponentType component;
  std::unique_ptr<Motion> (*make)(const Values& values, const engine::World& world);
};

/// A push by force and torque over a short time, then free.
const MotionType& push_motion();
/// Held above the ground, swung and let go.
const MotionType& throw_motion();
/// Held above the ground and let go.
const MotionType& drop_motion();
/// A hand that leads a sphere along two legs.
const MotionType& hand_roll_motion();
/// A hand that leads a sphere along a way of some shape.
const MotionType& hand_path_motion();
/// A robot carried in a hand and twirled about its x axis.
const MotionType& twirl_motion();
/// A robot carried by a walker along a level eight.
const MotionType& stroll_motion();
/// A robot that hangs is led aside by a hand and let go, now and then.
const MotionType& swing_motion();

/// All kinds, in the order of registration: a new one is a file and a line in motion_type.cpp.
std::span<const MotionType* const> all_motion_types();
/// Throws InvalidSituation, naming the nearest known type.
const MotionType& find_motion_type(std::string_view name);

}  // namespace tumble::sim
