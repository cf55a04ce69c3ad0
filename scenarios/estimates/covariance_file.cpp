// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/covariance_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

const std::string kHeader = "time_ns,cxx,cxy,cxz,cyy,cyz,czz";
constexpr std::size_t kCovarianceColumns = 7;

}  // namespace

void require_stamps(const Table& table, const std::vector<std::int64_t>& stamps_ns) {
  const std::string path = table.path.string();
  if (table.rows.size() != stamps_ns.size()) {
    throw BadInput(fmt::format("{}: the file has {} rows; it must have {}, one per pose", path, table.rows.size(),
                               stamps_ns.size()));
  }
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) {
    const Table::Row& row = table.rows[k];
    if (table.integer(row, 0) == stamps_ns[k]) continue;
    throw BadInput(fmt::format("{}:{}: the time is {} ns; it must be {} ns, the time of the pose in the same row", path,
                               row.line, table.integer(row, 0), stamps_ns[k]));
  }
}

void write_covariances(const std::filesystem::path& path, const std::vector<std::int64_t>& stamps_ns,
                       const std::vector<Eigen::Matrix3d>& covariances) {
  if (covariances.size() != stamps_ns.size()) {
    throw std::invalid_argument(
        fmt::format("the estimate has {} covariances for {} time stamps; their numbers must be equal",
                    covariances.size(), stamps_ns.size()));
  }
  const auto unstated = [](const Eigen::Matrix3d& covariance) { return covariance.isZero(0.0); };
  if (std::all_of(covariances.begin(), covariances.end(), unstated)) return;
  TableWriter table(path, ',', kHeader);
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) {
    table.integer(stamps_ns[k]);
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) table.number(covariances[k](i, j));
    }
    table.end_row();
  }
  table.close();
}

std::vector<Eigen::Matrix3d> read_covariances(const std::filesystem::path& path,
                                              const std::vector<std::int64_t>& stamps_ns) {
  const Table table = Table::read(path, ',', kHeader, kCovarianceColumns);
  require_stamps(table, stamps_ns);
  std::vector<Eigen::Matrix3d> covariances(stamps_ns.size());
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) {
    std::size_t column = 1;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) covariances[k](i, j) = covariances[k](j, i) = table.number(table.rows[k], column++);
    }
  }
  return covariances;
}

void write_position_covariances(const std::filesystem::path& path, const std::vector<PoseState>& poses) {
  std::vector<Eigen::Matrix3d> covariances_m2;
  covariances_m2.reserve(poses.size());
  for (const PoseState& pose : poses) covariances_m2.push_back(pose.covariance.topLeftCorner<3, 3>());
  write_covariances(path, stamps_ns(poses), covariances_m2);
}

void read_position_covariances(const std::filesystem::path& path, std::vector<PoseState>& poses) {
  const std::vector<Eigen::Matrix3d> covariances_m2 = read_covariances(path, stamps_ns(poses));
  for (std::size_t k = 0; k < poses.size(); ++k) poses[k].covariance.topLeftCorner<3, 3>() = covariances_m2[k];
}

}  // namespace tumble::scenarios
