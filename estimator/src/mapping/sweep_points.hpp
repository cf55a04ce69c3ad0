// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble {

/// standard deviation of a range r: max(sigma_m, range_fraction * r)
struct RangeNoise {
  double sigma_m, range_fraction;
};

/// LoneReturns detects returns that no neighbouring beam confirms, for example from dust, rain, snow, grass or birds.
///
/// A return is confirmed in three cases:
/// - A neighbouring return on the same ring has the same range: mapping.md (R13).
/// - The return and an adjacent return on the ring are on one surface: mapping.md (R14).
/// - The return is on the line between an earlier and a later return on the ring: mapping.md (R15).
///
/// If neighbouring beams confirm at least 98 % of the returns of a sweep, LoneReturns keeps all returns of the sweep,
/// because the air is clear.
class LoneReturns {
 public:
  /// Removes the unconfirmed returns from `points`, and returns the number of removed returns. Cost: O(points). The
  /// order of the remaining points does not change.
  std::size_t drop_isolated_returns(const RangeNoise& noise, std::vector<SweepPoint>& points);

 private:
  struct Beam {
    Eigen::Vector3f point_L_m;
    float range_m;
    std::uint16_t ring;
  };
  struct NeighbouringBeams;

  static float sine2_between(const Beam& a, const Beam& b);
  static float variance_m2(const RangeNoise& noise, const Beam& beam);
  static bool have_similar_range(const RangeNoise& noise, const Beam& a, const Beam& b);
  static bool is_steep_surface(float sine, const Beam& a, const Beam& b);
  static bool between(const RangeNoise& noise, const Beam& before, const Beam& beam, const Beam& after);
  void sort_by_ring(const std::vector<SweepPoint>& points);
  void measure_beam_steps();
  float median_step2();
  bool is_neighbour(std::size_t at, std::size_t other, float reach2) const;
  bool is_confirmed(const RangeNoise& noise, std::size_t at, float reach2) const;

  std::vector<std::uint32_t> next_beam_on_ring_, beam_order_;
  std::vector<Beam> beams_;  // beams ring by ring, in firing order
  std::vector<float> squared_beam_steps_,
      sorted_squared_beam_steps_;  // squared sines of the angle between successive beams on a ring
  std::vector<std::uint8_t> isolated_;
};

}  // namespace tumble

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
