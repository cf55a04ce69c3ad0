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
      // NaN has a separate error message, because tables show NaN as a dash.
      throw BadInput(
          fmt::format("{0}: {1:g} is out of range; each number must be from -{2:g} to {2:g}", option, x, bound));
    }
  }
}

}  // namespace

Eigen::Isometry3d pose_of(const std::string& option, const std::vector<double>& numbers) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (numbers.empty()) return pose;
  require_numbers(option, numbers, 100.0);
  const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-2)) {
    throw BadInput(fmt::format("{}: the quaternion (qx qy qz qw) has norm {:g}; the norm must be 1", option, q.norm()));
  }
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

namespace {

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
  if (!options.out.empty()) reading.scratch = options.out.parent_path().empty() ? "." : options.out.parent_path();
  return reading;
}

void declare_lidar(VerbOptions& verb, ImportOptions& options) {
  verb.add("--lidar", options.lidar,
           "names the data sheet of the lidar ('tumble list sensors' lists the sheets) [default: unknown; odometry "
           "detects the lidar]");
  verb.add(
          "--T-body-lidar", options.T_body_lidar,
          "sets the pose of the lidar in the body frame: X Y Z in m, then the quaternion QX QY QZ QW. The origin of "
          "the body frame is the centre of mass. The axes of the body frame are the axes of 'body' or 'base_link' in "
          "/tf_static; without these frames, the axes of the IMU [default: the pose in /tf_static, otherwise identity]")
      .words(7);
  verb.add("--imu-minus-lidar-clock", options.imu_minus_lidar_clock_s,
           "adds this time to the time stamps of all sweeps, s [default: 0; mapping estimates offsets of a few ms]")
      .within(-1e6, 1e6);
  verb.add("--stem", options.stem,
           "selects one lidar in a folder of several lidars: the file names of its sweeps are this text, followed by a "
           "number");
  verb.add("--times", options.times,
           "reads the time stamps of the sweeps or poses from this file: one time stamp per line, in s or as a date in "
           "UTC [default: STEM_times.txt or times.txt in the folder of the sweeps; without such a file, the file "
           "names, then the times of the points]");
  verb.add("--sweep-period", options.sweep_period_s,
           "sets the duration of a sweep, s. If the sweeps have no time stamps, this duration is also the time between "
           "sweeps [default: median time between sweeps]")
      .within(1e-4, 1000.0);
  verb.add("--bin-columns", options.bin_columns,
           "lists the columns of .bin files in order, for example x,y,z,intensity,ring. A column is float32, or has "
           "its type after a colon, for example x:f8; the types are f4 f8 u1 u2 u4 u8 i1 i2 i4 i8. The name _ skips a "
           "column [default: x,y,z,intensity]");
  verb.add("--time-field", options.time_field,
           "names the field that contains the times of the points [default: t, time, timestamp, offset_time or a "
           "similar name]");
  verb.add("--time-unit", options.time_unit,
           "sets the unit of the times of the points: s, ms, us or ns [default: detected from the values]");
  verb.add_flag("--not-skewed", options.not_skewed,
                "states that the sweeps are already deskewed, so that all points of a sweep belong to one instant");
  verb.add("--imu", options.imu,
           "adds the IMU readings in this FILE.csv, which must have the same clock as the sweeps");
}

void declare_reference(VerbOptions& verb, ImportOptions& options) {
  verb.add("--reference", options.reference,
           "uses the poses in this file as truth. A TUM file, or a table with named columns (EuRoC ground truth, "
           "nav_msgs/Odometry), must use the clock of the sensors. A KITTI file must have one pose per sweep [default: "
           "trajectory.csv in a folder of VTK sweeps, truth.csv in a folder of CSV tables]");
  verb.add("--reference-frame", options.reference_frame,
           "sets the frame of the reference poses: lidar or body [default for a file: lidar if the recording has a "
           "lidar; default for a topic: the frame named in the messages, else body]");
  verb.add("--reference-topic", options.reference_topic,
           "uses the poses of this topic of a bag as truth: nav_msgs/Odometry, geometry_msgs/PoseStamped or "
           "geometry_msgs/TransformStamped [default: no truth]");
  verb.add_flag(
      "--sort", options.sorted,
      "accepts the lines of a TUM file in any order. If several lines have equal time stamps, uses the first line");
}

}  // namespace

void declare_sensors(VerbOptions& verb, ImportOptions& options) {
  verb.add(
          "PATH", options.path,
          "reads this file or folder. Lidar sweeps can be PLY, PCD, VTK or KITTI .bin files. IMU readings can be a "
          "CSV file of a logger or of sensor_msgs/Imu, or the folder of a CSV export. A bag can be a ROS 1 file or a "
          "folder of its parts, a ROS 2 folder, or an MCAP file. Poses can be a TUM file, a KITTI file, or a table "
          "with named columns such as EuRoC's ground truth. 'tumble odometry' and 'tumble doctor' also read recordings "
          "of tumble (.h5)")
      .required();
  verb.add("--format", options.format,
           "sets the format of the input: csv, kitti, mcap, odometry, pcd, ply, rosbag1, rosbag2, tum or vtk [default: "
           "detected from extension or content]");
  verb.add("--device", options.device,
           "names the data sheet of the IMU, which states ranges and noise ('tumble list sensors' lists the sheets) "
           "[default: unknown; 'tumble odometry' searches the topic for the name of a data sheet]");
  verb.add("--accel-unit", options.accel_unit,
           "sets the unit of the accelerometer in a CSV file or bag: m/s^2 or g [default: m/s^2; for a bag g, if the "
           "readings at rest indicate g]");
  verb.add("--gyro-unit", options.gyro_unit,
           "sets the unit of the gyro in a CSV file or bag: rad/s or deg/s [default: rad/s]");
  verb.add("--columns", options.columns,
           "names the columns of IMU readings in a CSV file: time=NAME,gyro=X,Y,Z,accel=X,Y,Z with names from the "
           "header, or with positions counted from 0 [default: common names]");
  verb.add("--lever-arm", options.lever_arm_m,
           "sets the lever arm X Y Z from the robot's centre of mass to the first IMU in body axes, m [default: from "
           "/tf_static, else 0 0 0]. Without /tf_static, the body axes are the IMU's axes")
      .words(3);
  verb.add("--imu-topic", options.imu_topics,
           "imports this IMU topic of a bag (sensor_msgs/Imu); the first topic is the primary IMU [default: all IMU "
           "topics]");
  verb.add("--lidar-topic", options.lidar_topics,
           "imports this lidar topic of a bag (sensor_msgs/PointCloud2); mapping methods use only the first topic "
           "[default: all lidar topics; topics whose points have times come first]");
  verb.add("--stamps", options.stamps,
           "selects the time stamps of a bag. 'header' uses the stamps in the message headers. 'record' uses the times "
           "at which the messages were recorded; use 'record' if the headers have no usable stamps. With 'record', a "
           "sweep starts one sweep period before its stamp [default: header]");
  declare_lidar(verb, options);
}

