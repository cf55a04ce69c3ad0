// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/dialect.hpp"

#include <yaml-cpp/yaml.h>

#include "scenarios/recordings/dialects/dialect_files.hpp"

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

}  // namespace tumble::scenarios
