// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/estimate_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/base_frame.hpp"
#include "scenarios/estimates/covariance_file.hpp"
#include "scenarios/estimates/findings.hpp"
#include "scenarios/estimates/json_members.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/recordings/table_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;
const std::string kRatesHeader = "time_ns,wx_rad_s,wy_rad_s,wz_rad_s,cxx,cxy,cxz,cyy,cyz,czz,clipped_axes,source";
const std::string kPoseColumns = "px_m,py_m,pz_m,qx,qy,qz,qw,vx_m_s,vy_m_s,vz_m_s";
const std::string kContactsHeader = "time_ns,label";
const std::string kFlaggedContactsHeader = kContactsHeader + ",uncertain";
constexpr std::size_t kCovarianceColumn = 16;
const std::string kSweepsHeader =
    "end_ns,verdict,iterations,inlier_share,conditioning,pose_time_ns," + kPoseColumns +
    ",c00,c01,c02,c03,c04,c05,c11,c12,c13,c14,c15,c22,c23,c24,c25,c33,c34,c35,c44,c45,c55";
const std::string kSweepPosesHeader = "sweep,time_ns," + kPoseColumns;

void write_quaternion(TableWriter& table, const Eigen::Quaterniond& q) {
  for (int j = 0; j < 4; ++j) table.number(q.coeffs()[j]);
}

void write_vector(TableWriter& table, const Eigen::Vector3d& v) {
  for (int j = 0; j < 3; ++j) table.number(v[j]);
}

Eigen::Vector3d read_vector(const Table& table, const Table::Row& row, std::size_t first) {
  return {table.number(row, first), table.number(row, first + 1), table.number(row, first + 2)};
}

Eigen::Quaterniond read_quaternion(const Table& table, const Table::Row& row, std::size_t first, bool normalise) {
  Eigen::Quaterniond q(table.number(row, first + 3), table.number(row, first), table.number(row, first + 1),
                       table.number(row, first + 2));
  const double norm = q.coeffs().stableNorm();
  if (std::abs(norm - 1.0) > 1e-2)
    throw BadInput(
        fmt::format("{}:{}: the quaternion has norm {:g}; it must be 1", table.path.string(), row.line, norm));
  return normalise ? q.normalized() : q;
}

void write_pose(TableWriter& table, const PoseState& pose) {
  write_vector(table, pose.position_W_m);
  write_quaternion(table, pose.orientation_W);
  write_vector(table, pose.velocity_W_m_s);
}

PoseState read_pose(const Table& table, const Table::Row& row, std::size_t time_column, std::size_t first) {
  PoseState pose;
  pose.time_ns = table.integer(row, time_column);
  pose.position_W_m = read_vector(table, row, first);
  pose.orientation_W = read_quaternion(table, row, first + 3, false);
  pose.velocity_W_m_s = read_vector(table, row, first + 7);
  return pose;
}

void write_rates(const std::filesystem::path& path, const std::vector<AngularRateState>& rates) {
  TableWriter table(path, ',', kRatesHeader);
  for (const AngularRateState& rate : rates) {
    table.integer(rate.time_ns);
    write_vector(table, rate.w_WI_I_rad_s);
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) table.number(rate.covariance_rad2_s2(i, j));
    }
    table.integer(rate.clipped_axes);
    table.integer(static_cast<int>(rate.source));
    table.end_row();
  }
  table.close();
}

void read_rates(const std::filesystem::path& path, std::vector<AngularRateState>& rates) {
  const Table table = Table::read(path, ',', kRatesHeader, 12);
  for (const Table::Row& row : table.rows) {
    AngularRateState rate;
    rate.time_ns = table.integer(row, 0);
    rate.w_WI_I_rad_s = read_vector(table, row, 1);
    std::size_t column = 4;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        rate.covariance_rad2_s2(i, j) = rate.covariance_rad2_s2(j, i) = table.number(row, column++);
      }
    }
    rate.clipped_axes = static_cast<std::uint8_t>(table.integer(row, 10));
    const std::int64_t source = table.integer(row, 11);
    if (source < 0 || source > static_cast<int>(AngularRateSource::lower_bound_only)) {
      throw BadInput(path.string() + ":" + std::to_string(row.line) + ": unknown source " + std::to_string(source));
    }
    rate.source = static_cast<AngularRateSource>(source);
    rates.push_back(rate);
  }
}

