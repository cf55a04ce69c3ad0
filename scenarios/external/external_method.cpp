// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/external_method.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/external/external_description.hpp"
#include "scenarios/external/external_result.hpp"
#include "scenarios/external/python_method.hpp"
#include "scenarios/processes/command.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/recordings/scratch_file.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

struct Provision {
  const char* placeholder;
  const char* name;  ///< name in the scratch folder
  std::function<void(const sim::Sensors&, const fs::path&)> write;
};

const std::vector<Provision>& provisions() {
  static const std::vector<Provision> all = {
      {"recording", "recording.h5",
       [](const sim::Sensors& sensors, const fs::path& to) { write_recording(to, {}, sensors, nullptr); }},
      {"csv", "csv", [](const sim::Sensors& sensors, const fs::path& to) { export_csv(sensors, nullptr, to); }},
      {"ply", "ply", [](const sim::Sensors& sensors, const fs::path& to) { export_ply(sensors, to); }},
      {"pcd", "pcd", [](const sim::Sensors& sensors, const fs::path& to) { export_pcd(sensors, to); }},
      {"rosbag1", "recording.bag",
       [](const sim::Sensors& sensors, const fs::path& to) {
         export_ros1_bag(sensors, {kExportOrigin_ns, nullptr}, to);
       }},
      {"rosbag2", "rosbag2",
       [](const sim::Sensors& sensors, const fs::path& to) {
         export_ros2_bag(sensors, {kExportOrigin_ns, nullptr}, to);
       }},
      {"mcap", "recording.mcap",
       [](const sim::Sensors& sensors, const fs::path& to) {
         export_mcap(sensors, {kExportOrigin_ns, nullptr}, to);
       }},
      {"sensors", "sensors.json",
       [](const sim::Sensors& sensors, const fs::path& to) { replace_file(to, sensors_text(sensors)); }},
  };
  return all;
}

std::set<std::string> named_in(const std::vector<std::string>& words) {
  std::set<std::string> out;
  for (const std::string& word : words)
    for (std::string& name : placeholders_in(word)) out.insert(std::move(name));
  return out;
}

std::map<std::string, std::string> places(const ExternalDescription& description, const fs::path& scratch) {
  const bool folder = description.output == ExternalDescription::Output::estimate;
  const bool rates = description.output == ExternalDescription::Output::rates;
  std::map<std::string, std::string> out = {{"output", scratch / (folder  ? "estimate"
                                                                  : rates ? "rates.csv"
                                                                          : "poses.tum")},
                                            {"map", scratch / "map.ply"},
                                            {"folder", description.file.parent_path()}};
  for (const Provision& provision : provisions()) out[provision.placeholder] = scratch / provision.name;
  return out;
}

Command command_of(const ExternalDescription& description, const std::vector<std::string>& words,
                   const std::map<std::string, std::string>& values, const fs::path& scratch) {
  Command command{.words = {},
                  .folder = scratch,
                  .environment = description.environment,
                  .transcript = scratch / "transcript.txt",
                  .time_limit_s = description.time_limit_s,
                  .memory_limit_mib = description.memory_limit_mib};
  for (const std::string& word : words) command.words.push_back(filled(word, values));
  return command;
}

CommandEnd provide_and_run(const ExternalDescription& description, const sim::Sensors& sensors,
                           const std::map<std::string, std::string>& values, const fs::path& scratch) {
  const std::set<std::string> wanted = named_in(description.command);
  for (const Provision& provision : provisions())
    if (wanted.contains(provision.placeholder)) provision.write(sensors, values.at(provision.placeholder));
  return run_command(command_of(description, description.command, values, scratch));
}

Estimate run_its_command(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript) {
  const ScratchFolder scratch("method");
  const std::map<std::string, std::string> values = places(description, scratch.path());
  return without_folder(scratch.path(), [&] {
    const CommandEnd end = provide_and_run(description, sensors, values, scratch.path());
    transcript = end.transcript;
    require_done(end);
    try {
      return read_external_result(description, values.at("output"), values.at("map"), sensors);
    } catch (const BadInput& error) {
      throw BadInput(with_output_tail(error.what(), end));
    }
  });
}

Estimate run(const ExternalDescription& description, const sim::Sensors& sensors) {
  std::string transcript;
  try {
    Estimate estimate = description.python.empty() ? run_its_command(description, sensors, transcript)
                                                   : call_python(description, sensors, transcript);
    estimate.transcript = std::move(transcript);
    return estimate;
  } catch (const NoAnswer& error) {
    throw NoAnswer(error.why(), error.what(), std::move(transcript));
  } catch (const BadInput& error) {
    throw RefusedAnswer(error.what(), std::move(transcript));
  }
}

std::string version_of(const ExternalDescription& description) {
  const std::string own = "description " + description.digest;
  if (!description.python.empty()) return python_version(description) + "; " + own;
  if (description.version.empty()) return own;
  const ScratchFolder scratch("method");
  const Command command =
      command_of(description, description.version, places(description, scratch.path()), scratch.path());
  return reported_version(command, description.file.string() + ": its version command: ") + "; " + own;
}

}  // namespace

