// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/table_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

/// Matrices in KITTI files have seven digits.
constexpr double kRotationTolerance = 1e-3;

[[noreturn]] void fail(const Table& table, const Table::Row& row, const std::string& what) {
  throw BadInput(table.path.string() + ":" + std::to_string(row.line) + ": " + what);
}

double finite(const Table& table, const Table::Row& row, std::size_t column) {
  const double value = table.number(row, column);
  if (!std::isfinite(value)) fail(table, row, fmt::format("the number in column {} is not finite", column));
  return value;
}

ReferencePose tum_pose(const Table& table, const Table::Row& row) {
  ReferencePose pose;
  pose.time_ns = table.time_ns(row, 0);
  for (int i = 0; i < 3; ++i) pose.p_WA_m[i] = table.number(row, static_cast<std::size_t>(1 + i));
  for (int i = 0; i < 4; ++i) pose.q_WA.coeffs()[i] = table.number(row, static_cast<std::size_t>(4 + i));
  return pose;
}

Eigen::Matrix<double, 3, 4> kitti_matrix(const Table& table, const Table::Row& row) {
  Eigen::Matrix<double, 3, 4> T;
  for (std::size_t i = 0; i < 12; ++i) {
    T(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = finite(table, row, i);
  }
  const Eigen::Matrix3d R = T.leftCols<3>();
  const double departure = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(departure <= kRotationTolerance) || R.determinant() < 0.0) {
    fail(table, row,
         fmt::format(
             "the first three columns of the matrix differ from a rotation by {}; the difference must be at most {}",
             std::to_string(departure), kRotationTolerance));
  }
  return T;
}

}  // namespace

bool is_unknown(const ReferencePose& pose) {
  return pose.p_WA_m.array().isNaN().all() && pose.q_WA.coeffs().array().isNaN().all();
}

std::string problem_of(ReferencePose& pose, const ReferencePose* before) {
  if (!pose.p_WA_m.allFinite() || !pose.q_WA.coeffs().allFinite()) return "the pose is not finite";
  constexpr double kFurthest_m = 1e9;  // above any Earth-centred coordinate
  if (const double far_m = pose.p_WA_m.cwiseAbs().maxCoeff(); far_m > kFurthest_m)
    return fmt::format("the position of this pose is {:.3g} m from the origin; it must be within {:.0g} m", far_m,
                       kFurthest_m);
  const double norm = pose.q_WA.norm();
  if (!(std::abs(norm - 1.0) <= kReferenceNormTolerance))
    return fmt::format("the norm of this pose's quaternion is {:f}; it must be 1 within 1 %", norm);
  if (std::abs(norm - 1.0) > 1e-12) pose.q_WA.normalize();
  if (before == nullptr || pose.time_ns > before->time_ns) return "";
  return fmt::format(
      "the time stamp {} ns must be larger than the previous time stamp, {} ns. Sort the file of poses by time",
      pose.time_ns, before->time_ns);
}

void finish_poses(const std::filesystem::path& file, bool sorted, std::vector<ReferencePose>& poses) {
  if (sorted) {
    const auto before = [](const ReferencePose& a, const ReferencePose& b) { return a.time_ns < b.time_ns; };
    const auto same = [](const ReferencePose& a, const ReferencePose& b) { return a.time_ns == b.time_ns; };
    std::stable_sort(poses.begin(), poses.end(), before);
    poses.erase(std::unique(poses.begin(), poses.end(), same), poses.end());
  }
  if (poses.size() < 2)
    throw BadInput(fmt::format("{}: the file has {} poses; it needs at least 2", file.string(), poses.size()));
}

std::string pose_format(const std::filesystem::path& file) {
  std::ifstream stream = open_regular_file(file);
  if (is_pose_table(file)) return "odometry";
  std::string line;
  while (std::getline(stream, line) && (line.empty() || line.front() == '#' || line.front() == '\r')) {
  }
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  std::istringstream words(line);
  std::size_t count = 0, others = 0;
  double number = 0.0;
  for (std::string word; words >> word; ++count) others += parse_number(word, number) ? 0 : 1;
  if (count == 8 && others == 0) return "tum";
  if (count == 12 && others == 0) return "kitti";
  throw BadInput(fmt::format(
      "{}: its first line has {} numbers{}; it must have 8 (TUM: t x y z qx qy qz qw) or 12 (KITTI: rows of "
      "a matrix), or the header of a table of poses with the names of time, position and quaternion "
      "(timestamp,x,y,z,qx,qy,qz,qw)",
      file.string(), count - others, others == 0 ? "" : fmt::format(" and {} other words", others)));
}

std::vector<ReferencePose> read_tum_poses(const std::filesystem::path& file, bool sorted) {
  const Table table = Table::read(file, ' ', "", 8);
  std::vector<ReferencePose> poses;
  for (const Table::Row& row : table.rows) {
    ReferencePose pose = tum_pose(table, row);
    if (is_unknown(pose)) continue;
    const std::string problem = problem_of(pose, sorted || poses.empty() ? nullptr : &poses.back());
    if (!problem.empty()) fail(table, row, problem);
    poses.push_back(pose);
  }
  finish_poses(file, sorted, poses);
  return poses;
}

std::size_t count_kitti_poses(const std::filesystem::path& file) {
  const Table table = Table::read(file, ' ', "", 12);
  for (const Table::Row& row : table.rows) kitti_matrix(table, row);
  return table.rows.size();
}

std::vector<ReferencePose> read_kitti_poses(const std::filesystem::path& file,
                                            const std::vector<std::int64_t>& times_ns) {
  const Table table = Table::read(file, ' ', "", 12);
  if (table.rows.size() != times_ns.size()) {
    throw BadInput(fmt::format("{}: the file has {} poses, but there are {} times; both numbers must be equal",
                               file.string(), table.rows.size(), times_ns.size()));
  }
  std::vector<ReferencePose> poses;
  for (std::size_t k = 0; k < times_ns.size(); ++k) {
    const Eigen::Matrix<double, 3, 4> T = kitti_matrix(table, table.rows[k]);
    const Eigen::Quaterniond q(Eigen::Matrix3d(T.leftCols<3>()));
    poses.push_back({times_ns[k], T.col(3), q.normalized()});
  }
  return poses;
}

}  // namespace tumble::scenarios
