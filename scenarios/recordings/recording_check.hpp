// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/point_store.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Returns an inconsistency, as "sensors/imus/0: gyro has 5 rows, time_ns 6"; empty if there is none. Checks lengths,
/// periods, calibrations (rotations), sweep order, labels and surface ids. Does not check readings: NaN, gaps and time
/// order are reported by the estimator. `points`: one store per lidar if the points are on disk, else empty.
std::string find_problem(const sim::Sensors& sensors, const std::vector<PointStore>& points = {});
std::string find_problem(const sim::Truth& truth);
std::string find_problem(const StoredTruth& truth);

/// Returns true if a file states a digest of its sensor data, which detects damage. Files of other programs may lack
/// it. Throws BadInput as readers do.
bool states_digest(const std::filesystem::path& path);

/// Returns how the truth differs in structure from the sensors; empty if it matches.
std::string find_mismatch(const sim::Sensors& sensors, const sim::Truth& truth);

}  // namespace tumble::scenarios
