// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/static_frames.hpp"

namespace tumble::scenarios {

/// Mountings of a bag's sensors on the body, from /tf_static or from the user. Private to scenarios/recordings/bags.
class SensorPlaces {
 public:
  /// `where` is the topic's location for messages.
  SensorPlaces(StaticFrames frames, std::string where) : frames_(std::move(frames)), where_(std::move(where)) {}

  /// Sets T_BA, unless the user has (it is not the identity); then only differences are reported. Uses the body's frame
  /// if the bag has one, else the first earlier sensor with a transform to this one. If nothing is known, notes the
  /// option that sets the mounting.
  void place(const std::string& topic, const std::string& frame, const char* option, Eigen::Isometry3d& T_BA,
             std::vector<std::string>& notes);

  /// Returns the mounting of a frame that is connected to the body; empty for others.
  std::optional<Eigen::Isometry3d> of(const std::string& frame) const;
  /// Returns the body's frame; "" if the bag has none.
  std::string body() const { return frames_.body(); }

 private:
  struct Placed {
    std::string topic, frame;
    Eigen::Isometry3d T_BA;
  };
  void place_in_body(const std::string& topic, const Eigen::Isometry3d& stated, Eigen::Isometry3d& T_BA,
                     std::vector<std::string>& notes) const;
  /// Returns the first earlier sensor connected to the frame by /tf_static.
  const Placed* neighbour(const std::string& frame) const;

  StaticFrames frames_;
  std::string where_;
  std::vector<Placed> placed_;
};

}  // namespace tumble::scenarios
