// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

#include "parameters.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble::python {

/// Reads the keywords `gyro_range_rad_s` and `accel_range_m_s2`, the measurement ranges from the data sheet. None means
/// that the data sheet states no range.
void read_ranges(Keywords& keywords, SaturationLimitDetector::Params& rails);

/// Returns a list of three elements, each a SaturationPlane or None.
nb::list as_list(const SaturationPlanes& planes);

}  // namespace tumble::python
