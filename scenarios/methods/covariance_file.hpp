// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenarios/recordings/table_file.hpp"

/// Covariances of an estimate's poses or attitudes, a row each, beside the TUM file that has no room for them.
/// Columns: ESTIMATE.md.
namespace tumble::scenarios {

/// As many covariances as stamps, the upper triangle by rows. When all of them are zero nothing was stated, and no file
/// is written. Throws BadInput when it cannot write.
void write_covariances(const std::filesystem::path& path, const std::vector<std::int64_t>& stamps_ns,
                       const std::vector<Eigen::Matrix3d>& covariances);

/// One for each stamp. Throws BadInput with path and line where the rows are others than the stamps.
std::vector<Eigen::Matrix3d> read_covariances(const std::filesystem::path& path,
                                              const std::vector<std::int64_t>& stamps_ns);

/// Throws BadInput with path and line unless the table has a row for each stamp, in its first column, in their order.
void require_stamps(const Table& table, const std::vector<std::int64_t>& stamps_ns);

}  // namespace tumble::scenarios
