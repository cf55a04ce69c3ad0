// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tumble/common/imu.hpp"

namespace tumble::testing {

/// A rolling sphere in the form in which its authors logged the real one: merged samples (force in m/s^2) and their
/// attitude after each.
struct SphereLog {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;
};

/// Reads the log by the names in its header line. Throws std::runtime_error when it cannot.
SphereLog read_sphere_log(const std::string& path);

}  // namespace tumble::testing
