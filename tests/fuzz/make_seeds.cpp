// SPDX-License-Identifier: BSD-3-Clause
// fuzz_make_seeds FOLDER writes the smallest valid file of each kind into FOLDER/READER/, if the readers' own writers
// can create it; tests/fuzz/README.md lists the sources of the other seeds.
#include <zstd.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/export.hpp"
#include "tests/fuzz/saved_runs.hpp"
#include "tests/scenarios/recordings/fixture_recording.hpp"
#include "tests/scenarios/recordings/mcap_file.hpp"
#include "tests/tree.hpp"

namespace {

using namespace tumble;
using namespace tumble::scenarios;
using std::filesystem::path;

/// Returns few readings of a body that rotates slowly under gravity.
sim::Recording small_recording(int samples) {
  fixture::Numbers numbers;
  sim::Recording out = fixture::recording();
  out.sensors.imus = {fixture::imu_record(numbers, "imu", samples)};
  out.truth.imus = {fixture::imu_truth(numbers, "imu", samples)};
  out.sensors.lidars.clear();
  out.truth.lidars.clear();
  fixture::add_lidar(numbers, out, "lidar", 2, 4);
  for (std::uint32_t& offset_ns : out.sensors.lidars[0].offset_ns) offset_ns *= 8000;  // 25 ms between points
  sim::ImuRecord& imu = out.sensors.imus[0];
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    const double angle_rad = 0.003 * static_cast<double>(k);
    imu.gyro_rad_s[k] = {0.01, 1.2, -0.02};
    imu.accel_m_s2[k] = {9.8 * std::sin(angle_rad), 0.1, 9.8 * std::cos(angle_rad)};
  }
  return out;
}

path in(const path& folder, const std::string& reader) {
  std::filesystem::create_directories(folder / reader);
  return folder / reader;
}

