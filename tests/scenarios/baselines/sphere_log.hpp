// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tumble/common/imu.hpp"

namespace tumble::testing {

/// A rolling sphere in the log format of the authors of the real sphere: merged samples (force in m/s^2), and the
/// attitude after each sample.
struct SphereLog {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;
};

/// Reads the log by the column names in its header line. Throws std::runtime_error if it cannot be read.
SphereLog read_sphere_log(const std::string& path);

}  // namespace tumble::testing
