// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

/// results.hpp binds result classes that store rows. Each class exposes its columns as views of the rows.
namespace tumble::python {

struct Rates {
  std::vector<AngularRateState> rows;
};
struct Attitudes {
  std::vector<AttitudeState> rows;
};
struct Poses {
  std::vector<PoseState> rows;
};
struct RollingPoses {
  std::vector<RollingEstimate> rows;
};
struct MapPoints {
  std::vector<MapPoint> rows;
};

inline constexpr const char* kHealth =
    "Returns the suspected faults of sensors and estimate, the most important first. The list is empty without a\n"
    "fault. The estimator continues after any fault, and a finding ends when its cause ends.";

/// Concatenates the poses of several trajectories.
Poses joined(const std::vector<std::vector<PoseState>>& parts);

void bind_results(nanobind::module_& m);

}  // namespace tumble::python