Method external_method(const std::filesystem::path& file, double time_limit_s) {
  ExternalDescription description = read_external(file);
  description.time_limit_s = std::min(description.time_limit_s, time_limit_s);
  MethodInfo info;
  info.name = description.name;
  info.kind = description.kind;
  info.doc = description.doc;
  info.source = description.source;
  info.robots = description.robots;
  info.version = version_of(description);
  return {std::move(info), [description](const sim::Sensors& sensors, const sim::Values& given, const OracleInput&) {
            sim::resolve("method " + description.name, given, {});
            try {
              return run(description, sensors);
            } catch (const std::system_error& error) {
              throw NoAnswer(NoAnswer::Why::machine, error.what());
            }
          }};
}

namespace {

constexpr double kVersionLimit_s = 30.0;
constexpr std::size_t kFirstLineMax = 120;

}  // namespace

std::string without_trailing_folder(std::string text, const std::filesystem::path& folder) {
  const std::string whole = folder.string();
  for (std::size_t at = 0; !whole.empty() && (at = text.find(whole, at)) != std::string::npos;) {
    const bool within = at + whole.size() < text.size() && text[at + whole.size()] == '/';
    text.replace(at, whole.size() + (within ? 1 : 0), within ? "" : ".");
  }
  return text;
}

std::string with_output_tail(const std::string& what, const CommandEnd& end) {
  return end.output_tail.empty() ? what
                                 : fmt::format("{}; the last output of the command is: {}", what, end.output_tail);
}

void require_done(const CommandEnd& end) {
  if (end.how == CommandEnd::How::done) return;
  if (end.how == CommandEnd::How::timed_out)
    throw NoAnswer(
        NoAnswer::Why::timed_out,
        with_output_tail(
            fmt::format("{}; to change the limit, set the key time_limit_s in the method's description", end.reason),
            end));
  throw NoAnswer(NoAnswer::Why::crashed, with_output_tail(end.reason, end));
}

std::string reported_version(Command command, const std::string& place) {
  command.time_limit_s = kVersionLimit_s;
  const CommandEnd end = run_command(command);
  if (end.how != CommandEnd::How::done) throw BadInput(place + with_output_tail(end.reason, end));
  const std::string transcript = read_text_file(command.transcript);
  if (transcript.empty())
    throw BadInput(
        fmt::format("{}the version command printed nothing; it must print a text that identifies this version", place));
  return fmt::format("{}; the digest of the complete output is {:016x}",
                     transcript.substr(0, std::min(transcript.find('\n'), kFirstLineMax)),
                     XXH3_64bits(transcript.data(), transcript.size()));
}

namespace {

using nlohmann::json;

json mounting(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.rotation());
  const Eigen::Vector3d p = T.translation();
  return {{"translation_m", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

json imu(const sim::ImuRecord& record) {
  return {{"name", record.name},
          {"device", record.device},
          {"period_ns", record.period_ns},
          {"samples", record.time_ns.size()},
          {"stated_gyro_range_rad_s", record.stated_gyro_range_rad_s},
          {"stated_accel_range_m_s2", record.stated_accel_range_m_s2},
          {"gyro_noise_rad_s_sqrt_hz", record.gyro_noise_rad_s_sqrt_hz},
          {"accel_noise_m_s2_sqrt_hz", record.accel_noise_m_s2_sqrt_hz},
          {"T_BI", mounting(record.T_BI)}};
}

json lidar(const sim::LidarRecord& record) {
  return {{"name", record.name},
          {"device", record.device},
          {"sweep_period_ns", record.sweep_period_ns},
          {"sweeps", record.sweep_start_ns.size()},
          {"T_BL", mounting(record.T_BL)}};
}

json series(const sim::SeriesRecord& record) {
  json quantities = json::array();
  for (const sim::Quantity& quantity : record.quantities)
    quantities.push_back({{"name", quantity.name}, {"unit", quantity.unit}, {"noise", quantity.noise}});
  json constants = json::object();
  for (const sim::Constant& constant : record.constants) constants[constant.name] = constant.value;
  return {{"name", record.name},
          {"kind", record.kind},
          {"device", record.device},
          {"period_ns", record.period_ns},
          {"samples", record.time_ns.size()},
          {"quantities", quantities},
          {"constants", constants},
          {"T_BX", mounting(record.T_BX)}};
}

}  // namespace

std::string sensors_text(const sim::Sensors& sensors) {
  json imus = json::array(), lidars = json::array(), others = json::array();
  for (const sim::ImuRecord& record : sensors.imus) imus.push_back(imu(record));
  for (const sim::LidarRecord& record : sensors.lidars) lidars.push_back(lidar(record));
  for (const sim::SeriesRecord& record : sensors.series) others.push_back(series(record));
  const json all = {{"robot", sensors.robot},
                    {"sphere_radius_m", sensors.sphere_radius_m},
                    {"gravity_m_s2", sensors.gravity_m_s2},
                    {"imus", imus},
                    {"lidars", lidars},
                    {"series", others}};
  return all.dump(2) + "\n";
}

}  // namespace tumble::scenarios
