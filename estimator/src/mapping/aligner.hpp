// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

struct RegistrationScene {
  std::span<const MotionSample> samples;
  TimeNs end_ns;
  std::span<const SweepPoint> points;  ///< selected points of the sweep
  const VoxelMap& map;
};

/// SweepAligner registers a sweep to the map in stages, from few points to all points. `trajectory` receives the
/// registered motion of the IMU. If the registration fails, `trajectory` is invalid and the caller must rebuild
/// `trajectory`.
class SweepAligner {
 public:
  explicit SweepAligner(const LidarInertialOdometry::Params& params);

  /// Registers a sweep with all points and few iterations.
  void align_with_all_points(const Registration::Prior& prior, const RegistrationScene& scene,
                             SweepTrajectory& trajectory, Registration::Result& found);
  /// Registers a sweep first with a subset of its points until convergence, and then with all points.
  void align_to_convergence(const Registration::Prior& prior, const RegistrationScene& scene,
                            SweepTrajectory& trajectory, Registration::Result& found);
  /// Registers a sweep first with few points, because the initial pose `start` may be far from the solution.
  void align_coarse_to_fine(const Registration::Prior& start, const Registration::Prior& prior,
                            const RegistrationScene& scene, SweepTrajectory& trajectory, Registration::Result& found);

  const Registration& registration() const { return full_registration_; }

 private:
  Registration full_registration_, subsampled_registration_, coarse_registration_;
  std::vector<SweepPoint> subsampled_points_;
};

Registration::Params registration_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
