// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenarios/recordings/table_file.hpp"
#include "tumble/common/types.hpp"

/// TUM trajectory files have no columns for covariances, so a separate file contains the covariances (see ESTIMATE.md).
namespace tumble::scenarios {

/// Writes the upper triangle of each covariance, row by row.
void write_covariances(const std::filesystem::path& path, const std::vector<std::int64_t>& stamps_ns,
                       const std::vector<Eigen::Matrix3d>& covariances);

std::vector<Eigen::Matrix3d> read_covariances(const std::filesystem::path& path,
                                              const std::vector<std::int64_t>& stamps_ns);

template <typename State>
std::vector<std::int64_t> stamps_ns(const std::vector<State>& states) {
  std::vector<std::int64_t> stamps;
  stamps.reserve(states.size());
  for (const State& state : states) stamps.push_back(state.time_ns);
  return stamps;
}

void write_position_covariances(const std::filesystem::path& path, const std::vector<PoseState>& poses);
void read_position_covariances(const std::filesystem::path& path, std::vector<PoseState>& poses);

void require_stamps(const Table& table, const std::vector<std::int64_t>& stamps_ns);

}  // namespace tumble::scenarios
