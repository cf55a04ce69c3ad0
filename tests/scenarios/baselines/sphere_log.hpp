// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::testing {

/// SphereLog is a rolling sphere in the form in which its authors logged the real one: merged samples (force in m/s^2)
/// and the attitude after each sample.
struct SphereLog {
  std::vector<ImuSample> samples;
  std::vector<Quaterniond> q_WI;
};

/// Reads the log by the column names in its header line. Throws std::runtime_error when the log cannot be read.
SphereLog read_sphere_log(const std::string& path);

}  // namespace tumble::testing