// Contact modes in the file are 0 air, 1 grip, 2 slip, 3 slide.
void write_contacts(const std::filesystem::path& path, const Estimate& estimate) {
  const bool flagged = !estimate.uncertain.empty();
  TableWriter table(path, ',', flagged ? kFlaggedContactsHeader : kContactsHeader);
  for (std::size_t k = 0; k < estimate.contacts.size(); ++k) {
    table.integer(estimate.poses[k].time_ns);
    table.integer(static_cast<int>(estimate.contacts[k]));
    if (flagged) table.integer(estimate.uncertain[k] ? 1 : 0);
    table.end_row();
  }
  table.close();
}

bool begins_with(const std::filesystem::path& path, const std::string& header) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line == header;
}

void read_contacts(const std::filesystem::path& path, Estimate& estimate) {
  const bool flagged = begins_with(path, kFlaggedContactsHeader);
  const Table table =
      flagged ? Table::read(path, ',', kFlaggedContactsHeader, 3) : Table::read(path, ',', kContactsHeader, 2);
  require_stamps(table, stamps_ns(estimate.poses));
  for (const Table::Row& row : table.rows) {
    const std::int64_t label = table.integer(row, 1);
    if (label < 0 || label > static_cast<int>(sim::ContactLabel::slide)) {
      throw BadInput(path.string() + ":" + std::to_string(row.line) + ": unknown label " + std::to_string(label));
    }
    estimate.contacts.push_back(static_cast<sim::ContactLabel>(label));
    if (!flagged) continue;
    const std::int64_t uncertain = table.integer(row, 2);
    if (uncertain != 0 && uncertain != 1) {
      throw BadInput(
          fmt::format("{}:{}: column 'uncertain' is {}; it must be 0 or 1", path.string(), row.line, uncertain));
    }
    estimate.uncertain.push_back(uncertain == 1);
  }
}

void write_sweeps(const std::filesystem::path& folder, const Estimate& estimate) {
  TableWriter sweeps(folder / "sweeps.csv", ',', kSweepsHeader);
  TableWriter poses(folder / "sweep_poses.csv", ',', kSweepPosesHeader);
  for (std::size_t k = 0; k < estimate.sweeps.size(); ++k) {
    const auto& sweep = estimate.sweeps[k];
    sweeps.integer(estimate.sweep_end_ns[k]);
    sweeps.integer(static_cast<int>(sweep.verdict));
    sweeps.integer(sweep.iterations);
    sweeps.number(sweep.inlier_ratio);
    sweeps.number(sweep.eigenvalue_ratio);
    sweeps.integer(sweep.pose.time_ns);
    write_pose(sweeps, sweep.pose);
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) sweeps.number(sweep.pose.covariance(i, j));
    }
    sweeps.end_row();
    for (const PoseState& pose : sweep.trajectory) {
      poses.integer(static_cast<std::int64_t>(k));
      poses.integer(pose.time_ns);
      write_pose(poses, pose);
      poses.end_row();
    }
  }
  sweeps.close();
  poses.close();
}

void read_sweeps(const std::filesystem::path& folder, Estimate& estimate) {
  const Table sweeps = Table::read(folder / "sweeps.csv", ',', kSweepsHeader, kCovarianceColumn + 21);
  for (const Table::Row& row : sweeps.rows) {
    LidarInertialOdometry::SweepResult sweep;
    const std::int64_t verdict = sweeps.integer(row, 1);
    if (verdict < 0 || verdict > static_cast<int>(SweepVerdict::rejected)) {
      throw BadInput(sweeps.path.string() + ":" + std::to_string(row.line) + ": unknown verdict " +
                     std::to_string(verdict));
    }
    sweep.verdict = static_cast<SweepVerdict>(verdict);
    sweep.iterations = static_cast<int>(sweeps.integer(row, 2));
    sweep.inlier_ratio = sweeps.number(row, 3);
    sweep.eigenvalue_ratio = sweeps.number(row, 4);
    sweep.pose = read_pose(sweeps, row, 5, 6);
    std::size_t column = kCovarianceColumn;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) {
        sweep.pose.covariance(i, j) = sweep.pose.covariance(j, i) = sweeps.number(row, column++);
      }
    }
    estimate.sweep_end_ns.push_back(sweeps.integer(row, 0));
    estimate.sweeps.push_back(std::move(sweep));
  }
  const Table poses = Table::read(folder / "sweep_poses.csv", ',', kSweepPosesHeader, 12);
  for (const Table::Row& row : poses.rows) {
    const std::int64_t index = poses.integer(row, 0);
    if (index < 0 || index >= static_cast<std::int64_t>(estimate.sweeps.size())) {
      throw BadInput(fmt::format("{}:{}: the row belongs to sweep {}, which the estimate does not contain",
                                 poses.path.string(), row.line, index));
    }
    estimate.sweeps[static_cast<std::size_t>(index)].trajectory.push_back(read_pose(poses, row, 1, 2));
  }
}

