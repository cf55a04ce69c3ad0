// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/recordings/hdf5_file.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/recordings/trajectories/reference_check.hpp"
#include "scenarios/recordings/trajectories/reference_rate.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kBroadAttribution =
    "D. Laidig, M. Caruso, A. Cereatti, T. Seel: BROAD - A Benchmark for Robust Inertial Orientation Estimation, "
    "Data 2021, 6(7), 72; CC BY 4.0; trial ";

/// kSlopeReach is half of the time interval for differentiating the reference: 70 ms. The interval of 140 ms keeps the
/// noise at rest below the thresholds that the scores use for rest (half the interval: 0.022 rad/s). The interval is
/// too long for fast rotations, which it blurs.
constexpr std::size_t kSlopeReach = 20;

sim::ImuRecord read_imu(const hdf5::Group& root, double rate_hz) {
  sim::ImuRecord imu;
  imu.name = "imu";
  imu.period_ns = std::llround(1e9 / rate_hz);
  root.read("imu_gyr", imu.gyro_rad_s);
  root.read("imu_acc", imu.accel_m_s2);
  if (root.has("imu_mag")) root.read("imu_mag", imu.magnetic_field_t);
  for (Eigen::Vector3d& field : imu.magnetic_field_t) field *= kTeslaPerMicrotesla;
  for (std::size_t k = 0; k < imu.gyro_rad_s.size(); ++k) {
    // The time stamp is computed from the sample rate, because multiples of a rounded period would drift.
    imu.time_ns.push_back(std::llround(static_cast<double>(k) * 1e9 / rate_hz));
  }
  imu.clip_flags.assign(imu.time_ns.size(), 0);
  return imu;
}

/// Returns the reference attitudes as unit quaternions, with NaN where the cameras saw too few markers.
std::vector<Eigen::Quaterniond> attitudes(const hdf5::Group& root) {
  std::vector<Eigen::Vector4d> rows;
  root.read("opt_quat", rows);
  std::vector<Eigen::Quaterniond> q_WB;
  for (const Eigen::Vector4d& row : rows) {
    Eigen::Quaterniond q(row[0], row[1], row[2], row[3]);
    if (row.allFinite()) {
      if (std::abs(q.norm() - 1.0) > 1e-2)
        root.fail("opt_quat", fmt::format("the quaternion in row {} must have norm 1", q_WB.size()));
      q.normalize();
    } else {
      q.coeffs().setConstant(kNaN);
    }
    q_WB.push_back(q);
  }
  return q_WB;
}

/// Returns the known reference attitudes with the time stamps of their samples.
std::vector<ReferencePose> known_poses(const sim::Truth& truth, const sim::ImuRecord& imu) {
  std::vector<ReferencePose> poses;
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    if (truth.q_WB[k].coeffs().allFinite()) poses.push_back({imu.time_ns[k], truth.p_WB_m[k], truth.q_WB[k]});
  }
  return poses;
}

/// Reads the optical reference of a BROAD file. The body axes are the IMU axes; the world axes are east, north, up.
std::optional<sim::Truth> read_reference(const hdf5::Group& root, const sim::ImuRecord& imu) {
  if (!root.has("opt_quat") || !root.has("opt_pos")) return std::nullopt;
  sim::Truth truth;
  truth.period_ns = imu.period_ns;
  truth.q_WB = attitudes(root);
  root.read("opt_pos", truth.p_WB_m);
  for (const auto& [name, rows] :
       {std::pair{"opt_quat", truth.q_WB.size()}, std::pair{"opt_pos", truth.p_WB_m.size()}}) {
    if (rows != imu.time_ns.size()) {
      root.fail(name, fmt::format("the dataset has {} rows, but imu_gyr has {}; the numbers must be equal", rows,
                                  imu.time_ns.size()));
    }
  }
  differentiate(truth, kSlopeReach);
  sim::ImuTruth own;
  own.name = imu.name;
  own.rate_rad_s = reference_rates(known_poses(truth, imu), imu.time_ns);
  truth.imus.push_back(std::move(own));
  return truth;
}

}  // namespace

Imported import_broad(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  const hdf5::Group& root = file.root();
  if (root.has_attribute("format") && root.text_attribute("format") == kRecordingFormat)
    throw BadInput(
        fmt::format("{}: this file is already a recording; use the file directly, without import", path.string()));
  const double rate_hz = root.double_attribute("sampling_rate");
  if (!(rate_hz >= 1.0 && rate_hz <= 1e5))
    root.fail("sampling_rate", "the sampling rate must be within 1 and 100000 Hz");
  Imported out;
  out.info.attribution = kBroadAttribution + path.stem().string();
  out.sensors.imus.push_back(read_imu(root, rate_hz));
  out.reference = read_reference(root, out.sensors.imus.front());
  if (out.reference)
    out.notes.push_back(check_reference(known_poses(*out.reference, out.sensors.imus.front()),
                                        Eigen::Isometry3d::Identity(), out.sensors, path.string()));
  std::string problem = find_problem(out.sensors);
  if (problem.empty() && out.reference) problem = find_problem(*out.reference);
  if (!problem.empty()) throw BadInput(path.string() + ": " + problem);
  return out;
}

}  // namespace tumble::scenarios
