// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/export_for.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

using Json = nlohmann::ordered_json;

Json pose(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  const Eigen::Vector3d p = T.translation();
  return {{"p_m", {p.x(), p.y(), p.z()}}, {"q_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

const char* word(NumberType type) {
  switch (type) {
    case NumberType::uint8:
      return "uint8";
    case NumberType::uint16:
      return "uint16";
    case NumberType::uint32:
      return "uint32";
    case NumberType::float32:
      return "float32";
    case NumberType::float64:
      break;
  }
  return "float64";
}

std::string unit(const PointColumn& column) {
  switch (column.quantity) {
    case PointQuantity::x_m:
    case PointQuantity::y_m:
    case PointQuantity::z_m:
      return "m; positions are in the lidar's frame and not deskewed";
    case PointQuantity::intensity:
      return column.scale == 1.0 ? "0 to 1" : "0 to 255";
    case PointQuantity::ring:
      return "number of the point's ring, counted from bottom to top, or number of the point's scan line";
    case PointQuantity::time:
      break;
  }
  const std::string count = column.scale == 1.0 ? "ns" : "s";
  return count + (column.absolute ? ", counted from 1970" : ", counted from the time stamp of the message header");
}

Json fields_of(const SweepLayout& sweeps, bool timed) {
  Json out = Json::array();
  if (sweeps.livox) {
    return {
        {{"name", "offset_time"},
         {"type", "uint32"},
         {"unit", "ns after timebase; timebase equals the header's time stamp"}},
        {{"name", "x y z"}, {"type", "float32"}, {"unit", "m; positions are in the lidar's frame and not deskewed"}},
        {{"name", "reflectivity"}, {"type", "uint8"}, {"unit", "0 to 255"}},
        {{"name", "tag"},
         {"type", "uint8"},
         {"unit", "the tag of every point is 0, which means a single return with full confidence"}},
        {{"name", "line"},
         {"type", "uint8"},
         {"unit", "number of the point's ring, counted from bottom to top, or number of the point's scan line"}}};
  }
  for (const PointColumn& column : sweeps.columns) {
    if (column.quantity == PointQuantity::time && !timed) continue;
    out.push_back({{"name", column.name}, {"type", word(column.type)}, {"unit", unit(column)}});
  }
  return out;
}

Json imu_of(const ImuFacts& imu, const ReaderNames& names) {
  return {{"topic", names.imu_topic},
          {"frame", names.imu_frame},
          {"type", "sensor_msgs/Imu"},
          {"device", imu.device},
          {"samples", imu.samples},
          {"rate_hz", 1.0 / imu.period_s},
          {"gyro_unit", "rad/s"},
          {"accel_unit", "m/s^2"},
          {"accel_at_rest", "an IMU at rest measures +gravity along the upward axis"},
          {"attitude", "none: identity, covariance -1"},
          {"stamp", "the time stamp of a sample is the end of its averaging window"},
          {"gyro_noise_rad_s_sqrt_hz", imu.gyro_noise_rad_s_sqrt_hz},
          {"accel_noise_m_s2_sqrt_hz", imu.accel_noise_m_s2_sqrt_hz},
          {"stated_gyro_range_rad_s", imu.stated_gyro_range_rad_s},
          {"largest_gyro_rad_s", imu.largest_gyro_rad_s},
          {"stated_accel_range_m_s2", imu.stated_accel_range_m_s2},
          {"largest_accel_m_s2", imu.largest_accel_m_s2},
          {"still_at_start_s", imu.still_at_start_s}};
}

Json lidar_of(const LidarFacts& lidar, const ReaderNames& names, const SweepLayout& sweeps) {
  return {{"topic", names.points_topic},
          {"frame", names.lidar_frame},
          {"type", sweeps.livox ? "livox_ros_driver/CustomMsg" : "sensor_msgs/PointCloud2"},
          {"device", lidar.device},
          {"sweeps", lidar.sweeps},
          {"points", lidar.points},
          {"rate_hz", 1.0 / lidar.period_s},
          {"stamp", "the time stamp is the start of the sweep; the bag stores a sweep at the time of its last point"},
          {"order", "points are sorted by time; missing returns are left out"},
          {"fields", fields_of(sweeps, lidar.timed)},
          {"rings", lidar.rings},
          {"columns", lidar.columns},
          {"nearest_m", lidar.nearest_m},
          {"farthest_m", lidar.farthest_m},
          {"own_body_within_m", lidar.own_body_m}};
}

std::string manifest_of(const Dialect& dialect, const SensorFacts& facts, const RecordingInfo& info,
                        std::int64_t origin_ns, const std::vector<std::string>& configuration, bool with_truth) {
  const ReaderNames names = dialect.names(facts);
  Json out = {{"format", "tumble export"}, {"format_version", 1}, {"for", dialect.name}};
  out["recording"] = {{"scenario", info.scenario},
                      {"seed", info.seed},
                      {"digest", info.digest},
                      {"attribution", info.attribution},
                      {"tumble_version", info.tumble_version}};
  out["bag"] = {{"path", dialect.bag_name}, {"format", dialect.bag_format}, {"origin_ns", origin_ns}};
  if (facts.imu) out["imu"] = imu_of(*facts.imu, names);
  out["lidar"] = lidar_of(*facts.lidar, names, dialect.sweeps(facts));
  out["gravity_m_s2"] = facts.gravity_m_s2;
  out["frames"] = {{"body", names.body_frame}, {"fixed", names.fixed_frame}};
  out["extrinsics"] = {{"T_body_lidar", pose(facts.T_BL)}};
  if (facts.imu) {
    out["extrinsics"]["T_body_imu"] = pose(facts.T_BI);
    out["extrinsics"]["T_imu_lidar"] = pose(facts.T_IL());
  }
  if (with_truth) out["truth"] = {{"path", "truth.tum"}, {"of", names.body_frame}, {"clock", "clock of the bag"}};
  out["configuration"] = configuration;
  out["run"] = dialect.run;
  out["notes"] = dialect.notes;
  for (const Source& source : dialect.sources) {
    out["sources"].push_back({{"repository", source.repository}, {"path", source.path}, {"commit", source.commit}});
  }
  return out.dump(2) + "\n";
}

using std::filesystem::path;

const Dialect& dialect_of(const std::string& peer) {
  std::string known;
  for (const Dialect& dialect : all_dialects()) {
    if (dialect.name == peer) return dialect;
    known += " " + dialect.name;
  }
  const std::string near = sim::did_you_mean(peer, peer_dialects());
  throw BadInput(fmt::format("the export target '{}' is unknown{} (known targets:{})", peer,
                             near.empty() ? "" : " (" + near + ")", known));
}

void require_finite(const sim::LidarRecord& lidar, const PointStore& aside) {
  for (std::size_t number = 0; number < lidar.sweep_start_ns.size(); ++number) {
    const sim::LidarRecord sweep = sweep_alone(lidar, &aside, number);
    for (std::size_t k = 0; k < sweep.range_m.size(); ++k) {
      if (sweep.position_L_m[k].allFinite() && std::isfinite(sweep.range_m[k]) && std::isfinite(sweep.intensity[k]))
        continue;
      throw BadInput(fmt::format("point {} of lidar '{}' has a position, range or intensity that is not finite",
                                 lidar.sweep_first[number] + k, lidar.name));
    }
  }
}

void require_fitting(const Dialect& dialect, const sim::Sensors& sensors, const std::vector<PointStore>& points,
                     const SensorFacts& facts) {
  const auto refuse = [&](const std::string& what) {
    throw BadInput(fmt::format("{}; {} cannot read such a recording", what, dialect.name));
  };
  if (!facts.lidar || facts.lidar->points == 0) refuse("the recording has no lidar return");
  if (dialect.needs_imu && (!facts.imu || facts.imu->samples == 0)) refuse("the recording has no IMU reading");
  if (dialect.needs_times && !facts.lidar->timed)
    refuse(fmt::format("the points of lidar '{}' have no time stamps", sensors.lidars.front().name));
  if (dialect.needs_rings && facts.lidar->livox)
    refuse(fmt::format("the lidar '{}' does not scan in rings", facts.lidar->device));
  require_finite(sensors.lidars.front(), points.front());
}

void write_bag(const Dialect& dialect, const sim::Sensors& sensors, const BagWriting& writing, const path& place) {
  using Writer = void (*)(const sim::Sensors&, const BagWriting&, const path&);
  static const std::map<std::string, Writer> writers = {
      {"rosbag1", export_ros1_bag}, {"rosbag2", export_ros2_bag}, {"mcap", export_mcap}};
  writers.at(dialect.bag_format)(sensors, writing, place);
}

std::vector<std::string> leave_out_empty_sweeps(Dialect& dialect, LidarFacts& lidar) {
  const std::size_t empty = lidar.empty_sweeps;
  if (dialect.takes_empty || empty == 0) return {};
  lidar.sweeps -= empty;
  const std::string note =
      fmt::format("the export leaves out {}{} without points, because {} cannot read an empty cloud", empty,
                  empty == 1 ? " sweep" : " sweeps", dialect.name);
  dialect.notes.push_back(note);
  return {note};
}

}  // namespace

std::vector<std::string> peer_dialects() {
  std::vector<std::string> names;
  for (const Dialect& dialect : all_dialects()) names.push_back(dialect.name);
  return names;
}

std::vector<std::string> export_for(const path& recording, const std::string& peer, const path& folder,
                                    bool with_truth) {
  Dialect dialect = dialect_of(peer);
  const RecordingInfo info = read_info(recording);
  const path scratch = scratch_folder_of(folder);
  std::vector<PointStore> points;
  const sim::Sensors sensors = read_sensors(recording, scratch, points);
  SensorFacts facts = facts_of(sensors, &points);
  require_fitting(dialect, sensors, points, facts);
  const std::vector<std::string> notes = leave_out_empty_sweeps(dialect, *facts.lidar);

  OutputFolder output(folder);
  BagWriting writing;
  writing.origin_ns = info.origin_ns;
  writing.points = &points;
  writing.empty_sweeps = dialect.takes_empty;
  writing.names = dialect.names(facts);
  writing.sweeps = dialect.sweeps(facts);
  const std::int64_t origin_ns = export_origin_ns(info.origin_ns);
  write_bag(dialect, sensors, writing, folder / dialect.bag_name);
  if (with_truth) export_tum(read_truth(recording, scratch), folder / "truth.tum", origin_ns);
  std::vector<std::string> configuration;
  for (const ConfigurationFile& file : configuration_of(dialect, facts)) {
    replace_file(folder / file.name, file.text);
    configuration.push_back(file.name);
  }
  replace_file(folder / "manifest.json", manifest_of(dialect, facts, info, origin_ns, configuration, with_truth));
  output.keep();
  return notes;
}

}  // namespace tumble::scenarios
