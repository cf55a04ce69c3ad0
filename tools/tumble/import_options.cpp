// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/import_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/regular_file.hpp"
#include "tools/tumble/arguments.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

bool is_bag(const std::string& format) {
  return format == "mcap" || format.starts_with("rosbag");
}

bool is_sweeps(const std::string& format) {
  return format == "ply" || format == "pcd" || format == "vtk" || format == "kitti";
}

void require_numbers(const std::string& option, const std::vector<double>& numbers, double bound) {
  for (const double x : numbers) {
    if (!(std::abs(x) <= bound)) {
      // NaN is reported with a separate message, because NaN appears in tables as a dash
      throw BadInput(fmt::format("{}: {:g} must be within +-{:g}", option, x, bound));
    }
  }
}

/// Converts seven numbers x y z qx qy qz qw to a pose.
Eigen::Isometry3d pose_of(const std::string& option, const std::vector<double>& numbers) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (numbers.empty()) return pose;
  require_numbers(option, numbers, 100.0);
  const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-2)) {
    throw BadInput(fmt::format("{}: the quaternion (qx qy qz qw) has norm {:g}, must be 1", option, q.norm()));
  }
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

std::int64_t period_ns(double period_s) {
  return std::llround(period_s * 1e9);
}

scenarios::DataSheet sheet_of(const Session& session, const std::string& option, const std::string& device,
                              const std::string& ending) {
  scenarios::DataSheet sheet = scenarios::load_data_sheet(session.data(), device);
  if (!sheet.sensor_kind.ends_with(ending))
    throw BadInput(option + " " + device + ": is no " + ending + " but a " + sheet.sensor_kind);
  return sheet;
}

sim::LidarRecord lidar_sheet(const Session& session, const ImportOptions& options) {
  sim::LidarRecord lidar;
  lidar.name = "lidar";
  lidar.T_BL = pose_of("--T-body-lidar", options.T_body_lidar);
  lidar.sweep_period_ns = period_ns(options.sweep_period_s);
  if (options.lidar.empty()) return lidar;
  const sim::Values values = sheet_of(session, "--lidar", options.lidar, "lidar").values();
  lidar.device = options.lidar;
  if (lidar.sweep_period_ns > 0) return lidar;
  const bool spins = values.has("spin_rate_hz");
  lidar.sweep_period_ns = period_ns(spins ? 1.0 / values.at("spin_rate_hz") : values.at("sweep_period_s"));
  return lidar;
}

scenarios::SweepReading sweep_reading(const Session& session, const ImportOptions& options) {
  scenarios::SweepReading reading;
  reading.device = lidar_sheet(session, options);
  if (!options.lidar.empty()) {
    const sim::Values values = sheet_of(session, "--lidar", options.lidar, "lidar").values();
    if (values.has("range_max_m")) reading.range_max_m = values.at("range_max_m");
  }
  reading.time_field = options.time_field;
  reading.time_unit = options.time_unit;
  reading.not_skewed = options.not_skewed;
  // without an output file, the points are kept in memory
  if (!options.out.empty()) reading.scratch = options.out.parent_path().empty() ? "." : options.out.parent_path();
  return reading;
}

void declare_lidar(VerbOptions& verb, ImportOptions& options) {
  verb.add("--lidar", options.lidar, "name of the lidar's data sheet, for sweeps [unknown]");
  verb.add("--T-body-lidar", options.T_body_lidar, "X Y Z QX QY QZ QW: pose of the lidar in the body, m [identity]")
      .words(7);
  verb.add("--stem", options.stem,
           "start of the file names before their number, if the folder contains several series");
  verb.add("--times", options.times,
           "file with one time stamp per line for each sweep or pose, s or a date in UTC [STEM_times.txt or times.txt "
           "in the folder of "
           "the sweeps, else the file names, else the times of the points]");
  verb.add("--sweep-period", options.sweep_period_s,
           "duration of a sweep, s; without time stamps also the time between sweeps [median step]")
      .within(1e-4, 1000.0);
  verb.add("--bin-columns", options.bin_columns,
           "columns of .bin files in order, for example x,y,z,intensity,ring; each is float32 or has its type after a "
           "colon (f4 f8 u1 u2 u4 u8 i1 i2 i4 i8: x:f8); _ skips a column [x,y,z,intensity]");
  verb.add("--time-field", options.time_field,
           "field with the times of the points [t, time, timestamp, offset_time ...]");
  verb.add("--time-unit", options.time_unit, "unit of that field: s, ms, us or ns [detected from the values]");
  verb.add_flag("--not-skewed", options.not_skewed,
                "the sweeps are already deskewed: all points belong to one instant");
  verb.add("--imu", options.imu, "FILE.csv with IMU readings in the clock of the sweeps");
}