void declare(VerbOptions& verb, ImportOptions& options) {
  declare_sensors(verb, options);
  verb.add("--robot", options.robot,
           "states the type of robot, which some methods need: rig, sphere or pendulum [default: unknown]");
  verb.add("--radius", options.radius_m,
           "states the radius of the sphere in m; position methods need the radius [default: unknown]")
      .within(1e-3, 10.0);
  declare_reference(verb, options);
  verb.add("-o,--output", options.out, "writes this recording, FILE.h5").required();
}

void require_fitting(const ImportOptions& options, const std::string& format) {
  const bool bag = is_bag(format), csv = format == "csv" || !options.imu.empty();
  const bool sweeps = is_sweeps(format) && (format != "kitti" || std::filesystem::is_directory(options.path));
  const auto refuse = [&](bool given, const std::string& option, const std::string& why) {
    if (given) throw scenarios::WrongOption(option + ": " + why);
  };
  refuse(!options.accel_unit.empty() && !csv && !bag, "--accel-unit",
         "this option applies only to IMU readings in a CSV file or bag");
  refuse(!options.gyro_unit.empty() && !csv && !bag, "--gyro-unit",
         "this option applies only to IMU readings in a CSV file or bag");
  refuse(!options.columns.empty() && (!csv || (format == "csv" && std::filesystem::is_directory(options.path))),
         "--columns", "this option applies only to a CSV file with IMU readings");
  refuse(!options.base_frame.empty() && !bag, "--base-frame",
         "this option applies only to a bag with /tf_static; use --T-base-imu");
  refuse(!options.stamps.empty() && !bag, "--stamps", "this option applies only to a bag");
  refuse(!options.lever_arm_m.empty() && !csv && !bag, "--lever-arm",
         "this option applies only to an IMU in a CSV file or bag");
  refuse(!options.device.empty() && !csv && !bag, "--device",
         "this option applies only to an IMU; use --lidar for a lidar");
  refuse(!options.imu.empty() && !sweeps, "--imu", "this option applies only to a folder of sweeps");
  refuse(!options.stem.empty() && !sweeps, "--stem", "this option applies only to a folder of sweeps");
  refuse(!options.bin_columns.empty() && (!sweeps || format != "kitti"), "--bin-columns",
         "this option applies only to a folder of .bin sweeps");
  const bool lidar = !options.lidar.empty() || !options.T_body_lidar.empty() || !options.time_field.empty() ||
                     options.imu_minus_lidar_clock_s != 0.0 || !options.time_unit.empty() || options.not_skewed;
  refuse(lidar && !sweeps && !bag,
         "--lidar --T-body-lidar --imu-minus-lidar-clock --time-field --time-unit --not-skewed",
         "these options apply only to a folder of sweeps or a bag");
  refuse(!options.times.empty() && !sweeps && format != "kitti", "--times",
         "this option applies only to a folder of sweeps or to KITTI poses");
  refuse(options.sweep_period_s > 0.0 && !sweeps && !bag && format != "kitti", "--sweep-period",
         "this option applies only to sweeps or to KITTI poses");
  refuse(!options.reference.empty() && !sweeps && !bag && format != "csv", "--reference",
         "this option applies only to sweeps, a bag or IMU readings");
  const bool topics = !options.imu_topics.empty() || !options.lidar_topics.empty() || !options.reference_topic.empty();
  refuse(topics && !bag, "--imu-topic --lidar-topic --reference-topic", "these options apply only to a bag");
  refuse(!options.reference.empty() && !options.reference_topic.empty(), "--reference",
         "this option and --reference-topic exclude each other; give only one");
  refuse(options.radius_m != 0.0 && options.robot != "sphere", "--radius",
         "this option applies only to a sphere; add --robot sphere");
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
  reading.stamps_stated = !options.stamps.empty();
  if (reading.stamps_stated) {
    require_known("stamps", options.stamps, std::vector<std::string>{"header", "record"});
    if (options.stamps == "record") reading.stamps = scenarios::StampSource::record;
  }
  reading.sweeps = sweep_reading(session, options);
  reading.for_odometry = options.for_odometry;
  reading.base_frame = options.base_frame;
  return reading;
}

const char* point_times_word(sim::PointTimes times) {
  return times == sim::PointTimes::measured ? "measured" : times == sim::PointTimes::unknown ? "unknown" : "not_skewed";
}

}  // namespace tumble::tools