void read_tum(const std::filesystem::path& path, std::vector<PoseState>& poses, bool all_finite = false) {
  const Table table = Table::read(path, ' ', "", 8);
  for (const Table::Row& row : table.rows) {
    PoseState pose;
    pose.time_ns = table.time_ns(row, 0);
    pose.position_W_m = read_vector(table, row, 1);
    pose.orientation_W = read_quaternion(table, row, 4, true);
    if (all_finite && !(pose.position_W_m.allFinite() && pose.orientation_W.coeffs().allFinite()))
      throw BadInput(fmt::format("{}:{}: the pose is not finite", path.string(), row.line));
    if (!poses.empty() && pose.time_ns <= poses.back().time_ns)
      throw BadInput(fmt::format("{}:{}: time stamps must increase", path.string(), row.line));
    poses.push_back(pose);
  }
}

void write_attitudes(const std::filesystem::path& folder, const std::vector<AttitudeState>& attitudes) {
  TableWriter table(folder / "attitude.tum", ' ', "");
  for (const AttitudeState& attitude : attitudes) {
    table.time_s(attitude.time_ns);
    write_vector(table, Eigen::Vector3d::Zero());
    write_quaternion(table, attitude.orientation_W);
    table.end_row();
  }
  table.close();
  std::vector<Eigen::Matrix3d> covariances_rad2;
  covariances_rad2.reserve(attitudes.size());
  for (const AttitudeState& attitude : attitudes) covariances_rad2.push_back(attitude.covariance_rad2);
  write_covariances(folder / "attitude_covariance.csv", stamps_ns(attitudes), covariances_rad2);
}

void read_attitudes(const std::filesystem::path& folder, std::vector<AttitudeState>& attitudes) {
  std::vector<PoseState> poses;
  read_tum(folder / "attitude.tum", poses);
  for (const PoseState& pose : poses) attitudes.push_back({pose.time_ns, pose.orientation_W, Eigen::Matrix3d::Zero()});
  const std::filesystem::path path = folder / "attitude_covariance.csv";
  if (!std::filesystem::exists(path)) return;
  const std::vector<Eigen::Matrix3d> covariances_rad2 = read_covariances(path, stamps_ns(attitudes));
  for (std::size_t k = 0; k < attitudes.size(); ++k) attitudes[k].covariance_rad2 = covariances_rad2[k];
}

json header_of(const std::string& method, Kind kind, const Estimate& estimate, const std::string& sensors_digest,
               std::int64_t origin_ns) {
  json health = json::object(), findings = json::array(), settings = json::array();
  for (const auto& [name, value] : estimate.health) health[name] = value;
  for (const HealthFinding& each : estimate.faults.findings) findings.push_back(json_of(each));
  for (const auto& [name, value, source, option] : estimate.settings)
    settings.push_back({{"setting", name}, {"value", value}, {"source", source}, {"option", option}});
  json header = {{"format", kFormatVersion},
                 {"method", method},
                 {"kind", to_string(kind)},
                 {"frame", estimate.T_base_imu ? kBase : to_string(estimate.frame)},
                 {"status",
                  {{"trouble", to_string(estimate.status.error_code)},
                   {"field", estimate.status.field},
                   {"message", estimate.status.message()}}},
                 {"usable", estimate.status.ok() && !estimate.faults.invalidates_estimate()},
                 {"health", health},
                 {"findings", findings},
                 {"parameters", json(estimate.parameters)},
                 {"settings", settings},
                 {"sensors_digest", sensors_digest},
                 {"origin_ns", origin_ns}};
  if (estimate.T_base_imu) header[kBasePose] = numbers_of(*estimate.T_base_imu);
  return header;
}

void read_header(const std::filesystem::path& path, Kind& kind, std::string& method, Estimate& estimate) {
  if (std::error_code error; !std::filesystem::exists(path, error))
    throw BadInput(
        fmt::format("{}: the file does not exist, so the folder does not contain an estimate", path.string()));
  std::ifstream file = open_regular_file(path);
  const json header = json::parse(file, nullptr, false);
  if (!header.is_object()) throw BadInput(fmt::format("{}: the file is not a JSON object", path.string()));
  const JsonMembers reader(path, header);
  if (reader.member("format") != kFormatVersion) reader.complain("format", std::to_string(kFormatVersion));
  method = reader.text("method");
  kind = reader.named("kind", Kind::slam);
  if (reader.text("frame") == kBase) {
    estimate.T_base_imu = pose_of(reader, kBasePose);
  } else {
    estimate.frame = reader.named("frame", Frame::centre);
  }
  const json& status = reader.object("status");
  estimate.status.error_code = JsonMembers(path, status).named("trouble", ErrorCode::diverged);
  if (!estimate.status.ok()) estimate.status.field = "estimate.json";
  for (const auto& [name, value] : reader.object("health").items())
    estimate.health[name] = value.is_number() ? value.get<double>() : std::nan("");
  for (const json& each : header.value("findings", json::array()))  // missing in earlier versions
    estimate.faults.findings.push_back(finding_in(path, each));
  if (!header.contains("parameters")) return;
  for (const auto& [name, value] : reader.object("parameters").items()) {
    if (!value.is_number()) JsonMembers(path, header.at("parameters")).complain(name.c_str(), "a number");
    estimate.parameters[name] = value.get<double>();
  }
}

}  // namespace

