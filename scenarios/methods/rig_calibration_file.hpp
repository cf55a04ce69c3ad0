// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "tumble/angular_velocity/detail/learnt_rig.hpp"

namespace tumble::scenarios {

/// The JSON file contains lever arm, biases, inertia and gyro sensing elements with their covariance (by rows), the
/// saturation limits and planes of gyro and accelerometer, and the device errors in the order of SensorErrors with
/// their covariance. Reading restores all numbers bit-exactly. Throws BadInput if writing fails; no partial file
/// remains.
void write_rig_calibration(const std::filesystem::path& path, const CalibratedRig& rig);

/// Files of earlier versions may lack the gyro sensing elements with their six covariance rows, the accelerometer
/// planes, or the device errors; these get default values. Throws BadInput with path and key for a missing, misspelt or
/// extra key, an invalid number, a wrong count, or a covariance that is not symmetric positive definite.
CalibratedRig read_rig_calibration(const std::filesystem::path& path);

}  // namespace tumble::scenarios
