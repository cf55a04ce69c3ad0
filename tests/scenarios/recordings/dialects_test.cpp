// SPDX-License-Identifier: BSD-3-Clause
// The test reads the files for each external program with this project's readers and compares them with what the
// program's sources require, which the table below repeats. tests/peers reads the same files with other people's
// packages.
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/bag_sweeps.hpp"
#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/export_for.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

/// A Wanted contains what an external program reads of a spinning lidar.
struct Wanted {
  const char* peer;
  const char* bag;  ///< file name in the folder
  bool ros1;        ///< false: ROS 2
  const char *imu, *points;
  const char* time;   ///< name of the time field of a point
  std::uint8_t type;  ///< data type as in PointField
  double unit_ns;     ///< unit of the time field, which counts from the header's stamp
};

constexpr Wanted kWanted[] = {
    {"dlio", "recording.bag", true, "/os_cloud_node/imu", "/os_cloud_node/points", "t", 6, 1.0},
    {"fast-lio", "recording.bag", true, "/imu/data", "/velodyne_points", "time", 7, 1e9},
    {"glim", "bag", false, "/os_cloud_node/imu", "/os_cloud_node/points", "t", 6, 1.0},
    {"kiss-icp", "recording.bag", true, "/imu", "/lidar/points", "t", 6, 1.0},
    {"lio-sam", "recording.bag", true, "/imu_raw", "/points_raw", "time", 7, 1e9},
    {"norlab", "bag", false, "/imu/data", "/points_in", "t", 6, 1.0},
    {"point-lio", "recording.bag", true, "/imu/data", "/velodyne_points", "time", 7, 1e9},
    {"rko-lio", "bag", false, "/imu", "/lidar/points", "t", 6, 1.0},
};

std::unique_ptr<BagReader> open(const fs::path& path) {
  if (path.extension() == ".bag") return open_ros1_bag(path);
  if (path.extension() == ".mcap") return open_mcap({path});
  return open_ros2_bag(path);
}

template <class Message>
std::vector<Message> messages(BagReader& bag, const std::string& topic) {
  std::vector<Message> out;
  bag.read(topic, [&](ros::Bytes& bytes, std::int64_t) {
    out.push_back(bag.cdr(topic) ? ros::from_cdr<Message>(bytes) : ros::from_ros1<Message>(bytes));
  });
  return out;
}

/// Returns a recording with a lidar of that device whose points are not sorted by time.
sim::Recording unordered(const std::string& device = "rs16") {
  sim::Recording out = fixture::recording();
  out.sensors.robot = "rig";
  for (sim::ImuRecord& imu : out.sensors.imus) {
    for (Vector3d& force : imu.accel_m_s2) force *= 0.2;
  }
  sim::LidarRecord& lidar = out.sensors.lidars[0];
  lidar.device = device;
  for (std::size_t k = 0; k < lidar.offset_ns.size(); ++k) lidar.offset_ns[k] = (lidar.offset_ns[k] * 7 % 50) * 1900000;
  return out;
}