void declare_reference(VerbOptions& verb, ImportOptions& options) {
  verb.add("--reference", options.reference,
           "poses that serve as truth: a TUM file or a table of poses with named columns (EuRoC ground truth, "
           "nav_msgs/Odometry) in the clock of the sensors, or a KITTI file with one pose per sweep [trajectory.csv in "
           "the folder of VTK sweeps, truth.csv in a folder of CSV tables]");
  verb.add("--reference-frame", options.reference_frame,
           "frame of the reference poses: lidar or body [file: lidar if there is one; topic: the frame named in its "
           "messages, else body]");
  verb.add("--reference-topic", options.reference_topic,
           "topic of a bag with poses that serve as truth: nav_msgs/Odometry, geometry_msgs/PoseStamped or "
           "geometry_msgs/TransformStamped [none]");
  verb.add_flag(
      "--align-reference", options.align_reference,
      "repoimu: removes delay, rotation and tilt of the reference, as estimated from the motion [only reported]");
  verb.add_flag("--sort", options.sorted,
                "accepts lines of a TUM file in any order; of equal stamps the first is used");
}

}  // namespace

void declare_sensors(VerbOptions& verb, ImportOptions& options) {
  verb.add(
          "PATH", options.path,
          "file or folder to import: lidar sweeps (PLY, PCD, VTK, KITTI .bin); IMU readings (CSV of a logger or of "
          "sensor_msgs/Imu, or the folder of a CSV export, BROAD HDF5 or RepoIMU CSV with optical reference, "
          "AirbrakesV2 flight log); a bag (ROS 1 file or folder of its parts, ROS 2 folder, MCAP file); or poses (TUM, "
          "KITTI, a table with named columns such as EuRoC's ground truth)")
      .required();
  verb.add("--format", options.format,
           "airbrakes, broad, csv, kitti, mcap, odometry, pcd, ply, repoimu, rosbag1, rosbag2, tum or vtk [from "
           "extension or content]");
  verb.add("--device", options.device,
           "name of the IMU's data sheet, for ranges and noise; see 'tumble list sensors' [unknown]");
  verb.add(
      "--accel-unit", options.accel_unit,
      "unit of the accelerometer in a CSV or bag: m/s^2 or g [m/s^2; for a bag g if the readings at rest indicate it]");
  verb.add("--gyro-unit", options.gyro_unit, "unit of the gyro in a CSV or bag: rad/s or deg/s [rad/s]");
  verb.add("--columns", options.columns,
           "columns of IMU readings in a CSV file: time=NAME,gyro=X,Y,Z,accel=X,Y,Z with the names in the header, or "
           "positions from 0 [known names]");
  verb.add("--lever-arm", options.lever_arm_m, "X Y Z: vector from the robot's centre of mass to the IMU, m [0 0 0]")
      .words(3);
  verb.add("--imu-topic", options.imu_topics,
           "IMU topic of a bag (sensor_msgs/Imu); the first is the primary IMU [all]");
  verb.add("--lidar-topic", options.lidar_topics,
           "lidar topic of a bag (sensor_msgs/PointCloud2); methods map with the first [all, topics whose points have "
           "times first]");
  verb.add("--stamps", options.stamps,
           "time stamps of a bag: 'header' from the messages; 'record' from the bag, if headers have no usable stamps; "
           "with 'record' a sweep starts one period earlier [header]");
  declare_lidar(verb, options);
}

void declare(VerbOptions& verb, ImportOptions& options) {
  declare_sensors(verb, options);
  verb.add("--robot", options.robot, "type of robot: rig, sphere or pendulum; some methods need it [unknown]");
  verb.add("--radius", options.radius_m, "radius of the sphere, m; position methods need it [unknown]")
      .within(1e-3, 10.0);
  declare_reference(verb, options);
  verb.add("-o,--output", options.out, "recording to write, FILE.h5").required();
}

