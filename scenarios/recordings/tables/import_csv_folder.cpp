// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/tables/imu_columns.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"

namespace tumble::scenarios {

namespace {

std::vector<std::filesystem::path> tables_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string imu_problem(const std::filesystem::path& file) {
  try {
    imu_columns(LoggedTable(file));
    return "";
  } catch (const BadInput& error) {
    return error.what();
  }
}

}  // namespace

Imported import_csv_folder(const std::filesystem::path& folder, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit) {
  Imported out;
  std::vector<std::string> left_out;
  for (const std::filesystem::path& file : tables_in(folder)) {
    if (is_pose_table(file)) continue;  // a pose table is a reference
    if (const std::string problem = imu_problem(file); !problem.empty()) {
      left_out.push_back(fmt::format("the import leaves out a file that is not a table of IMU readings: {}", problem));
      continue;
    }
    Imported imu = import_imu_csv(file, device, unit, gyro_unit);
    imu.sensors.imus.front().name = file.stem().string();
    if (out.sensors.imus.empty())
      out = std::move(imu);
    else
      attach_imus(out, std::move(imu));
  }
  if (out.sensors.imus.empty())
    throw BadInput(fmt::format("{}: the folder must contain a table of IMU readings, but contains none{}",
                               folder.string(), (left_out.empty() ? "" : "; " + left_out.front())));
  if (out.sensors.imus.size() > 1)
    out.notes.push_back(
        fmt::format("IMU '{}' is the primary IMU, because its file comes first. Tables do not state the poses of the "
                    "IMUs on the body, "
                    "so all IMUs are assumed at the same position with the same axes. To use one IMU, import its file",
                    out.sensors.imus.front().name));
  out.notes.insert(out.notes.end(), left_out.begin(), left_out.end());
  return out;
}

}  // namespace tumble::scenarios
