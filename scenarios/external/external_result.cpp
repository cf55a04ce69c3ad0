// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/external_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/external/answer_bounds.hpp"
#include "scenarios/external/turning_sense.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/table_file.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kStampTolerance_ns = 1000;  // stamps stored as seconds in doubles
constexpr const char* kRateColumns = "time_ns,wx_rad_s,wy_rad_s,wz_rad_s";
constexpr const char* kWithCovariance = "time_ns,wx_rad_s,wy_rad_s,wz_rad_s,cxx,cxy,cxz,cyy,cyz,czz";

std::string header_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw BadInput(fmt::format("{}: the command did not write this file", file.filename().string()));
  std::string line;
  std::getline(stream, line);
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

Eigen::Matrix3d covariance(const Table& table, const Table::Row& row) {
  Eigen::Matrix3d out;
  std::size_t column = 4;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) out(i, j) = out(j, i) = table.number(row, column++);
  return out;
}

std::vector<AngularRateState> read_rates(const std::filesystem::path& file, const sim::Sensors& sensors) {
  if (sensors.imus.empty()) throw BadInput("the recording has no IMU; a rate method needs the samples of an IMU");
  const std::vector<std::int64_t>& stamps = sensors.imus.front().time_ns;
  const std::string header = header_line(file);
  const bool with_covariance = header == kWithCovariance;
  if (!with_covariance && header != kRateColumns)
    throw BadInput(fmt::format(
        "{}:1: the header is '{}'; it must be '{}' or the same header with ',cxx,cxy,cxz,cyy,cyz,czz' at its end",
        file.filename().string(), header.substr(0, 120), kRateColumns));
  const Table table = Table::read(file, ',', header, with_covariance ? 10 : 4);
  if (table.rows.size() != stamps.size())
    throw BadInput(fmt::format("{}: the file has {} rows of rates; it must have {} rows, one per sample of the IMU {}",
                               file.filename().string(), table.rows.size(), stamps.size(), sensors.imus.front().name));
  std::vector<AngularRateState> rates(stamps.size());
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const Table::Row& row = table.rows[k];
    const std::int64_t time_ns = table.integer(row, 0);
    if (time_ns < stamps[k] - kStampTolerance_ns || time_ns > stamps[k] + kStampTolerance_ns)
      throw BadInput(
          fmt::format("{}:{}: the time of the rate is {} ns, but sample {} of the recording has the time {} ns; the "
                      "times must be equal",
                      file.filename().string(), row.line, time_ns, k, stamps[k]));
    rates[k].time_ns = stamps[k];
    rates[k].w_WI_I_rad_s = {table.number(row, 1), table.number(row, 2), table.number(row, 3)};
    if (with_covariance) rates[k].covariance_rad2_s2 = covariance(table, row);
  }
  return rates;
}

std::vector<double> stamps_of(const std::filesystem::path& file) {
  std::vector<double> stamps_s;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#' || line == "\r") continue;
    std::string_view word = line;
    word.remove_prefix(std::min(word.find_first_not_of(" \t"), word.size()));
    double stamp_s = 0.0;
    if (!parse_number(word.substr(0, word.find_first_of(" \t,;")), stamp_s) || !std::isfinite(stamp_s)) break;
    stamps_s.push_back(stamp_s);
  }
  constexpr double kOrigin_s = 1e-9 * static_cast<double>(kExportOrigin_ns);
  // Exported bags start at the time kOrigin_s, so time stamps near kOrigin_s are in the clock of exported bags.
  if (!stamps_s.empty() && stamps_s.front() > kOrigin_s / 2 && stamps_s.back() < kOrigin_s * 2)
    for (double& stamp_s : stamps_s) stamp_s -= kOrigin_s;
  return stamps_s;
}

Estimate read_poses(const ExternalDescription& description, const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw BadInput(fmt::format("{}: the command did not write this file", file.filename().string()));
  Kind kind{};
  std::string method;
  Estimate estimate = read_estimate(file, kind, method, description.frame);
  if (estimate.poses.front().time_ns > kExportOrigin_ns / 2)
    for (PoseState& pose : estimate.poses) pose.time_ns -= kExportOrigin_ns;
  if (description.kind != Kind::attitude) return estimate;
  for (const PoseState& pose : std::exchange(estimate.poses, {}))
    estimate.attitudes.push_back({pose.time_ns, pose.orientation_W, Eigen::Matrix3d::Zero()});
  return estimate;
}