void require_fitting(const ImportOptions& options, const std::string& format) {
  const bool bag = is_bag(format), csv = format == "csv" || !options.imu.empty();
  const bool log = format == "repoimu" || format == "airbrakes";
  const bool sweeps = is_sweeps(format) && (format != "kitti" || std::filesystem::is_directory(options.path));
  const auto refuse = [&](bool given, const std::string& option, const std::string& why) {
    if (given) throw BadInput(option + ": " + why);
  };
  refuse(!options.accel_unit.empty() && !csv && !bag, "--accel-unit",
         "applies only to IMU readings in a CSV file or bag");
  refuse(!options.gyro_unit.empty() && !csv && !bag, "--gyro-unit",
         "applies only to IMU readings in a CSV file or bag");
  refuse(!options.columns.empty() && (!csv || (format == "csv" && std::filesystem::is_directory(options.path))),
         "--columns", "applies only to a CSV file with IMU readings");
  refuse(!options.stamps.empty() && !bag, "--stamps", "applies only to a bag");
  refuse(options.align_reference && format != "repoimu", "--align-reference", "applies only to a RepoIMU recording");
  refuse(!options.reference.empty() && log, "--reference",
         format == "repoimu" ? "a RepoIMU recording contains its own reference" : "does not apply to a flight log");
  refuse(!options.lever_arm_m.empty() && !csv && !bag, "--lever-arm",
         format == "broad" || log ? "the body of such a recording is the IMU itself"
                                  : "applies only to an IMU in a CSV file or bag");
  refuse(!options.device.empty() && !csv && !bag && !log && format != "broad", "--device",
         "applies only to an IMU; use --lidar for a lidar");
  refuse(!options.imu.empty() && !sweeps, "--imu", "applies only to a folder of sweeps");
  refuse(!options.stem.empty() && !sweeps, "--stem", "applies only to a folder of sweeps");
  refuse(!options.bin_columns.empty() && (!sweeps || format != "kitti"), "--bin-columns",
         "applies only to a folder of .bin sweeps");
  const bool lidar = !options.lidar.empty() || !options.T_body_lidar.empty() || !options.time_field.empty() ||
                     !options.time_unit.empty() || options.not_skewed;
  refuse(lidar && !sweeps && !bag, "--lidar --T-body-lidar --time-field --time-unit --not-skewed",
         "apply only to a folder of sweeps or a bag");
  refuse(!options.times.empty() && !sweeps && format != "kitti", "--times",
         "applies only to a folder of sweeps or poses of KITTI");
  refuse(options.sweep_period_s > 0.0 && !sweeps && !bag && format != "kitti", "--sweep-period",
         "applies only to sweeps or poses of KITTI");
  refuse(!options.reference.empty() && !sweeps && !bag && format != "csv", "--reference",
         "applies only to sweeps, a bag or IMU readings");
  const bool topics = !options.imu_topics.empty() || !options.lidar_topics.empty() || !options.reference_topic.empty();
  refuse(topics && !bag, "--imu-topic --lidar-topic --reference-topic", "apply only to a bag");
  refuse(!options.reference.empty() && !options.reference_topic.empty(), "--reference",
         "and --reference-topic exclude each other; give only one");
  refuse(options.radius_m != 0.0 && options.robot != "sphere", "--radius",
         "applies only to a sphere; add --robot sphere");
  if (!options.robot.empty())
    require_known("robot", options.robot, std::vector<std::string>{"rig", "sphere", "pendulum"});
  if (!options.reference_frame.empty())
    require_known("frame", options.reference_frame, std::vector<std::string>{"lidar", "body"});
}

sim::ImuRecord imu_sheet(const Session& session, const ImportOptions& options) {
  sim::ImuRecord imu;
  imu.name = "imu";
  if (!options.device.empty()) {
    const sim::Values values = sheet_of(session, "--device", options.device, "imu").values();
    imu.device = options.device;
    imu.stated_gyro_range_rad_s = values.at("gyro_range_rad_s");
    imu.stated_accel_range_m_s2 = values.at("accel_range_m_s2");
    imu.gyro_noise_rad_s_sqrt_hz = values.at("gyro_noise_rad_s_sqrt_hz");
    imu.accel_noise_m_s2_sqrt_hz = values.at("accel_noise_m_s2_sqrt_hz");
  }
  if (!options.lever_arm_m.empty()) {
    require_numbers("--lever-arm", options.lever_arm_m, 10.0);
    imu.T_BI.translation() = Eigen::Vector3d::Map(options.lever_arm_m.data());
  }
  return imu;
}