void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest, std::int64_t origin_ns) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw BadInput(fmt::format("{}: the folder cannot be created: {}", folder.string(), error.message()));
  for (const char* name : kEstimateFiles) std::filesystem::remove(folder / name, error);
  if (!estimate.rates.empty()) write_rates(folder / "rates.csv", estimate.rates);
  if (!estimate.attitudes.empty()) write_attitudes(folder, estimate.attitudes);
  const std::vector<PoseState> poses = written_poses(estimate);
  if (!poses.empty()) {
    TableWriter table(folder / "trajectory.tum", ' ', "");
    for (const PoseState& pose : poses) {
      table.time_s(pose.time_ns);
      write_vector(table, pose.position_W_m);
      write_quaternion(table, pose.orientation_W);
      table.end_row();
    }
    table.close();
  }
  write_position_covariances(folder / "position_covariance.csv", poses);
  if (!estimate.uncertain.empty() && estimate.uncertain.size() != estimate.contacts.size()) {
    throw std::invalid_argument(
        fmt::format("the estimate has {} 'uncertain' flags for {} contacts; their numbers must be equal",
                    estimate.uncertain.size(), estimate.contacts.size()));
  }
  if (!estimate.contacts.empty() && estimate.contacts.size() != estimate.poses.size()) {
    throw std::invalid_argument(fmt::format("the estimate has {} contacts for {} poses; their numbers must be equal",
                                            estimate.contacts.size(), estimate.poses.size()));
  }
  if (!estimate.contacts.empty()) write_contacts(folder / "contacts.csv", estimate);
  if (!estimate.sweeps.empty()) write_sweeps(folder, estimate);
  if (!estimate.map.empty()) write_map(folder / "map.ply", estimate.map);
  if (!estimate.transcript.empty()) replace_file(folder / "transcript.txt", estimate.transcript);

  // The file estimate.json is written last, because its presence marks a completely written folder.
  replace_file(folder / "estimate.json", header_of(method, kind, estimate, sensors_digest, origin_ns).dump(2) + '\n');
}

std::string estimated_sensors(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return "";
  std::ifstream file(path / "estimate.json");
  const json header = json::parse(file, nullptr, false);
  const bool reported = header.is_object() && header.contains("sensors_digest") && header["sensors_digest"].is_string();
  return reported ? header["sensors_digest"].get<std::string>() : "";
}

Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame) {
  Estimate estimate;
  if (!std::filesystem::is_directory(path)) {
    kind = Kind::position;
    method = path.stem().string();
    estimate.frame = tum_frame;
    if (is_pose_table(path)) {
      for (const ReferencePose& pose : read_pose_table(path, false))
        estimate.poses.push_back({pose.time_ns, pose.p_WA_m, pose.q_WA});
    } else {
      read_tum(path, estimate.poses, true);
    }
    if (estimate.poses.empty()) throw BadInput(path.string() + ": contains no pose");
    return estimate;
  }
  read_header(path / "estimate.json", kind, method, estimate);
  const auto there = [&](const char* name) { return std::filesystem::exists(path / name); };
  if (there("rates.csv")) read_rates(path / "rates.csv", estimate.rates);
  if (there("trajectory.tum")) read_tum(path / "trajectory.tum", estimate.poses);
  if (estimate.T_base_imu) {
    for (PoseState& pose : estimate.poses) pose = pose.transformed_to(*estimate.T_base_imu, Eigen::Vector3d::Zero());
  } else if (there("position_covariance.csv")) {
    read_position_covariances(path / "position_covariance.csv", estimate.poses);
  }
  if (there("contacts.csv")) read_contacts(path / "contacts.csv", estimate);
  if (there("attitude.tum")) read_attitudes(path, estimate.attitudes);
  if (there("sweeps.csv")) read_sweeps(path, estimate);
  if (there("map.ply")) estimate.map = read_map(path / "map.ply");
  return estimate;
}

}  // namespace tumble::scenarios
