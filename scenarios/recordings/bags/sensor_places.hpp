// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/static_frames.hpp"

namespace tumble::scenarios {

std::string sensor_name(std::string topic);

class SensorMountings {
 public:
  SensorMountings(StaticFrames frames, std::string where) : frames_(std::move(frames)), where_(std::move(where)) {}

  /// Sets the mounting T_BA of a sensor A from /tf_static, unless the user has set T_BA; a difference is then reported.
  /// Without a body frame in the bag, T_BA follows from a sensor of an earlier call that /tf_static connects to A.
  void place(const std::string& topic, const std::string& frame, const char* option, bool given,
             Eigen::Isometry3d& T_BA, std::vector<std::string>& notes);

  std::optional<Eigen::Isometry3d> of(const std::string& frame) const;
  std::string body() const { return frames_.body(); }

 private:
  struct Placed {
    std::string topic, frame;
    Eigen::Isometry3d T_BA;
  };
  void mounting_in_body(const std::string& topic, const Eigen::Isometry3d& stated, bool given, Eigen::Isometry3d& T_BA,
                        std::vector<std::string>& notes) const;
  const Placed* neighbour(const std::string& frame) const;

  StaticFrames frames_;
  std::string where_;
  std::vector<Placed> placed_;
};

}  // namespace tumble::scenarios
