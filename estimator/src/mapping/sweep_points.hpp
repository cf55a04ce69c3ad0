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
    std::size_t usable_points = 0;  ///< finite returns in range that do not hit the robot itself
    std::size_t isolated = 0;       ///< number of dropped lone returns
    bool has_ring_numbers = false;
  };
  /// The sweep starts `start_s` seconds after the start of its trajectory. On error, returns an error of
  /// check_point_selection().
  Status select_returns(const Params& params, std::span<const LidarPoint> returns, TimeNs span_ns,
                        const LidarImuCalibration& calibration, double start_s, Counts& counts);
  /// Selects one lidar point per voxel of the world frame for the registration. The predicted point positions determine
  /// the voxels.
  void choose_points_per_voxel(const Params& params, const SweepTrajectory& predicted);
  void apply_calibration_shift(const LidarImuCalibration& calibration, double later_s) {
    apply_calibration(calibration, later_s, all_);
  }

  const std::vector<SweepPoint>& all() const { return all_; }
  const std::vector<SweepPoint>& sampled_points() const { return sampled_points_; }

 private:
  RangeNoise noise_;
  LoneReturns lone_returns_;
  SweepSampler sampler_;
  std::vector<SweepPoint> all_, sampled_points_;
  std::vector<Eigen::Vector3f> positions_W_m_;
  std::vector<std::uint32_t> sampled_point_index_;
};

}  // namespace tumble::mapping
