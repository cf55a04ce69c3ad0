// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// Scene contains the map, the sweep and its IMU samples, as input of a registration.
struct Scene {
  std::span<const MotionSample> samples;
  TimeNs end_ns;
  std::span<const SweepPoint> points;  ///< selected points of the sweep
  const VoxelMap& map;
};

/// Aligner registers a sweep to the map in stages. `found.verdict` states whether the registration succeeded.
/// `trajectory` is the registered motion, or the motion of a failed attempt.
class Aligner {
 public:
  explicit Aligner(const LidarInertialOdometry::Params& params);

  /// Registers a sweep with all points and few iterations. If the registration does not converge, stages with fewer
  /// points continue at lower cost.
  void align_with_all_points(const Registration::Prior& prior, const Scene& scene, SweepTrajectory& trajectory,
                             Registration::Result& found);
  /// Registers a sweep with a subset of its points until convergence, then with all points from the converged pose.
  void align_to_convergence(const Registration::Prior& prior, const Scene& scene, SweepTrajectory& trajectory,
                            Registration::Result& found);
  /// Registers a sweep from an initial pose that may be far from the solution, in a coarse stage with few points. After
  /// a successful coarse stage, the registration continues to convergence.
  void align_coarse_to_fine(const Registration::Prior& start, const Registration::Prior& prior, const Scene& scene,
                            SweepTrajectory& trajectory, Registration::Result& found);

  /// Returns the registration with all points, which also computes the variance of a lidar return.
  const Registration& registration() const { return full_; }

 private:
  Registration full_, subsampled_, coarse_;
  std::vector<SweepPoint> thinned_;
};

Registration::Params registration_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
