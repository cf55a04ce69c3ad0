// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/dialect.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "scenarios/recordings/dialects/dialect_files.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

Dialect dialect_from(const YAML::Node& file) {
  const auto text = [](const YAML::Node& node) { return node.as<std::string>(); };
  Dialect out;
  out.name = text(file["name"]);
  out.bag_format = text(file["bag"]["format"]);
  out.bag_name = text(file["bag"]["path"]);
  out.imu_topic = text(file["topics"]["imu"]);
  out.points_topic = text(file["topics"]["points"]);
  out.fixed_frame = file["fixed_frame"].as<std::string>("");
  if (const YAML::Node livox = file["livox"])
    out.livox = LivoxDialect{text(livox["imu"]), text(livox["points"]), text(livox["file"])};
  out.point_times = text(file["point_times"]);
  out.needs_imu = file["needs_imu"].as<bool>(true);
  out.needs_times = file["needs_times"].as<bool>(true);
  out.needs_rings = file["needs_rings"].as<bool>(false);
  out.takes_empty = file["accepts_empty_sweeps"].as<bool>(true);
  out.run = text(file["run"]);
  for (const YAML::Node& note : file["notes"]) out.notes.push_back(text(note));
  for (const YAML::Node& source : file["sources"])
    out.sources.push_back({text(source[0]), text(source[1]), text(source[2])});
  for (const auto& each : file["files"]) out.files.push_back({text(each.first), text(each.second)});
  return out;
}

}  // namespace

ReaderNames Dialect::names(const SensorFacts& facts) const {
  const bool custom = livox && facts.lidar->livox;
  return {custom ? livox->imu_topic : imu_topic,
          "imu",
          custom ? livox->points_topic : points_topic,
          "lidar",
          "base_link",
          fixed_frame};
}

SweepLayout Dialect::sweeps(const SensorFacts& facts) const {
  using enum PointQuantity;
  using enum NumberType;
  if (livox && facts.lidar->livox) return livox_sweep_layout();
  const bool seconds = point_times == "time";
  return {{{"x", x_m, float32},
           {"y", y_m, float32},
           {"z", z_m, float32},
           {"intensity", intensity, float32, 255.0},
           {"ring", ring, uint16},
           {point_times, time, seconds ? float32 : uint32, seconds ? 1e-9 : 1.0}},
          false,
          true};
}

std::span<const Dialect> all_dialects() {
  static const std::vector<Dialect> all = [] {
    std::vector<Dialect> out;
    for (const YAML::Node& file : YAML::LoadAll(kDialectFiles)) out.push_back(dialect_from(file));
    return out;
  }();
  return all;
}

namespace {

using NumberList = std::vector<double>;

/// ROS 2 requires a decimal point for a double, and YAML 1.1 requires a decimal point before an exponent.
std::string decimal(double value) {
  std::string text;
  append_number(text, value == 0.0 ? 0.0 : value);  // avoids "-0"
  if (text.find('.') != std::string::npos) return text;
  const std::size_t exponent = text.find('e');
  return exponent == std::string::npos ? text + ".0" : text.insert(exponent, ".0");
}

std::string text_of(const NumberList& values, bool json) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : json ? ",\n      " : ", ") + (json ? nlohmann::json(value).dump() : decimal(value));
  return values.size() == 1 || json ? text : "[" + text + "]";
}

NumberList position(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), T.translation().z()};
}

NumberList rotation(const Eigen::Isometry3d& T) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = T.linear();
  return {R.data(), R.data() + R.size()};
}

NumberList quaternion(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  return {q.x(), q.y(), q.z(), q.w()};
}

