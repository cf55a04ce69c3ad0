// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/registration.hpp"

namespace tumble::mapping {

/// What a sweep is aligned with.
struct Scene {
  std::span<const MotionSample> samples;
  TimeNs end_ns;
  std::span<const SweepPoint> points;  ///< chosen ones
  const VoxelMap& map;
};

/// Registers a sweep in stages. Each tells by the verdict of `found` whether it led anywhere;
/// `trajectory` is then that of the result, else one that was tried.
class Aligner {
 public:
  explicit Aligner(const LidarInertialOdometry::Params& params);

  /// With all points and few iterations: what has not converged by then converges for less otherwise.
  void in_full(const Registration::Prior& prior, const Scene& scene, SweepTrajectory& trajectory,
               Registration::Result& found);
  /// With some of the points for as long as it takes, and in full from where these lead.
  void to_convergence(const Registration::Prior& prior, const Scene& scene, SweepTrajectory& trajectory,
                      Registration::Result& found);
  /// From a start that may be far off: first coarsely and with few points, then to convergence where these lead
  /// somewhere, so that a start in vain costs a fraction of a registration; of that one the verdict alone is told.
  void from_afar(const Registration::Prior& start, const Registration::Prior& prior, const Scene& scene,
                 SweepTrajectory& trajectory, Registration::Result& found);

  /// That tells a return's own variance.
  const Registration& registration() const { return full_; }

 private:
  Registration full_, subsampled_, coarse_;
  std::size_t subsample_points_, coarse_points_;
  std::vector<SweepPoint> thinned_;  // memory
};

Registration::Params registration_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
