// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include "tumble/angular_velocity/types.hpp"

namespace tumble::python {

/// Converts a BodyImuCalibration of Python to the library's type. Raises TumbleError `type` for anything else.
BodyImuCalibration rig_of(nanobind::handle given, const char* field);

void bind_rig(nanobind::module_& m);

}  // namespace tumble::python