/// Returns what is wrong with the points of a bag, as that external program reads them, or "" when nothing is wrong.
std::string problem_of(const Wanted& wanted, const fs::path& bag, const sim::LidarRecord& lidar) {
  const auto reader = open(bag);
  if (reader->cdr(wanted.points) == wanted.ros1) return "the other ROS";
  const auto clouds = messages<ros::PointCloud2>(*reader, wanted.points);
  if (clouds.size() != lidar.sweep_start_ns.size()) return "another number of sweeps";
  for (std::size_t sweep = 0; sweep < clouds.size(); ++sweep) {
    const std::vector<ros::PointField>& fields = clouds[sweep].fields;
    const auto time = std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == wanted.time; });
    if (time == fields.end() || time->datatype != wanted.type) return "no such time";
    const std::int64_t start = std::int64_t{clouds[sweep].header.sec} * 1000000000 + clouds[sweep].header.nanosec;
    if (start != 1000000000000000000 + lidar.sweep_start_ns[sweep]) return "the stamp is not the sweep's start";
    const Cloud cloud = cloud_of(clouds[sweep], "cloud");
    double before = -1.0;
    for (std::size_t i = 0; i < cloud.points; ++i) {
      const double offset_ns = (*cloud.find(wanted.time))[i] * wanted.unit_ns;
      if (offset_ns < before) return "not in the order of time";
      before = offset_ns;
      // a point is identified by its position, which no two points share
      std::size_t k = lidar.sweep_first[sweep];
      while (k < lidar.sweep_first[sweep + 1] && lidar.position_L_m[k].x() != (*cloud.find("x"))[i]) ++k;
      if (k == lidar.sweep_first[sweep + 1]) return "a point that is none";
      if (std::abs(offset_ns - lidar.offset_ns[k]) > 4.0) return "another time";
      if ((*cloud.find("ring"))[i] != lidar.ring[k]) return "another ring";
      if (std::abs((*cloud.find("intensity"))[i] - 255.0 * lidar.intensity[k]) > 1e-4) return "another intensity";
    }
  }
  return "";
}

class Dialects : public test::TemporaryFolder, public testing::WithParamInterface<Wanted> {
 protected:
  void write(const sim::Recording& recording) {
    write_recording(folder_ / "a.h5", fixture::info(), recording.sensors, &recording.truth);
  }
  fs::path out() const { return folder_ / GetParam().peer; }
  nlohmann::json manifest() const { return nlohmann::json::parse(test::read_file(out() / "manifest.json")); }
  std::string complaint_of(const sim::Recording& recording) {
    write(recording);
    return test::complaint([&] { export_for(folder_ / "a.h5", GetParam().peer, folder_ / "refused", false); });
  }
};

TEST_P(Dialects, TheBagIsAsThePeerReadsIt) {
  const Wanted& wanted = GetParam();
  const sim::Recording recording = unordered();
  write(recording);
  export_for(folder_ / "a.h5", wanted.peer, out(), true);
  EXPECT_EQ(problem_of(wanted, out() / wanted.bag, recording.sensors.lidars[0]), "");

  const auto bag = open(out() / wanted.bag);
  const sim::ImuRecord& imu = recording.sensors.imus[0];
  const auto readings = messages<ros::Imu>(*bag, wanted.imu);
  ASSERT_EQ(readings.size(), imu.time_ns.size());
  for (std::size_t k = 0; k < readings.size(); ++k) {
    EXPECT_EQ(Eigen::Vector3d::Map(readings[k].angular_velocity.data()), imu.gyro_rad_s[k]);
    EXPECT_EQ(Eigen::Vector3d::Map(readings[k].linear_acceleration.data()), imu.accel_m_s2[k]) << "m/s^2";
  }
  std::size_t of_a_type = 0;
  for (const BagTopic& topic : bag->topics()) of_a_type += topic.type == "sensor_msgs/Imu";
  EXPECT_EQ(of_a_type, 1u) << "a second IMU would have to be chosen among";
}

TEST_P(Dialects, AnotherUnitOfTimeIsNoticed) {
  const Wanted& wanted = GetParam();
  const sim::Recording recording = unordered();
  const auto dialect = std::find_if(all_dialects().begin(), all_dialects().end(),
                                    [&](const Dialect& each) { return each.name == wanted.peer; });
  ASSERT_NE(dialect, all_dialects().end());
  const SensorFacts facts = facts_of(recording.sensors);
  BagWriting writing;
  writing.names = dialect->names(facts);
  writing.sweeps = dialect->sweeps(facts);
  for (PointColumn& column : writing.sweeps.columns) {
    if (column.quantity == PointQuantity::time) column.scale *= 1e-3;
  }
  const fs::path place = folder_ / wanted.bag;
  (wanted.ros1                    ? export_ros1_bag
   : place.extension() == ".mcap" ? export_mcap
                                  : export_ros2_bag)(recording.sensors, writing, place);
  EXPECT_EQ(problem_of(wanted, place, recording.sensors.lidars[0]), "another time");
}

