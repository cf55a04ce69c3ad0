// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

namespace tumble::scenarios {

struct SphereImus {
  std::vector<std::string> names;
  std::vector<ImuRecording> recordings;
  int beyond_range = 0;  ///< dropped readings beyond the range
};

Status sphere_imus(const sim::Sensors& sensors, SphereImus& out);

struct MergedImus {
  MergedRecordings merged;
  std::vector<std::string> names;
  int beyond_range = 0;
};

void require_sphere(const char* method, const sim::Sensors& sensors);

void report_beyond_range(int readings, Estimate& estimate);

Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
