// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "lone_returns.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

class SweepPoints {
 public:
  using Params = LidarInertialOdometry::Params;

  explicit SweepPoints(const Params& params);

  struct Counts {
    std::size_t used = 0;      ///< finite returns in range that do not hit the robot itself
    std::size_t isolated = 0;  ///< number of dropped lone returns
    bool has_ring_numbers = false;
  };
  /// The sweep starts `start_s` seconds after the start of its trajectory. Returns the errors of check_selection().
  Status select(const Params& params, std::span<const LidarPoint> returns, TimeNs span_ns,
                const SweepCalibration& calibration, double start_s, Counts& counts);
  /// Selects one point per cube of the world for the registration, with the points at their predicted positions.
  void choose(const Params& params, const SweepTrajectory& predicted);
  void move(const SweepCalibration& calibration, double later_s) { apply_calibration(calibration, later_s, all_); }

  const std::vector<SweepPoint>& all() const { return all_; }
  const std::vector<SweepPoint>& chosen() const { return chosen_; }

 private:
  RangeNoise noise_;
  LoneReturns lone_returns_;
  SweepSampler sampler_;
  std::vector<SweepPoint> all_, chosen_;
  std::vector<Eigen::Vector3f> positions_W_m_;
  std::vector<std::uint32_t> chosen_index_;
};

}  // namespace tumble::mapping