TEST_P(Dialects, TheManifestSaysWhatIsThere) {
  const Wanted& wanted = GetParam();
  const sim::Recording recording = unordered();
  write(recording);
  export_for(folder_ / "a.h5", wanted.peer, out(), true);
  const nlohmann::json said = manifest();
  EXPECT_EQ(said["for"], wanted.peer);
  EXPECT_EQ(said["bag"]["path"], wanted.bag);
  EXPECT_EQ(said["lidar"]["topic"], wanted.points);
  EXPECT_EQ(said["imu"]["topic"], wanted.imu);
  EXPECT_EQ(said["imu"]["stated_gyro_range_rad_s"], recording.sensors.imus[0].stated_gyro_range_rad_s);
  EXPECT_EQ(said["imu"]["gyro_noise_rad_s_sqrt_hz"], recording.sensors.imus[0].gyro_noise_rad_s_sqrt_hz);
  EXPECT_FALSE(said["sources"].empty());
  for (const auto& source : said["sources"]) EXPECT_EQ(source["commit"].get<std::string>().size(), 40u);
  for (const auto& file : said["configuration"]) {
    EXPECT_TRUE(fs::exists(out() / file.get<std::string>())) << file;
    EXPECT_NO_THROW(YAML::LoadFile((out() / file.get<std::string>()).string())) << file;
  }
  const Isometry3d T_IL = recording.sensors.imus[0].T_BI.inverse() * recording.sensors.lidars[0].T_BL;
  const auto p = said["extrinsics"]["T_imu_lidar"]["p_m"].get<std::vector<double>>();
  EXPECT_TRUE(Eigen::Vector3d::Map(p.data()).isApprox(T_IL.translation(), 1e-12));
  // the truth has stamps of the bag's clock
  EXPECT_THAT(test::read_file(out() / "truth.tum"), HasSubstr("\n1000000000.001000000 "));
}

TEST_P(Dialects, WhatThePeerCannotDoWithoutIsRefused) {
  const std::string peer = GetParam().peer;
  const bool lidar_alone = peer == "kiss-icp" || peer == "norlab";
  sim::Recording recording = unordered();
  recording.sensors.imus.clear();
  recording.truth.imus.clear();
  EXPECT_EQ(complaint_of(recording),
            lidar_alone ? "" : "the recording has no IMU reading; " + peer + " cannot read such a recording");
  fs::remove_all(folder_ / "refused");
  recording = unordered();
  recording.sensors.lidars[0].point_times = sim::PointTimes::unknown;
  recording.sensors.lidars[0].offset_ns.assign(recording.sensors.lidars[0].offset_ns.size(), 0);
  EXPECT_EQ(
      complaint_of(recording),
      lidar_alone ? "" : "the points of lidar 'lidar' have no time stamps; " + peer + " cannot read such a recording");
  fs::remove_all(folder_ / "refused");
  recording = unordered();
  recording.sensors.lidars[0].range_m[7] = std::nanf("");
  EXPECT_THAT(complaint_of(recording),
              HasSubstr("point 7 of lidar 'lidar' has a position, range or intensity that is not finite"));
  EXPECT_FALSE(fs::exists(folder_ / "refused"));
  recording = unordered();
  recording.sensors.lidars.clear();
  recording.truth.lidars.clear();
  EXPECT_EQ(complaint_of(recording), "the recording has no lidar return; " + peer + " cannot read such a recording");
  EXPECT_FALSE(fs::exists(folder_ / "refused"));
}