Estimate read_folder(const ExternalDescription& description, const std::filesystem::path& folder) {
  Kind kind{};
  std::string method;
  Estimate estimate = read_estimate(folder, kind, method, description.frame);
  if (kind != description.kind)
    throw BadInput(fmt::format("the command wrote an estimate of kind {}, but the description {} states kind {}",
                               to_string(kind), description.file.filename().string(), to_string(description.kind)));
  return estimate;
}

void require_sizes(const AnswerBounds& bounds, ExternalDescription::Output output, const std::filesystem::path& path) {
  if (output != ExternalDescription::Output::estimate) {
    if (std::filesystem::exists(path)) bounds.require_size(path, bounds.table_bytes());
    return;
  }
  for (const std::string name : kEstimateFiles) {
    if (!std::filesystem::exists(path / name)) continue;
    bounds.require_size(path / name, name == "map.ply" ? bounds.map_memory_bytes() : bounds.table_bytes());
  }
}

AnswerBounds::Place rows_of(const std::filesystem::path& file, bool headed) {
  return [file, headed](std::size_t row) {
    std::ifstream stream(file);
    std::size_t line_number = 0, rows = headed ? row + 2 : row + 1;
    std::string line;
    while (rows > 0 && std::getline(stream, line)) {
      ++line_number;
      if (!line.empty() && line.front() != '#' && line != "\r") --rows;
    }
    return file.filename().string() + ":" + std::to_string(line_number);
  };
}

void require_sense(const AnswerBounds& bounds, const Estimate& estimate, ExternalDescription::Output output,
                   const std::filesystem::path& path) {
  const bool folder = output == ExternalDescription::Output::estimate;
  const char* const poses = estimate.attitudes.empty() ? "trajectory.tum" : "attitude.tum";
  bounds.require_unit(estimate, "seconds", rows_of(folder ? path / poses : path, false));
  bounds.require_rates(estimate.rates, rows_of(folder ? path / "rates.csv" : path, true));
  bounds.require_attitudes(estimate.attitudes, rows_of(folder ? path / "attitude.tum" : path, false));
  bounds.require_poses(estimate.poses, rows_of(folder ? path / "trajectory.tum" : path, false));
  bounds.require_slam(estimate);
}

std::vector<MapPoint> read_points(const std::filesystem::path& file) {
  const Cloud cloud = read_cloud(file);
  const auto column = [&](const char* name) { return cloud.find(name); };
  const std::array place{column("x"), column("y"), column("z")}, normal{column("nx"), column("ny"), column("nz")};
  const std::vector<double>* const sigma = column("sigma");
  const auto given = [](const auto& columns) {
    return std::ranges::all_of(columns, [](const auto* each) { return each != nullptr; });
  };
  if (!given(place))
    throw BadInput(fmt::format("{}: the file must have the columns x, y and z", file.filename().string()));
  std::vector<MapPoint> points(cloud.points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto vector = [k](const auto& columns) -> Eigen::Vector3f {
      return Eigen::Vector3d((*columns[0])[k], (*columns[1])[k], (*columns[2])[k]).cast<float>();
    };
    points[k].position_W_m = vector(place);
    if (given(normal)) points[k].normal_W = vector(normal);
    if (sigma != nullptr) points[k].sigma_m = static_cast<float>((*sigma)[k]);
  }
  return points;
}

}  // namespace

Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors) {
  const AnswerBounds bounds(sensors);
  require_sizes(bounds, description.output, output);
  Estimate estimate;
  switch (description.output) {
    case ExternalDescription::Output::rates:
      estimate.rates = read_rates(output, sensors);
      break;
    case ExternalDescription::Output::tum:
      // The unit of the time stamps is checked before parsing, because time stamps in a wrong unit can overflow the
      // integer type of times.
      bounds.require_unit(stamps_of(output), "seconds", rows_of(output, false));
      estimate = read_poses(description, output);
      break;
    case ExternalDescription::Output::estimate:
      estimate = read_folder(description, output);
      break;
  }
  if (description.kind == Kind::slam && std::filesystem::exists(map)) {
    bounds.require_size(map, bounds.map_memory_bytes());
    estimate.map = read_points(map);
  }
  require_sense(bounds, estimate, description.output, output);
  if (const std::string complaint = turning_complaint(estimate, sensors); !complaint.empty())
    throw BadInput(output.filename().string() + ": " + complaint);
  return estimate;
}

}  // namespace tumble::scenarios