void complete(const sim::ImuRecord& sheet, sim::ImuRecord& imu) {
  imu.device = sheet.device;
  imu.stated_gyro_range_rad_s = sheet.stated_gyro_range_rad_s;
  imu.stated_accel_range_m_s2 = sheet.stated_accel_range_m_s2;
  imu.gyro_noise_rad_s_sqrt_hz = sheet.gyro_noise_rad_s_sqrt_hz;
  imu.accel_noise_m_s2_sqrt_hz = sheet.accel_noise_m_s2_sqrt_hz;
}

scenarios::AccelUnit accel_unit(const ImportOptions& options) {
  if (!options.accel_unit.empty()) require_known("unit", options.accel_unit, std::vector<std::string>{"g", "m/s^2"});
  return options.accel_unit == "g" ? scenarios::AccelUnit::g : scenarios::AccelUnit::m_s2;
}

scenarios::GyroUnit gyro_unit(const ImportOptions& options) {
  if (options.gyro_unit.empty()) return scenarios::GyroUnit::rad_s;
  require_known("gyro unit", options.gyro_unit, std::vector<std::string>{"rad/s", "deg/s"});
  return options.gyro_unit == "deg/s" ? scenarios::GyroUnit::deg_s : scenarios::GyroUnit::rad_s;
}

scenarios::SweepSource sweep_source(const Session& session, const ImportOptions& options, const std::string& format) {
  scenarios::SweepSource source;
  source.folder = options.path;
  source.format = format;
  source.stem = options.stem;
  source.times = options.times;
  source.steady_ns = period_ns(options.sweep_period_s);
  source.bin_columns = options.bin_columns;
  source.reading = sweep_reading(session, options);
  return source;
}

std::filesystem::path reference_file(const ImportOptions& options, const std::string& format) {
  if (!options.reference.empty() || (format != "vtk" && format != "csv")) return options.reference;
  const std::filesystem::path beside = options.path / (format == "vtk" ? "trajectory.csv" : "truth.csv");
  return scenarios::is_pose_table(beside) ? beside : options.reference;
}

scenarios::ReferenceSource reference_source(const ImportOptions& options, const std::filesystem::path& file,
                                            bool has_lidar) {
  scenarios::ReferenceSource source;
  source.file = file;
  source.format = scenarios::pose_format(file);
  source.of_body = options.reference_frame.empty() ? !has_lidar : options.reference_frame == "body";
  source.sorted = options.sorted;
  return source;
}

scenarios::ReferenceSource trajectory_source(const ImportOptions& options, const std::string& format) {
  scenarios::ReferenceSource source;
  source.file = options.path;
  source.format = format;
  source.of_body = true;
  source.sorted = options.sorted;
  source.times = options.times;
  source.steady_ns = period_ns(options.sweep_period_s);
  return source;
}

scenarios::BagReading bag_reading(const Session& session, const ImportOptions& options) {
  scenarios::BagReading reading;
  reading.imu_topics = options.imu_topics;
  reading.lidar_topics = options.lidar_topics;
  reading.reference_topic = options.reference_topic;
  if (!options.reference_frame.empty()) {
    const bool of_lidar = options.reference_frame == "lidar";
    reading.reference_of = of_lidar ? scenarios::ReferenceOf::lidar : scenarios::ReferenceOf::body;
  }
  reading.imu = imu_sheet(session, options);
  reading.imu_placed = !options.lever_arm_m.empty();
  reading.lidar_placed = !options.T_body_lidar.empty();
  if (!options.accel_unit.empty()) reading.accel_unit = accel_unit(options);
  reading.gyro_unit = gyro_unit(options);
  if (!options.stamps.empty()) {
    require_known("stamps", options.stamps, std::vector<std::string>{"header", "record"});
    if (options.stamps == "record") reading.stamps = scenarios::StampSource::record;
  }
  reading.sweeps = sweep_reading(session, options);
  reading.leave_out_topics = options.leave_out_topics;
  return reading;
}

const char* point_times_word(sim::PointTimes times) {
  return times == sim::PointTimes::measured ? "measured" : times == sim::PointTimes::unknown ? "unknown" : "not_skewed";
}

}  // namespace tumble::tools
