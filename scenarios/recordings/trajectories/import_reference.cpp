// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/table_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/recordings/trajectories/reference_check.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

std::vector<std::int64_t> own_times(const ReferenceSource& source) {
  if (!source.times.empty()) return read_stamps(source.times);
  if (source.steady_ns <= 0) {
    throw BadInput(fmt::format(
        "{}: the KITTI format has no times; give a file of time stamps (--times) or a period (--sweep-period)",
        source.file.string()));
  }
  const std::size_t poses = count_kitti_poses(source.file);
  std::vector<std::int64_t> times;
  for (std::size_t k = 0; k < poses; ++k) times.push_back(static_cast<std::int64_t>(k) * source.steady_ns);
  return times;
}

std::vector<ReferencePose> poses_of(const ReferenceSource& source, const std::vector<std::int64_t>& sweeps_ns) {
  if (source.format == "tum") return read_tum_poses(source.file, source.sorted);
  if (source.format == "kitti") return read_kitti_poses(source.file, sweeps_ns.empty() ? own_times(source) : sweeps_ns);
  if (source.format == "odometry") return read_pose_table(source.file, source.sorted);
  throw BadInput(
      fmt::format("the pose format '{}' is not supported; supported: tum, kitti and odometry", source.format));
}

void move_to(std::vector<ReferencePose>& poses, const Eigen::Isometry3d& T_AB) {
  if (T_AB.matrix().isIdentity(0.0)) return;
  const Eigen::Quaterniond q_AB(T_AB.linear());
  for (ReferencePose& pose : poses) {
    pose.p_WA_m += pose.q_WA * T_AB.translation();
    pose.q_WA = (pose.q_WA * q_AB).normalized();
  }
}

sim::Truth named(const std::string& where, const std::vector<ReferencePose>& poses, std::int64_t end_ns) {
  try {
    return reference_truth(poses, end_ns);
  } catch (const BadInput& error) {
    throw BadInput(where + ": " + error.what());
  }
}

}  // namespace

Imported import_trajectory(const ReferenceSource& source) {
  std::vector<ReferencePose> poses = poses_of(source, {});
  if (poses.empty()) throw BadInput(source.file.string() + ": contains no pose");
  Imported out;
  out.info.origin_ns = origin_of(poses.front().time_ns);
  for (ReferencePose& pose : poses) pose.time_ns -= out.info.origin_ns;
  out.reference = named(source.file.string(), poses, poses.back().time_ns);
  out.info.attribution = "imported from " + source.file.filename().string();
  return out;
}

const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where) {
  if (sensors.lidars.empty())
    throw BadInput(fmt::format("{}: the poses belong to a lidar, but the recording has no lidar", where));
  return sensors.lidars.front().T_BL;
}

void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where) {
  const sim::Sensors& sensors = recording.sensors;
  for (ReferencePose& pose : poses) pose.time_ns -= recording.info.origin_ns;
  const StampSpan span = span_of(sensors);
  if (!poses.empty()) {
    const auto shift_ns =
        clock_shift_ns({poses.front().time_ns, poses.back().time_ns}, span, {0, kExportOrigin_ns, -kExportOrigin_ns});
    for (ReferencePose& pose : poses) pose.time_ns += shift_ns.value_or(0);
    if (shift_ns.value_or(0) != 0) recording.notes.push_back(clock_note("the reference", *shift_ns));
  }
  std::string remark = check_reference(poses, T_BA, sensors, where);
  move_to(poses, T_BA.inverse(Eigen::Isometry));
  sim::Truth truth = named(where, poses, span.second);
  for (const sim::ImuRecord& imu : sensors.imus) {
    sim::ImuTruth& own = truth.imus.emplace_back();
    own.name = imu.name;
    own.T_BI = imu.T_BI;
  }
  for (const sim::LidarRecord& lidar : sensors.lidars) truth.lidars.push_back({lidar.name, lidar.T_BL, {}, {}});
  for (const sim::SeriesRecord& series : sensors.series) truth.series.push_back({series.name, series.T_BX, {}});
  recording.reference = std::move(truth);
  recording.notes.push_back(std::move(remark));
}

void attach_reference(Imported& recording, const ReferenceSource& source) {
  const sim::Sensors& sensors = recording.sensors;
  if (sensors.lidars.empty() && source.format == "kitti")
    throw BadInput(
        fmt::format("{}: a KITTI file has one pose per sweep, but the recording has no lidar", source.file.string()));
  std::vector<std::int64_t> sweeps_ns;
  if (!sensors.lidars.empty()) sweeps_ns = sensors.lidars.front().sweep_start_ns;
  for (std::int64_t& time : sweeps_ns) time += recording.info.origin_ns;
  const std::string where = source.file.string();
  const Eigen::Isometry3d T_BA = source.of_body ? Eigen::Isometry3d::Identity() : lidar_of_poses(sensors, where);
  attach_poses(recording, poses_of(source, sweeps_ns), T_BA, where);
  recording.info.attribution += "; reference from " + source.file.filename().string();
}

