// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenarios/recordings/table_file.hpp"

/// TUM trajectory files have no columns for covariances, so a separate file contains the covariances (see ESTIMATE.md).
namespace tumble::scenarios {

/// Writes the upper triangle of each covariance, row by row.
void write_covariances(const std::filesystem::path& path, const std::vector<std::int64_t>& stamps_ns,
                       const std::vector<Eigen::Matrix3d>& covariances);

std::vector<Eigen::Matrix3d> read_covariances(const std::filesystem::path& path,
                                              const std::vector<std::int64_t>& stamps_ns);

void require_stamps(const Table& table, const std::vector<std::int64_t>& stamps_ns);

}  // namespace tumble::scenarios
