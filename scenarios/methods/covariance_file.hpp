// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenarios/recordings/table_file.hpp"

/// The functions in covariance_file.hpp write and read the covariances of an estimate's poses or attitudes, one row per
/// time stamp. The covariances have a separate file, because TUM files have no columns for covariances. ESTIMATE.md
/// describes the columns.
namespace tumble::scenarios {

/// Writes one covariance per time stamp: the upper triangle, row by row. If all covariances are zero (not estimated),
/// the function writes no file. Throws BadInput if writing fails.
void write_covariances(const std::filesystem::path& path, const std::vector<std::int64_t>& stamps_ns,
                       const std::vector<Eigen::Matrix3d>& covariances);

/// Reads one covariance per time stamp. Throws BadInput with path and line if the rows of the file do not match the
/// time stamps.
std::vector<Eigen::Matrix3d> read_covariances(const std::filesystem::path& path,
                                              const std::vector<std::int64_t>& stamps_ns);

/// Throws BadInput with path and line unless the first column of the table equals the time stamps, in order.
void require_stamps(const Table& table, const std::vector<std::int64_t>& stamps_ns);

}  // namespace tumble::scenarios
