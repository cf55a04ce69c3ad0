// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/registration.hpp"

namespace tumble::mapping {

/// Scene is the input of an alignment.
struct Scene {
  std::span<const MotionSample> samples;
  TimeNs end_ns;
  std::span<const SweepPoint> points;  ///< selected points of the sweep
  const VoxelMap& map;
};

/// Registers a sweep in stages. The verdict of `found` states whether the registration succeeded. After success,
/// `trajectory` is the registered motion. After a failure, `trajectory` is that of a failed attempt.
class Aligner {
 public:
  explicit Aligner(const LidarInertialOdometry::Params& params);

  /// Registers a sweep with all points and few iterations. Without convergence, the stages with fewer points continue
  /// at lower cost.
  void align_with_all_points(const Registration::Prior& prior, const Scene& scene, SweepTrajectory& trajectory,
                             Registration::Result& found);
  /// Registers a sweep with some of the points until convergence, then with all points from the converged pose.
  void align_to_convergence(const Registration::Prior& prior, const Scene& scene, SweepTrajectory& trajectory,
                            Registration::Result& found);
  /// Registers a sweep from a start that may be far from the solution: coarsely with few points, then to convergence if
  /// the coarse stage succeeds. A failed start therefore costs only a fraction of a registration, and returns only its
  /// verdict.
  void align_coarse_to_fine(const Registration::Prior& start, const Registration::Prior& prior, const Scene& scene,
                            SweepTrajectory& trajectory, Registration::Result& found);

  /// Returns the Registration that computes the variance of a lidar return.
  const Registration& registration() const { return full_; }

 private:
  Registration full_, subsampled_, coarse_;
  std::size_t subsample_points_, coarse_points_;
  std::vector<SweepPoint> thinned_;
};

Registration::Params registration_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
