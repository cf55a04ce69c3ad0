// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/point_store.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// What is inconsistent in it, as "sensors/imus/0: gyro has 5 rows, time_ns 6"; empty when all is well. Checks lengths,
/// periods, calibrations (rotations), the order of sweeps, labels and surface ids. Does not judge readings: their NaN,
/// gaps and time order are expected trouble that an estimator reports.
/// `points`: of each lidar, where they are set aside; else empty.
std::string find_problem(const sim::Sensors& sensors, const std::vector<PointStore>& points = {});
std::string find_problem(const sim::Truth& truth);
std::string find_problem(const StoredTruth& truth);

/// Whether a file states a digest of its sensors' data, by which damage would show; files that others wrote need not.
/// Throws BadInput as readers do.
bool states_digest(const std::filesystem::path& path);

/// Where the truth does not run parallel to the sensors; empty when it does.
std::string find_mismatch(const sim::Sensors& sensors, const sim::Truth& truth);

}  // namespace tumble::scenarios