namespace {

/// Rotation matrices in KITTI files have only seven digits, so the tolerance for orthogonality is 1e-3.
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
      "{}: the first line has {} numbers{}. A line of a TUM file has 8 numbers (t x y z qx qy qz qw), and a line of a "
      "KITTI file has 12 (rows of a matrix). A table of poses starts with a header (timestamp,x,y,z,qx,qy,qz,qw)",
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

namespace {

constexpr std::int64_t kStepMin_ns = 100000, kStepUsual_ns = 1000000;
constexpr std::int64_t kSamplesMax = 2000000;
constexpr std::int64_t kLongestReference_ns = 86400ll * 1000000000;
/// Reference poses are differentiated over 2 * kReach_ns. With this interval, the noise of an optical reference at rest
/// stays below the speed limits for rest.
constexpr std::int64_t kReach_ns = 70000000;

std::vector<std::int64_t> times_of(const std::vector<ReferencePose>& poses) {
  std::vector<std::int64_t> times;
  for (const ReferencePose& pose : poses) times.push_back(pose.time_ns);
  return times;
}

std::int64_t grid_step(const std::vector<std::int64_t>& times, std::int64_t end_ns) {
  std::int64_t step = std::numeric_limits<std::int64_t>::max();
  for (std::size_t k = 1; k < times.size(); ++k) step = std::min(step, times[k] - times[k - 1]);
  const auto on_grid = [&](std::int64_t time) { return time % step == 0; };
  const bool own = step >= kStepMin_ns && std::all_of(times.begin(), times.end(), on_grid);
  if (own && end_ns / step < kSamplesMax) return step;
  const std::int64_t usual_steps = end_ns / kStepUsual_ns / kSamplesMax + 1;
  return usual_steps * kStepUsual_ns;
}

class Interpolation {
 public:
  Interpolation(const std::vector<ReferencePose>& poses, std::int64_t gap_ns) : poses_(poses), gap_ns_(gap_ns) {}

  ReferencePose at(std::int64_t time_ns) {
    while (next_ < poses_.size() && poses_[next_].time_ns < time_ns) ++next_;
    ReferencePose out{time_ns, Eigen::Vector3d::Constant(kNaN), {}};
    out.q_WA.coeffs().setConstant(kNaN);
    if (next_ == poses_.size()) return out;
    const ReferencePose& after = poses_[next_];
    if (after.time_ns == time_ns) return after;
    if (next_ == 0 || after.time_ns - poses_[next_ - 1].time_ns > gap_ns_) return out;
    const ReferencePose& before = poses_[next_ - 1];
    const double share =
        static_cast<double>(time_ns - before.time_ns) / static_cast<double>(after.time_ns - before.time_ns);
    out.p_WA_m = (1.0 - share) * before.p_WA_m + share * after.p_WA_m;
    out.q_WA = before.q_WA.slerp(share, after.q_WA);
    return out;
  }

 private:
  const std::vector<ReferencePose>& poses_;
  std::int64_t gap_ns_;
  std::size_t next_ = 0;
};

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd turn(q);
  return turn.angle() * turn.axis();
}

void differentiate(sim::Truth& truth, std::size_t reach) {
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(kNaN);
  const std::size_t count = truth.q_WB.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t before = k > reach ? k - reach : 0, after = std::min(k + reach, count - 1);
    const double span_s = static_cast<double>(after - before) * static_cast<double>(truth.period_ns) * 1e-9;
    const Eigen::Quaterniond turn = truth.q_WB[before].conjugate() * truth.q_WB[after];
    const Eigen::Quaterniond to_here = truth.q_WB[k].conjugate() * truth.q_WB[before];
    const bool known = turn.coeffs().allFinite() && to_here.coeffs().allFinite() && after > before;
    truth.w_WB_B_rad_s.push_back(known ? Eigen::Vector3d(to_here * rotation_vector(turn) / span_s) : unknown);
    truth.v_WB_m_s.push_back(known ? Eigen::Vector3d((truth.p_WB_m[after] - truth.p_WB_m[before]) / span_s) : unknown);
  }
}

}  // namespace

sim::Truth reference_truth(const std::vector<ReferencePose>& poses, std::int64_t end_ns) {
  if (poses.empty()) throw BadInput("the reference file contains no pose with known position and attitude");
  const std::int64_t last_ns = std::min(end_ns, poses.back().time_ns);
  if (last_ns < 0 || poses.front().time_ns > end_ns) {
    throw BadInput(fmt::format(
        "the reference covers {} to {} ns of the recording, which lasts {} ns; check that both use the same clock",
        poses.front().time_ns, poses.back().time_ns, end_ns));
  }
  if (last_ns > kLongestReference_ns) {
    throw BadInput(fmt::format("the reference lasts {} ns; it may last at most one day", last_ns));
  }
  const std::vector<std::int64_t> times = times_of(poses);
  sim::Truth truth;
  truth.period_ns = grid_step(times, last_ns);
  Interpolation reference(poses, median_step_ns(times) * 5 / 2);
  for (std::int64_t time = 0; time <= last_ns; time += truth.period_ns) {
    const ReferencePose pose = reference.at(time);
    truth.p_WB_m.push_back(pose.p_WA_m);
    truth.q_WB.push_back(pose.q_WA);
  }
  const auto known = [](const Eigen::Quaterniond& q) { return q.coeffs().allFinite(); };
  if (std::none_of(truth.q_WB.begin(), truth.q_WB.end(), known)) {
    throw BadInput("the poses of the reference are too far apart in time, so no pose can be interpolated");
  }
  differentiate(truth, static_cast<std::size_t>(std::max<std::int64_t>(kReach_ns / truth.period_ns, 1)));
  return truth;
}

}  // namespace tumble::scenarios
