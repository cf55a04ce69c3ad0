// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/readers.hpp"

#include <array>
#include <fstream>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/external/external_description.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/sweep/gate.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "sim/parameters.hpp"
#include "tests/fuzz/saved_runs.hpp"
#include "tests/tree.hpp"

namespace tumble::fuzz {

namespace {

using std::filesystem::path;
using namespace tumble::scenarios;  // all readers are in this namespace

void recording(const path& file) {
  read_info(file);
  read_sensors(file);
  read_truth(file);
}

sim::ImuRecord some_imu() {
  sim::ImuRecord imu;
  imu.name = "imu";
  imu.device = "mti30";
  imu.period_ns = 10'000'000;
  return imu;
}

BagReading some_bag() {
  BagReading reading;
  reading.imu = some_imu();
  reading.sweeps.device.name = "lidar";
  return reading;
}

/// Reads a file of points, then converts it to a sweep.
void cloud(const path& file, const std::string& format) {
  read_cloud(file);
  SweepSource source;
  source.folder = file.parent_path();
  source.format = format;
  source.steady_ns = 100'000'000;
  source.reading.device.name = "lidar";
  source.reading.device.sweep_period_ns = 100'000'000;
  import_sweeps(source);
}

void tum(const path& file) {
  pose_format(file);
  read_tum_poses(file, true);
  read_tum_poses(file, false);
  ReferenceSource source;
  source.file = file;
  source.format = "tum";
  import_trajectory(source);
}
void odometry(const path& file) {
  pose_format(file);
  ReferenceSource source;
  source.file = file;
  source.format = "odometry";
  import_trajectory(source);
}
void kitti(const path& file) {
  ReferenceSource source;
  source.file = file;
  source.format = "kitti";
  source.steady_ns = 100'000'000;
  import_trajectory(source);
}

const DataRoot& data() {
  static const DataRoot kData{test::source_dir()};
  return kData;
}
void gate(const path& file) {
  std::ofstream(path(file).replace_extension(".csv")) << "scenario,kind,method,metric,1\nroll,rate,raw,status,ok\n";
  load_gate(data(), file.string());
}

void estimate(const path& place) {
  Kind kind{};
  std::string method;
  estimated_sensors(place);
  read_estimate(place, kind, method, Frame::imu);
}
/// Reads the table next to a valid estimate.json.
void estimate_rates(const path& file) {
  const path json = file.parent_path() / "estimate.json";
  if (!std::filesystem::exists(json)) {
    std::filesystem::copy_file(test::source_dir() / "tests/fuzz/seeds/estimate_json/rates", json);
  }
  estimate(file.parent_path());
}
/// Reads the description next to a valid table.
void estimate_json(const path& file) {
  const path rates = file.parent_path() / "rates.csv";
  if (!std::filesystem::exists(rates)) {
    std::filesystem::copy_file(test::source_dir() / "tests/fuzz/seeds/estimate_rates/rates", rates);
  }
  estimate(file.parent_path());
}

constexpr std::array kReaders = {
    Reader{"recording", "a.h5", recording},
    Reader{"imu_csv", "a.csv", [](const path& file) { import_imu_csv(file, some_imu()); }},
    Reader{"ros1_bag", "a.bag", [](const path& file) { import_ros1_bag(file, some_bag()); }},
    Reader{"ros2_bag", "a.db3", [](const path& file) { import_ros2_bag(file, some_bag()); }},
    Reader{"ros2_bag_packed", "a.db3.zstd", [](const path& file) { import_ros2_bag(file, some_bag()); }},
    Reader{"mcap", "a.mcap", [](const path& file) { import_mcap(file, some_bag()); }},
    Reader{"ply_cloud", "lidar_000000.ply", [](const path& file) { cloud(file, "ply"); }},
    Reader{"pcd_cloud", "lidar_000000.pcd", [](const path& file) { cloud(file, "pcd"); }},
    Reader{"vtk_cloud", "cloud_000000.vtk", [](const path& file) { cloud(file, "vtk"); }},
    Reader{"kitti_cloud", "lidar_000000.bin", [](const path& file) { cloud(file, "kitti"); }},
    Reader{"stamps", "times.txt", [](const path& file) { read_stamps(file); }},
    Reader{"tum", "a.tum", tum},
    Reader{"kitti", "a.txt", kitti},
    Reader{"odometry", "a.csv", odometry},
    Reader{"scenario", "a.yaml", [](const path& file) { draw(data(), load_scenario(data(), file.string()), 1); }},
    Reader{"situation", "a.yaml", [](const path& file) { situation_from_yaml(read_text_file(file), "situation"); }},
    Reader{"suite", "a.yaml", [](const path& file) { load_suite(data(), file.string()); }},
    Reader{"gate", "a.yaml", gate},
    Reader{"gate_run", "a.csv", [](const path& file) { parse_gate_run(read_text_file(file), file.string()); }},
    Reader{"data_sheet", "a.yaml",
           [](const path& file) { parse_data_sheet(read_text_file(file), file.string(), Registry::of_simulation()); }},
    Reader{"map_ply", "map.ply", [](const path& file) { read_map(file); }},
    Reader{"estimate_tum", "a.tum", [](const path& file) { estimate(file); }},
    Reader{"estimate_rates", "rates.csv", estimate_rates},
    Reader{"estimate_json", "estimate.json", estimate_json},
    Reader{"saved_run", "run", saved_run},
    Reader{"description", "a.yaml", [](const path& file) { read_external(file); }},
    Reader{"bench_results", "a.jsonl", [](const path& file) { read_bench_results(file); }},
};

}  // namespace

std::span<const Reader> readers() {
  return kReaders;
}

const Reader* find_reader(std::string_view name) {
  for (const Reader& reader : kReaders) {
    if (reader.name == name) return &reader;
  }
  return nullptr;
}

bool takes(const Reader& reader, std::string_view bytes, const path& folder) {
  const path file = folder / reader.file;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  try {
    reader.read(file);
    return true;
  } catch (const BadInput&) {
    return false;
  } catch (const sim::InvalidSituation&) {  // a number that is out of bounds in the draw
    return false;
  }
}

}  // namespace tumble::fuzz
