// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Describes the first inconsistency of a recording in lengths, periods, calibrations (rotations), sweep order, labels
/// or surface ids. The text is empty for a consistent recording. The check accepts any readings, because the estimator
/// reports NaN, gaps and wrong time order.
std::string find_problem(const sim::Sensors& sensors, const std::vector<PointStore>& points = {});
std::string find_problem(const sim::Truth& truth);
std::string find_problem(const StoredTruth& truth);

bool states_digest(const std::filesystem::path& path);

std::string find_mismatch(const sim::Sensors& sensors, const sim::Truth& truth);

}  // namespace tumble::scenarios