// programs that read the last of no points, or reject no sweep without points, do not receive such a sweep
TEST_P(Dialects, AnEmptySweepIsThereOnlyForThosePeersThatTakeIt) {
  const std::string peer = GetParam().peer;
  const bool takes = peer == "fast-lio" || peer == "point-lio" || peer == "norlab";
  sim::Recording recording = unordered();
  sim::LidarRecord& lidar = recording.sensors.lidars[0];
  for (const std::int64_t last : {1, 2}) {
    lidar.sweep_start_ns.insert(lidar.sweep_start_ns.begin() + 1, 30000000 * last);
    lidar.sweep_first.insert(lidar.sweep_first.begin() + 1, lidar.sweep_first[1]);
  }
  std::sort(lidar.sweep_start_ns.begin(), lidar.sweep_start_ns.end());
  write(recording);
  const std::vector<std::string> notes = export_for(folder_ / "a.h5", peer, out(), false);
  const auto clouds = messages<ros::PointCloud2>(*open(out() / GetParam().bag), GetParam().points);
  EXPECT_EQ(clouds.size(), takes ? 5u : 3u);
  EXPECT_EQ(manifest()["lidar"]["sweeps"], clouds.size());
  EXPECT_EQ(std::count_if(clouds.begin(), clouds.end(), [](const auto& cloud) { return cloud.width == 0; }),
            takes ? 2 : 0);
  const std::string note =
      "the export leaves out 2 sweeps without points, because " + peer + " cannot read an empty cloud";
  EXPECT_THAT(notes, testing::Conditional(takes, IsEmpty(), ElementsAre(note)));
  EXPECT_EQ(test::read_file(out() / "manifest.json").find(note) != std::string::npos, !takes);
}

INSTANTIATE_TEST_SUITE_P(, Dialects, testing::ValuesIn(kWanted), [](const auto& of) {
  std::string name = of.param.peer;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class Configuration : public test::TemporaryFolder {
 protected:
  YAML::Node yaml(const std::string& peer, const std::string& file, const sim::Recording& recording) {
    write_recording(folder_ / "a.h5", fixture::info(), recording.sensors, &recording.truth);
    export_for(folder_ / "a.h5", peer, folder_ / peer, false);
    return YAML::LoadFile((folder_ / peer / file).string());
  }
  static Isometry3d pose(const YAML::Node& t, const YAML::Node& R) {
    Isometry3d out = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) out.translation()[i] = t[static_cast<std::size_t>(i)].as<double>();
    for (int i = 0; i < 9; ++i) out.linear()(i / 3, i % 3) = R[static_cast<std::size_t>(i)].as<double>();
    return out;
  }
  sim::Recording recording_ = unordered();
  Isometry3d T_BI_ = recording_.sensors.imus[0].T_BI, T_BL_ = recording_.sensors.lidars[0].T_BL;
};

// each program has its own sense of the mounting: with a wrong one the map turns around
TEST_F(Configuration, MountingsAreInThePeersSense) {
  for (const auto& [peer, file] : {std::pair{"fast-lio", "velodyne.yaml"}, std::pair{"point-lio", "velody16.yaml"}}) {
    const YAML::Node mapping = yaml(peer, file, recording_)["mapping"];
    EXPECT_TRUE(pose(mapping["extrinsic_T"], mapping["extrinsic_R"]).isApprox(T_BI_.inverse() * T_BL_, 1e-9)) << peer;
  }
  const YAML::Node dlio = yaml("dlio", "dlio.yaml", recording_)["dlio"]["extrinsics"];
  EXPECT_TRUE(pose(dlio["baselink2imu"]["t"], dlio["baselink2imu"]["R"]).isApprox(T_BI_, 1e-9));
  EXPECT_TRUE(pose(dlio["baselink2lidar"]["t"], dlio["baselink2lidar"]["R"]).isApprox(T_BL_, 1e-9));
  const YAML::Node lio_sam = yaml("lio-sam", "params.yaml", recording_)["lio_sam"];
  EXPECT_TRUE(pose(lio_sam["extrinsicTrans"], lio_sam["extrinsicRot"]).isApprox(T_BL_.inverse() * T_BI_, 1e-9));
  const YAML::Node glim = yaml("glim", "config_sensors.json", recording_)["sensors"]["T_lidar_imu"];
  const YAML::Node rko = yaml("rko-lio", "rko_lio.yaml", recording_)["extrinsic_imu2base_quat_xyzw_xyz"];
  const Vector3d p_LI = (T_BL_.inverse() * T_BI_).translation();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(glim[i].as<double>(), p_LI[static_cast<Eigen::Index>(i)], 1e-9) << "place first";
    EXPECT_NEAR(rko[4 + i].as<double>(), T_BI_.translation()[static_cast<Eigen::Index>(i)], 1e-9) << "quaternion first";
  }
}