void put_text(const path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

std::string packed_by_zstd(const std::string& plain) {
  std::string out(ZSTD_compressBound(plain.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 19));
  return out;
}

/// Writes bags in the program's format and in other formats, without checksums, which would reject most inputs of a
/// fuzzer.
void write_mcaps(const path& folder, const sim::Recording& recording) {
  const StoredTruth truth = fixture::stored_truth(recording, folder);
  export_mcap(recording.sensors, {0, &truth}, folder / "small");
  fixture::McapShape shape;
  const std::vector<fixture::Logged> messages = fixture::imu_messages(12);
  shape.chunks = {{messages.begin(), messages.begin() + 6}, {messages.begin() + 6, messages.end()}};
  shape.crcs = false;
  for (const char* compression : {"", "lz4", "zstd"}) {
    shape.compression = compression;
    put_text(folder / (*compression == '\0' ? "plain" : compression), fixture::mcap_bytes(shape));
  }
  shape.compression = "lz4";
  shape.summary = false;
  put_text(folder / "without_summary", fixture::mcap_bytes(shape));
  shape.chunked = false;
  put_text(folder / "loose", fixture::mcap_bytes(shape));
}

void write_recordings(const path& folder, const path& scratch) {
  const sim::Recording recording = small_recording(6);
  write_recording(in(folder, "recording") / "small", fixture::info(), recording.sensors, &recording.truth);
  const sim::Recording longer = small_recording(40);
  export_ros1_bag(longer.sensors, {}, in(folder, "ros1_bag") / "small");
  BagWriting livox;
  livox.sweeps = livox_sweep_layout();
  export_ros1_bag(longer.sensors, livox, in(folder, "ros1_bag") / "livox");
  export_mcap(longer.sensors, livox, in(folder, "mcap") / "livox");
  export_ros2_bag(longer.sensors, {}, scratch / "bag");
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "bag")) {
    if (entry.path().extension() == ".db3") {
      std::filesystem::copy_file(entry.path(), in(folder, "ros2_bag") / "small");
      put_text(in(folder, "ros2_bag_packed") / "small", packed_by_zstd(test::read_file(entry.path())));
    }
  }
  write_mcaps(in(folder, "mcap"), longer);
  export_csv(longer.sensors, nullptr, scratch / "csv");
  std::filesystem::copy_file(scratch / "csv" / "imu.csv", in(folder, "imu_csv") / "own");
  put_text(in(folder, "imu_csv") / "short",
           "sec,nsec,wx,wy,wz,ax,ay,az\n1,0,0.01,0.02,0.03,0.1,0.2,9.8\n"
           "1,10000000,0.01,0.02,0.03,0.1,0.2,9.8\n1,20000000,0.01,0.02,0.03,0.1,0.2,9.8\n");
  put_text(in(folder, "imu_csv") / "logger",
           "#timestamp [ns];w_RS_S_x [rad s^-1];w_RS_S_y [rad s^-1];w_RS_S_z [rad s^-1];\"ax\";ay;az;temp\n"
           "1403636579758555392;0.01;0.02;0.03;0.1;0.2;9.8;25\n1403636579763555392;0.01;0.02;0.03;0.1;0.2;9.8;25\n"
           "1403636579768555392;0.01;0.02;0.03;0.1;0.2;9.8;25\n");
  put_text(in(folder, "imu_csv") / "logger_steps",
           "time,gyro_x_deg_s,gyro_y_deg_s,gyro_z_deg_s,acc_x (g),acc_y (g),acc_z (g)\n"
           "0.005,1,2,3,0,0,1\n0.010000000000000002,1,2,3,0,0,1\n0.015,1,2,3,0,0,1\n");
  export_ply(longer.sensors, scratch / "ply");
  export_pcd(longer.sensors, scratch / "pcd");
  std::filesystem::copy_file(scratch / "ply" / "lidar_000000.ply", in(folder, "ply_cloud") / "binary");
  std::filesystem::copy_file(scratch / "pcd" / "lidar_000000.pcd", in(folder, "pcd_cloud") / "binary");
  std::filesystem::copy_file(scratch / "ply" / "lidar_times.txt", in(folder, "stamps") / "times");
  export_tum(longer.truth, in(folder, "tum") / "poses");
  export_tum(longer.truth, in(folder, "estimate_tum") / "poses");
  export_kitti(longer.truth, in(folder, "kitti") / "poses");
}

void write_texts(const path& folder) {
  put_text(in(folder, "ply_cloud") / "text",
           "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
           "property float intensity\nend_header\n1 2 3 0.5\n4 5 6 1\n");
  put_text(in(folder, "pcd_cloud") / "text",
           "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
           "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3 0.5\n4 5 6 1\n");
  for (const auto& [name, bytes] : fuzz::saved_run_seeds()) put_text(in(folder, "saved_run") / name, bytes);
  put_text(in(folder, "vtk_cloud") / "small",
           "# vtk DataFile Version 3.0\nFile created by libpointmatcher\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
           "1 2 3\n4 5 6\n7 8 9\nVERTICES 3 6\n1 0\n1 1\n1 2\nPOINT_DATA 3\nSCALARS intensity float\n"
           "LOOKUP_TABLE default\n36\n31\n4\nNORMALS normals float\n0 0 1\n0 0 1\n0 0 1\nSCALARS t float\n"
           "LOOKUP_TABLE default\n0\n4.5e+07\n9.97e+07\n");
  put_text(in(folder, "odometry") / "small",
           "header.stamp.sec,header.stamp.nanosec,header.frame_id,pose.pose.position.x,pose.pose.position.y,"
           "pose.pose.position.z,pose.pose.orientation.x,pose.pose.orientation.y,pose.pose.orientation.z,"
           "pose.pose.orientation.w,pose.covariance\n"
           "1690309709,285305600,map,0.85,-0.13,0.03,0,-0.6,0,0.8,[0. 0.]\n"
           "1690309709,385259008,map,0.86,-0.13,0.03,0,-0.6,0,0.8,[0. 0.]\n"
           "1690309709,485205504,map,0.87,-0.12,0.03,0,-0.6,0,0.8,[0. 0.]\n");
  const float points[8] = {1, 2, 3, 0.5f, 4, 5, 6, 1};
  put_text(in(folder, "kitti_cloud") / "small", std::string(reinterpret_cast<const char*>(points), sizeof points));
}

