// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/static_frames.hpp"

namespace tumble::scenarios {

/// Where a bag's sensors stand on the body, one after the other: by /tf_static, or by who imports it. Private to
/// scenarios/recordings/bags.
class SensorPlaces {
 public:
  /// `where` is the topic's place for messages.
  SensorPlaces(StaticFrames frames, std::string where) : frames_(std::move(frames)), where_(std::move(where)) {}

  /// Gives T_BA, unless somebody else has (it is not the identity): then both are shown where they differ. In the
  /// body's frame, where the bag has one of its name; else beside the first sensor before it that is tied to it. Where
  /// nobody has said it, that is noted with the option that says it.
  void place(const std::string& topic, const std::string& frame, const char* option, Eigen::Isometry3d& T_BA,
             std::vector<std::string>& notes);

  /// Of a sensor's frame, or one that is tied to the body; nothing of others.
  std::optional<Eigen::Isometry3d> of(const std::string& frame) const;
  /// The body's frame, "" where none has one of its names.
  std::string body() const { return frames_.body(); }

 private:
  struct Placed {
    std::string topic, frame;
    Eigen::Isometry3d T_BA;
  };
  void place_in_body(const std::string& topic, const Eigen::Isometry3d& stated, Eigen::Isometry3d& T_BA,
                     std::vector<std::string>& notes) const;
  /// The first that was placed and is tied to the frame by /tf_static.
  const Placed* neighbour(const std::string& frame) const;

  StaticFrames frames_;
  std::string where_;
  std::vector<Placed> placed_;
};

}  // namespace tumble::scenarios