TEST_F(Configuration, SensorsAreThisRecordings) {
  const YAML::Node lio = yaml("point-lio", "velody16.yaml", recording_);
  EXPECT_EQ(lio["preprocess"]["scan_line"].as<int>(), 16);
  EXPECT_EQ(lio["preprocess"]["timestamp_unit"].as<int>(), 0);
  EXPECT_NEAR(lio["mapping"]["imu_time_inte"].as<double>(), 0.0025, 1e-12);
  // readings exceed the range that the data sheet states: the saturation level must not be below them
  const SensorFacts facts = facts_of(recording_.sensors);
  EXPECT_GT(facts.imu->largest_gyro_rad_s, facts.imu->stated_gyro_range_rad_s);
  EXPECT_EQ(lio["mapping"]["satu_gyro"].as<double>(), facts.imu->largest_gyro_rad_s);
  EXPECT_EQ(lio["mapping"]["satu_acc"].as<double>(), 49.0);
  const YAML::Node sam = yaml("lio-sam", "params.yaml", recording_)["lio_sam"];
  EXPECT_EQ(sam["imuAccNoise"].as<double>(), 6e-4);
  EXPECT_EQ(sam["imuRPYWeight"].as<double>(), 0.0);
}

// the keys are those that the released programs know: tests/peers/programs_checks.py starts them
TEST_F(Configuration, KeysAreThoseOfTheReleasedPrograms) {
  const YAML::Node rko = yaml("rko-lio", "rko_lio.yaml", recording_);
  EXPECT_EQ(rko["lidar_timestamps"]["multiplier_to_seconds"].as<double>(), 1e-9);
  EXPECT_FALSE(rko["timestamps"]);
  // a hundredth of this range would be the size of the map's voxels
  EXPECT_FALSE(yaml("kiss-icp", "kiss_icp.yaml", recording_)["data"]["max_range"]);
}

TEST_F(Configuration, ALivoxComesAsItsDriversMessage) {
  const sim::Recording recording = unordered("mid100");
  for (const char* peer : {"fast-lio", "point-lio"}) {
    const YAML::Node preprocess = yaml(peer, "avia.yaml", recording)["preprocess"];
    EXPECT_EQ(preprocess["lidar_type"].as<int>(), 1);
    const auto bag = open(folder_ / peer / "recording.bag");
    const auto sweeps = messages<ros::LivoxCustomMsg>(*bag, "/livox/lidar");
    ASSERT_EQ(sweeps.size(), 3u);
    EXPECT_EQ(sweeps[1].points.size(), 50u);
  }
  EXPECT_THAT(test::complaint([&] { yaml("lio-sam", "params.yaml", recording); }),
              HasSubstr("the lidar 'mid100' does not scan in rings; lio-sam cannot read such a recording"));
}

TEST_F(Configuration, AnUnknownPeerIsRefusedWithTheNearest) {
  EXPECT_THAT(test::complaint([&] { yaml("fast_lio", "", recording_); }),
              HasSubstr("the export target 'fast_lio' is unknown (did you mean 'fast-lio'?)"));
  EXPECT_EQ(peer_dialects().size(), std::size(kWanted)) << "each has its line in the table above";
}

}  // namespace
}  // namespace tumble::scenarios