void write_documents(const path& folder, const path& scratch) {
  const DataRoot data{test::source_dir()};
  for (const char* name : {"swing", "slip"}) {
    std::filesystem::copy_file(data.catalogue() / (std::string(name) + ".yaml"), in(folder, "scenario") / name);
  }
  put_text(in(folder, "situation") / "roll", to_yaml(draw(data, load_scenario(data, "roll"), 1)));
  std::filesystem::copy_file(data.suites() / "rates_rig.yaml", in(folder, "suite") / "rates_rig");
  std::filesystem::copy_file(data.data_sheets() / "mid40.yaml", in(folder, "data_sheet") / "mid40");
  put_text(in(folder, "suite") / "named_draws",
           "name: a\ndoc: b\ndraws: {mild: {hill: [3, 8]}, wild: {roll: [3]}}\nmetrics: [ate_m]\nmethods: [raw]\n");
  put_text(in(folder, "description") / "small",
           "name: mine\nkind: slam\ncommand: [sh, \"{folder}/mine\", --bag, \"{rosbag2}\", --out, \"{output}\", "
           "\"{map}\"]\nrobots: [rig]\nframe: lidar\nenvironment: {A: \"1\"}\ntime_limit_s: 60\n");
  BenchResult bench{"small", "0123", Kind::rate, "raw", "", "ours", "0.1.0", "tumble bench rate/raw", "2026-01-31", {}};
  bench.draws = {{"hill", 1, "mild", "ab", OutcomeStatus::ok, {{"ate_m", 0.5}}},
                 {"hill", 2, "wild", "", OutcomeStatus::timeout, {}}};
  put_text(in(folder, "bench_results") / "small", to_line(bench) + "\n");
  put_text(in(folder, "gate") / "small",
           "suite: gate\nrisk: 0.05\nmargin: 0.02\nshare_margin: 0.005\ntime_margin_s: 5e-05\nworst: 2\n");
  put_text(in(folder, "gate_run") / "small",
           "scenario,kind,method,metric,1,2\nhill,slam,tumble,status,ok,failed\nhill,slam,tumble,map_overlap,0.75,\n");

  const std::vector<MapPoint> map(3, MapPoint{{1, 2, 3}, {0, 0, 1}, 0.1f});
  write_map(in(folder, "map_ply") / "small", map);

  Estimate estimate;
  estimate.health["rejected_samples"] = 2.0;
  for (int k = 0; k < 3; ++k) {
    AngularRateState state;
    state.time_ns = 10'000'000 * (k + 1);
    state.covariance_rad2_s2 = 1e-4 * Eigen::Matrix3d::Identity();
    estimate.rates.push_back(state);
  }
  write_estimate(scratch / "estimate", "rate/raw", Kind::rate, estimate, std::string(32, 'a'));
  std::filesystem::copy_file(scratch / "estimate" / "estimate.json", in(folder, "estimate_json") / "rates");
  std::filesystem::copy_file(scratch / "estimate" / "rates.csv", in(folder, "estimate_rates") / "rates");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_make_seeds FOLDER\n");
    return 2;
  }
  try {
    const path folder = argv[1], scratch = folder / "scratch";
    std::filesystem::create_directories(scratch);
    write_recordings(folder, scratch);
    write_texts(folder);
    write_documents(folder, scratch);
    std::filesystem::remove_all(scratch);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_make_seeds: %s\n", error.what());
    return 3;
  }
  return 0;
}