NumberList joined(NumberList a, const NumberList& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void add_imu(const ImuFacts& imu, std::map<std::string, NumberList>& out) {
  constexpr double kRestMin_s = 0.1, kRestMax_s = 3.0;  // DLIO averages over up to 3 s
  const auto variance = [&](double density) { return NumberList{density * density / imu.period_s}; };
  out["imu_period_s"] = {imu.period_s};
  out["rest_s"] = {std::clamp(imu.still_at_start_s, kRestMin_s, kRestMax_s)};
  out["accel_noise"] = {imu.accel_noise_m_s2_sqrt_hz};
  out["gyro_noise"] = {imu.gyro_noise_rad_s_sqrt_hz};
  out["accel_variance"] = variance(imu.accel_noise_m_s2_sqrt_hz);
  out["gyro_variance"] = variance(imu.gyro_noise_rad_s_sqrt_hz);
  out["stated_accel_range_m_s2"] = {imu.stated_accel_range_m_s2};
  out["stated_gyro_range_rad_s"] = {imu.stated_gyro_range_rad_s};
  // The configured range includes the largest reading, because a device can saturate above the range of its data sheet.
  out["accel_rail_m_s2"] = {std::max(imu.stated_accel_range_m_s2, imu.largest_accel_m_s2)};
  out["gyro_rail_rad_s"] = {std::max(imu.stated_gyro_range_rad_s, imu.largest_gyro_rad_s)};
}

std::map<std::string, NumberList> numbers_of(const SensorFacts& facts) {
  const LidarFacts& lidar = *facts.lidar;
  const Eigen::Isometry3d T_IL = facts.T_IL(), T_LI = T_IL.inverse(Eigen::Isometry);
  std::map<std::string, NumberList> out = {{"gravity_m_s2", {facts.gravity_m_s2}},
                                           {"own_body_m", {lidar.own_body_m}},
                                           {"farthest_m", {std::max(1.0, std::ceil(lidar.farthest_m))}},
                                           {"sweep_period_s", {lidar.period_s}},
                                           {"q_BI", joined(quaternion(facts.T_BI), position(facts.T_BI))},
                                           {"q_BL", joined(quaternion(facts.T_BL), position(facts.T_BL))},
                                           {"T_LI", joined(position(T_LI), quaternion(T_LI))}};
  for (const auto& [frames, T] :
       std::map<std::string, Eigen::Isometry3d>{{"BI", facts.T_BI}, {"BL", facts.T_BL}, {"IL", T_IL}, {"LI", T_LI}}) {
    out["p_" + frames] = position(T);
    out["R_" + frames] = rotation(T);
  }
  if (facts.imu) add_imu(*facts.imu, out);
  return out;
}

std::map<std::string, std::string> words_of(const Dialect& dialect, const SensorFacts& facts) {
  const LidarFacts& lidar = *facts.lidar;
  const ReaderNames names = dialect.names(facts);
  return {{"imu_topic", names.imu_topic},
          {"points_topic", names.points_topic},
          {"imu_frame", names.imu_frame},
          {"lidar_frame", names.lidar_frame},
          {"body_frame", names.body_frame},
          {"fixed_frame", names.fixed_frame},
          {"timed", lidar.timed ? "true" : "false"},
          {"rings", std::to_string(lidar.rings)},
          {"columns", std::to_string(lidar.columns)},
          {"scan_rate", std::to_string(std::lround(1.0 / lidar.period_s))},
          {"lidar_type", lidar.livox ? "1" : "2"},
          {"time_unit", lidar.livox ? "3" : "0"}};
}

}  // namespace

std::vector<ConfigurationFile> configuration_of(const Dialect& dialect, const SensorFacts& facts) {
  const std::map<std::string, NumberList> numbers = numbers_of(facts);
  std::map<std::string, std::string> words = words_of(dialect, facts);
  std::vector<ConfigurationFile> out;
  for (const ConfigurationFile& file : dialect.files) {
    const std::string name = dialect.livox && facts.lidar->livox ? dialect.livox->file : file.name;
    words["file"] = name;
    const auto value_of = [&](const std::string& placeholder) {
      const std::size_t bar = std::min(placeholder.find('|'), placeholder.size());
      const std::string quantity = placeholder.substr(0, bar);
      if (const auto word = words.find(quantity); word != words.end()) return word->second;
      const auto found = numbers.find(quantity);
      if (found == numbers.end()) throw std::logic_error(dialect.name + ", " + name + ": unknown quantity " + quantity);
      if (bar < placeholder.size() && !(found->second.front() > 0.0)) return placeholder.substr(bar + 1);
      return text_of(found->second, name.ends_with(".json"));
    };
    std::string text;
    for (std::size_t at = 0; at < file.text.size();) {
      const std::size_t begin = std::min(file.text.find('@', at), file.text.size());
      const std::size_t end = std::min(file.text.find('@', begin + 1), file.text.size());
      text += file.text.substr(at, begin - at);
      if (begin < end) text += value_of(file.text.substr(begin + 1, end - begin - 1));
      at = end + 1;
    }
    out.push_back({name, text});
  }
  return out;
}

}  // namespace tumble::scenarios
