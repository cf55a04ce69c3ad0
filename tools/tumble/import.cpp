// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/import.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/errors.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

struct Options {
  std::filesystem::path file, out;
  std::string format, device, robot, accel_unit;
  std::vector<double> lever_arm_m;
  double radius_m = 0.0;
};

const std::vector<std::string> kFormats = {"csv", "broad"};

std::string format_of(const Options& options) {
  if (!options.format.empty()) {
    require_known("format", options.format, kFormats);
    return options.format;
  }
  const std::string extension = options.file.extension().string();
  if (extension == ".csv") return "csv";
  if (extension == ".hdf5" || extension == ".h5") return "broad";
  throw BadInput(options.file.string() + ": --format is needed for a file named so (csv or broad)");
}

/// What the data sheet states, for a file that does not.
sim::ImuRecord described(const scenarios::DataRoot& data, const Options& options) {
  sim::ImuRecord imu;
  imu.name = "imu";
  if (!options.device.empty()) {
    const scenarios::DataSheet sheet = scenarios::load_data_sheet(data, options.device);
    if (sheet.sensor_kind != "imu")
      throw BadInput("--device " + options.device + ": is no IMU but a " + sheet.sensor_kind);
    const sim::Values values = sheet.values();
    imu.device = options.device;
    imu.stated_gyro_range_rad_s = values.at("gyro_range_rad_s");
    imu.stated_accel_range_m_s2 = values.at("accel_range_m_s2");
    imu.gyro_noise_rad_s_sqrt_hz = values.at("gyro_noise_rad_s_sqrt_hz");
    imu.accel_noise_m_s2_sqrt_hz = values.at("accel_noise_m_s2_sqrt_hz");
  }
  if (!options.lever_arm_m.empty()) {
    const bool finite = std::all_of(options.lever_arm_m.begin(), options.lever_arm_m.end(),
                                    [](double x) { return std::isfinite(x) && std::abs(x) <= 10.0; });
    if (!finite) throw BadInput("--lever-arm must be three numbers within +-10 m");
    imu.T_BI.translation() = Eigen::Vector3d::Map(options.lever_arm_m.data());
  }
  return imu;
}

/// A file that states less than the data sheet is completed from it.
void complete(const sim::ImuRecord& known, sim::ImuRecord& imu) {
  imu.device = known.device;
  imu.stated_gyro_range_rad_s = known.stated_gyro_range_rad_s;
  imu.stated_accel_range_m_s2 = known.stated_accel_range_m_s2;
  imu.gyro_noise_rad_s_sqrt_hz = known.gyro_noise_rad_s_sqrt_hz;
  imu.accel_noise_m_s2_sqrt_hz = known.accel_noise_m_s2_sqrt_hz;
}

int import_from(const Session& session, const Options& options) {
  const std::string format = format_of(options);
  const sim::ImuRecord known = described(session.data(), options);
  if (!options.accel_unit.empty()) {
    if (format != "csv") throw BadInput("--accel-unit: a trial of BROAD is in m/s^2");
    require_known("unit", options.accel_unit, std::vector<std::string>{"g", "m/s^2"});
  }
  if (!options.lever_arm_m.empty() && format != "csv")
    throw BadInput("--lever-arm: the body of a trial of BROAD is the IMU itself");
  if (options.radius_m != 0.0 && options.robot != "sphere")
    throw BadInput("--radius is the sphere's: --robot sphere is missing");
  if (!options.robot.empty()) require_known("robot", options.robot, std::vector<std::string>{"rig", "sphere"});
  scenarios::Imported imported =
      format == "csv"
          ? scenarios::import_imu_csv(options.file, known,
                                      options.accel_unit == "g" ? scenarios::AccelUnit::g : scenarios::AccelUnit::m_s2)
          : scenarios::import_broad(options.file);
  sim::ImuRecord& imu = imported.sensors.imus.front();
  if (format == "broad") complete(known, imu);
  imported.sensors.robot = options.robot;
  imported.sensors.sphere_radius_m = options.radius_m;
  imported.info.tumble_version = program_version();
  if (options.out.has_parent_path()) make_folder(options.out.parent_path());
  scenarios::write_recording(options.out, imported.info, imported.sensors,
                             imported.reference ? &*imported.reference : nullptr);

  const std::string digest = scenarios::read_info(options.out).digest;
  Table table("", {"recording", "samples", "period [ms]", "seconds", "attribution"});
  const double seconds = static_cast<double>(imu.time_ns.back() - imu.time_ns.front()) * 1e-9;
  table.add_row({options.out.string(), std::to_string(imu.time_ns.size()),
                 number_text(static_cast<double>(imu.period_ns) * 1e-6), number_text(seconds),
                 imported.info.attribution});
  session.print({table}, {{"recording", options.out.string()},
                          {"format", format},
                          {"samples", imu.time_ns.size()},
                          {"period_ns", imu.period_ns},
                          {"digest", digest},
                          {"has_reference", imported.reference.has_value()},
                          {"attribution", imported.info.attribution}});
  return kDone;
}

}  // namespace

Action declare_import(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  app.add_option("FILE", options->file,
                 "readings of an IMU: CSV with the columns of a sensor_msgs/Imu, or a trial of BROAD (HDF5), with its "
                 "optical reference")
      ->required();
  app.add_option("--format", options->format, "csv or broad [by the file's ending]");
  app.add_option("--device", options->device,
                 "its data sheet, for ranges and noise: see 'tumble list sensors' [unknown]");
  app.add_option("--accel-unit", options->accel_unit, "of a CSV: m/s^2 or g [m/s^2]");
  app.add_option("--lever-arm", options->lever_arm_m, "X Y Z: from the robot's centre of mass to the IMU, m [0 0 0]")
      ->expected(3);
  app.add_option("--robot", options->robot, "rig or sphere, for methods that ask [unknown]");
  app.add_option("--radius", options->radius_m, "of the sphere, m, for methods of position [unknown]")
      ->check(CLI::Range(1e-3, 10.0));
  app.add_option("-o,--output", options->out, "the recording, FILE.h5")->required();
  return [&session, options] { return import_from(session, *options); };
}

}  // namespace tumble::tools
