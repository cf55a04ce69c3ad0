// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tumble/common/imu.hpp"

namespace tumble::testing {

/// A real rolling sphere as its authors logged it: merged samples (force in m/s^2) and their attitude after each.
struct SphereLog {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;
};

/// Path of the log in the shared data; empty when it is not there.
std::string sphere_log_path();

/// Reads the log by the names in its header line. Throws std::runtime_error when it cannot.
SphereLog read_sphere_log(const std::string& path);

}  // namespace tumble::testing
