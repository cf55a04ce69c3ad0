// SPDX-License-Identifier: BSD-3-Clause
// The test runs `tumble odometry` and `tumble doctor` on bags of other drivers, sound and with faults.
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/recordings/dialects/export_for.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

void scale(std::vector<Vector3d>& rows, double factor) {
  for (Vector3d& row : rows) row *= factor;
}

/// Drops the sweeps for which `dropped` is true.
void drop_sweeps(sim::LidarRecord& lidar, const std::function<bool(std::size_t)>& dropped) {
  std::vector<bool> kept;
  sim::LidarRecord out = lidar;
  out.sweep_start_ns.clear();
  out.sweep_first = {};
  std::size_t points = 0;
  for (std::size_t k = 0; k < lidar.sweep_start_ns.size(); ++k) {
    const std::size_t count = lidar.sweep_first[k + 1] - lidar.sweep_first[k];
    kept.insert(kept.end(), count, !dropped(k));
    if (dropped(k)) continue;
    out.sweep_start_ns.push_back(lidar.sweep_start_ns[k]);
    out.sweep_first.push_back(points);
    points += count;
  }
  out.sweep_first.push_back(points);
  scenarios::keep_rows(kept, out.position_L_m), scenarios::keep_rows(kept, out.range_m);
  scenarios::keep_rows(kept, out.intensity), scenarios::keep_rows(kept, out.offset_ns);
  scenarios::keep_rows(kept, out.ring);
  lidar = std::move(out);
}

struct Fault {
  const char* name;
  const char* evidence;  ///< part of a finding
  const char* repair;    ///< part of the remedy of a finding
  void (*inject)(sim::ImuRecord& imu, sim::LidarRecord& lidar);
  int status = 1;  ///< exit status of `tumble doctor`
};

const Fault kFaults[] = {
    {"accelerometer in g", "reads the accelerometer in g", "--accel-unit",
     [](sim::ImuRecord& imu, sim::LidarRecord&) { scale(imu.accel_m_s2, 1.0 / 9.80665); }},
    {"gyro in deg/s", "the rates may be in deg/s", "--gyro-unit deg/s",
     [](sim::ImuRecord& imu, sim::LidarRecord&) { scale(imu.gyro_rad_s, 57.29577951308232); }},
    {"inverted pose of the lidar", "the stated pose may be inverted: the pose of the body in the lidar frame",
     "--T-body-lidar", [](sim::ImuRecord&, sim::LidarRecord& lidar) { lidar.T_BL = lidar.T_BL.inverse(); }},
    {"lidar turned by 90 deg", "Check the signs and order of the axes, and the mounting", "--T-body-lidar",
     [](sim::ImuRecord&, sim::LidarRecord& lidar) {
       lidar.T_BL.rotate(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitX()));
     }},
    {"z axis of the IMU mirrored", "the axes of the IMU are mirrored (left-handed): the sign of the z axis is wrong",
     "",
     [](sim::ImuRecord& imu, sim::LidarRecord&) {
       for (Vector3d& rate : imu.gyro_rad_s) rate.z() = -rate.z();
       for (Vector3d& force : imu.accel_m_s2) force.z() = -force.z();
     }},
    {"gyro axes x and y swapped", "the axes", "",
     [](sim::ImuRecord& imu, sim::LidarRecord&) {
       for (Vector3d& rate : imu.gyro_rad_s) std::swap(rate.x(), rate.y());
     }},
    {"point times a hundred times too short", "point times span less than 2 %", "--time-unit",
     [](sim::ImuRecord&, sim::LidarRecord& lidar) {
       for (std::uint32_t& offset : lidar.offset_ns) offset /= 100;
     }},
    {"lidar starts 2 s late", "s after '", "",
     [](sim::ImuRecord&, sim::LidarRecord& lidar) {
       const auto late = [first = lidar.sweep_start_ns.front(), &lidar](std::size_t k) {
         return lidar.sweep_start_ns[k] < first + 2'000'000'000;
       };
       drop_sweeps(lidar, late);
     }},
    {"clock of the lidar 0.2 s late", "the lidar measures rotations", "--imu-minus-lidar-clock -0.2",
     [](sim::ImuRecord&, sim::LidarRecord& lidar) {
       for (std::int64_t& start : lidar.sweep_start_ns) start += 200'000'000;
     }},
    {"one of ten readings lost", "readings are lost", "",
     [](sim::ImuRecord& imu, sim::LidarRecord&) {
       std::vector<bool> kept;
       for (std::size_t k = 0; k < imu.time_ns.size(); ++k) kept.push_back(k % 10 != 5);
       scenarios::keep_rows(kept, imu.time_ns), scenarios::keep_rows(kept, imu.gyro_rad_s);
       scenarios::keep_rows(kept, imu.accel_m_s2), scenarios::keep_rows(kept, imu.clip_flags);
     }},
    {"one of seven sweeps lost", "sweeps are lost", "",
     [](sim::ImuRecord&, sim::LidarRecord& lidar) { drop_sweeps(lidar, [](std::size_t k) { return k % 7 == 3; }); }},
    {"accelerometer inverted", "the accelerometer seems to be inverted", "invert the accelerometer in the IMU's driver",
     [](sim::ImuRecord& imu, sim::LidarRecord&) { scale(imu.accel_m_s2, -1.0); }},
    {"gyro saturated at half of its largest rate", "the gyro is saturated", "",
     [](sim::ImuRecord& imu, sim::LidarRecord&) {
       double most = 0.0;
       for (const Vector3d& rate : imu.gyro_rad_s) most = std::max(most, rate.cwiseAbs().maxCoeff());
       for (Vector3d& rate : imu.gyro_rad_s) rate = rate.cwiseMax(-0.5 * most).cwiseMin(0.5 * most);
     },
     0},
};

/// Exports the recording with a fault for another package. Returns the path of the bag.
fs::path bag_of(const fs::path& folder, const char* peer, const Fault* fault) {
  scenarios::RecordingInfo info = scenarios::read_info(short_stroll());
  sim::Sensors sensors = scenarios::read_sensors(short_stroll());
  if (fault != nullptr) fault->inject(sensors.imus.front(), sensors.lidars.front());
  fs::remove_all(folder);
  fs::create_directories(folder);
  scenarios::write_recording(folder / "faulty.h5", info, sensors, nullptr);
  scenarios::export_for(folder / "faulty.h5", peer, folder / "export", false);
  fs::remove(folder / "faulty.h5");
  const fs::path bag = folder / "export" / "recording.bag";
  return fs::exists(bag) ? bag : folder / "export" / "bag";
}

bool has_finding(const json& document, const Fault& fault) {
  return std::ranges::any_of(document["findings"], [&](const json& each) {
    return each["evidence"].get<std::string>().find(fault.evidence) != std::string::npos &&
           each["repair"].get<std::string>().find(fault.repair) != std::string::npos;
  });
}

constexpr const char* kPeers[] = {"fast-lio", "dlio", "glim", "rko-lio"};

TEST(Doctor, FindsNothingInSoundBags) {
  const fs::path folder = test_folder();
  for (const char* peer : {kPeers[0], kPeers[2]}) {
    const Ended ended = run_program({"doctor", bag_of(folder / "bag", peer, nullptr).string(), "--json"});
    EXPECT_EQ(ended.status, 0) << peer << "\n" << ended.out << ended.err;
    EXPECT_EQ(json_of(ended)["findings"], json::array()) << peer;
  }
}

void expect_found(std::span<const Fault> faults) {
  const fs::path folder = test_folder();
  std::size_t k = 0;
  for (const Fault& fault : faults) {
    const char* const peer = kPeers[k++ % std::size(kPeers)];
    const Ended ended = run_program({"doctor", bag_of(folder / "bag", peer, &fault).string(), "--json"});
    EXPECT_EQ(ended.status, fault.status) << fault.name << ", " << peer << "\n" << ended.err;
    EXPECT_TRUE(has_finding(json_of(ended), fault)) << fault.name << ", " << peer << "\n" << ended.out;
  }
}

TEST(Doctor, FindsFaultsOfUnitsAndMountings) {
  expect_found(std::span(kFaults).first(5));
}

TEST(DoctorSoak, FindsEachFaultAndNamesItsRepair) {
  expect_found(kFaults);
}

TEST(DoctorSoak, AnOptionCorrectsTheClockOfTheLidar) {
  const auto late = std::ranges::find_if(
      kFaults, [](const Fault& fault) { return std::string(fault.repair).starts_with("--imu-minus-lidar-clock"); });
  const fs::path bag = bag_of(test_folder() / "bag", kPeers[0], late);
  const Ended ended = run_program({"doctor", bag.string(), "--imu-minus-lidar-clock", "-0.2"});
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
}

TEST(Odometry, WritesAllFilesOfABagThatNeedsARepair) {
  const fs::path folder = test_folder();
  const fs::path bag = bag_of(folder / "bag", "fast-lio", &kFaults[1]);
  const fs::path out = folder / "out";
  const Ended ended = run_successfully({"odometry", bag.string(), "-o", out.string(), "--json"});
  for (const char* file : {"trajectory.tum", "map.ply", "map.pcd", "estimate.json", "replay.html"})
    EXPECT_GT(fs::file_size(out / file), 100u) << file;
  EXPECT_THAT(read_file(out / "map.pcd"), HasSubstr("FIELDS x y z normal_x normal_y normal_z sigma\n"));
  EXPECT_THAT(ended.err, HasSubstr("the program set the option --gyro-unit deg/s"));
  const json document = json_of(ended);
  const json& summary = document["summary"];
  EXPECT_EQ(summary["health"], "ok");
  EXPECT_GE(summary["sweeps_registered"].get<int>(), 65);
  // after 1.5 to 2 s of rest and a smooth start, the speed is 1.1 to 1.4 m/s
  EXPECT_GT(summary["path_m"].get<double>(), 2.0);
  EXPECT_LT(summary["path_m"].get<double>(), 8.0);
  const auto found = [&](const std::string& item) {
    for (const json& each : document["found"])
      if (each["item"] == item) return each["found"].get<std::string>() + " | " + each["source"].get<std::string>();
    return std::string("missing");
  };
  EXPECT_THAT(found("data sheet of the lidar"), HasSubstr("rs16"));
  EXPECT_THAT(found("unit of the gyro"), HasSubstr("deg/s"));
  EXPECT_THAT(found("pose of the lidar"), HasSubstr("stated"));
  EXPECT_THAT(found("IMU"), HasSubstr("'/imu"));
  EXPECT_THAT(found("robot's own returns"), HasSubstr("only lidar returns nearer than 0.3 m")) << "not our robot";
  const json estimate = json::parse(read_file(out / "estimate.json"));
  EXPECT_FALSE(estimate["health"].contains("localised")) << "no prior map";
  EXPECT_EQ(estimate["settings"].size(), document["found"].size());
  EXPECT_EQ(estimate["settings"][0]["setting"], "format");
  for (const char* key : {"value", "source", "option"}) EXPECT_TRUE(estimate["settings"][0].contains(key)) << key;

  // the estimate fits the imported recording, whose sensors have shorter names
  const std::string imported = (folder / "r.h5").string();
  run_successfully({"import", bag.string(), "-o", imported, "--gyro-unit", "deg/s"});
  EXPECT_EQ(estimate["sensors_digest"], scenarios::digest(scenarios::read_sensors(imported), nullptr));
}

TEST(Doctor, AWrongTopicIsAnErrorOfUse) {
  const fs::path bag = bag_of(test_folder() / "bag", "fast-lio", nullptr);
  const Ended ended = run_program({"doctor", bag.string(), "--imu-topic", "/foo"});
  EXPECT_EQ(ended.status, 2) << ended.out;
  EXPECT_THAT(ended.err, HasSubstr("there is no topic '/foo' (topics of a fitting type: /"));
}

// `run` calls such an estimate diverged, and so do all other verbs
TEST(Odometry, AnEstimateThatItsHealthInvalidatesIsDiverged) {
  const fs::path folder = test_folder();
  const Fault low = {"accelerometer reads 80 %", "", "",
                     [](sim::ImuRecord& imu, sim::LidarRecord&) { scale(imu.accel_m_s2, 0.8); }};
  const std::string bag = bag_of(folder / "bag", "fast-lio", &low).string(), out = (folder / "out").string(),
                    recording = (folder / "r.h5").string(), rates = (folder / "rates").string();
  const Ended odometry = run_program({"odometry", bag, "-o", out, "--json"});
  EXPECT_EQ(odometry.status, 1) << odometry.err;
  EXPECT_TRUE(fs::exists(fs::path(out) / "trajectory.tum"));
  EXPECT_EQ(json_of(odometry)["status"], "diverged");
  EXPECT_THAT(json_of(odometry)["summary"]["health"].get<std::string>(), HasSubstr("diverged: "));
  EXPECT_THAT(json_of(odometry)["message"].get<std::string>(), HasSubstr("health: "));
  EXPECT_THAT(odometry.err, HasSubstr("probably because of a wrong unit or scale of the accelerometer"));

  sim::Sensors sensors = scenarios::read_sensors(short_stroll());
  const sim::Truth truth = scenarios::read_truth(short_stroll());
  scale(sensors.imus.front().accel_m_s2, 0.5);
  scenarios::write_recording(recording, scenarios::read_info(short_stroll()), sensors, &truth);
  const Ended estimate =
      run_successfully({"estimate", recording, "--method", "rate/tumble_lag", "-o", rates, "--json"});
  EXPECT_EQ(json_of(estimate)["status"], "diverged");
  EXPECT_EQ(json_of(run_program({"score", rates, recording, "--json"}))["status"], "diverged");
}

std::map<double, Vector3d> positions_m(const fs::path& trajectory) {
  std::ifstream file(trajectory);
  std::map<double, Vector3d> out;
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    double time_s = 0.0;
    Vector3d p_m;
    if (line.front() != '#' && row >> time_s >> p_m.x() >> p_m.y() >> p_m.z()) out[time_s] = p_m;
  }
  return out;
}

TEST(Odometry, AllPosesAreInTheFrameOfThePriorMap) {
  const fs::path folder = test_folder(), first = folder / "first";
  const std::string recording = short_stroll().string(), map = (folder / "moved.tumblemap").string();
  run_successfully({"odometry", recording, "-o", first.string()});
  const Isometry3d T_MW = Eigen::Translation3d(7.0, -12.0, 3.0) * Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ());
  std::vector<MapPoint> points = scenarios::read_map(first / "map.tumblemap");
  for (MapPoint& point : points) {
    point.position_W_m = T_MW.cast<float>() * point.position_W_m;
    point.normal_W = T_MW.linear().cast<float>() * point.normal_W;
  }
  scenarios::write_prior_map(map, points);

  const auto expect_in_map = [&](const fs::path& out, const std::string& text, std::vector<std::string> options) {
    std::vector<std::string> command{"odometry", recording, "-o", out.string(), "--map", map, "--json"};
    command.insert(command.end(), options.begin(), options.end());
    const Ended ended = run_successfully(command);
    EXPECT_GT(json_of(ended)["health"]["prior_map_sweep"].get<int>(), 0);
    EXPECT_EQ(json_of(ended)["health"]["localised"], 1.0);
    EXPECT_THAT(ended.err, HasSubstr(text));
    EXPECT_THAT(ended.err, Not(HasSubstr("not localised")));
    const std::map<double, Vector3d> p_W_m = positions_m(first / "trajectory.tum"),
                                     p_M_m = positions_m(out / "trajectory.tum");
    ASSERT_GT(p_M_m.size(), 300u);
    for (const auto& [time_s, position_m] : p_M_m) {
      const auto same = p_W_m.lower_bound(time_s - 1e-6);
      if (same == p_W_m.end()) continue;  // the whole recording may end a sweep earlier
      ASSERT_NEAR(same->first, time_s, 0.02);
      ASSERT_LT((position_m - T_MW * same->second).norm(), 0.1) << "at " << time_s << " s";
    }
  };
  expect_in_map(folder / "second", "all poses are in the frame of the map", {});
  expect_in_map(folder / "live", "The trajectory starts there", {"--live"});
}

TEST(Odometry, AWrongPositionOfTheLidarIsFound) {
  const fs::path folder = test_folder();
  const std::string recording = short_stroll().string();
  const Ended right = run_successfully({"odometry", recording, "-o", (folder / "right").string(), "--json"});
  EXPECT_FALSE(json_of(right)["health"].contains("lidar_calibration_replaced"));
  // half a metre from the position in the recording
  const Ended wrong =
      run_successfully({"odometry", recording, "-o", (folder / "wrong").string(), "--json", "--T-body-lidar", "-0.0045",
                        "0.497", "0.1", "0.00497", "-0.002", "-0.707", "0.707"});
  EXPECT_EQ(json_of(wrong)["health"].value("lidar_calibration_replaced", 0.0), 1.0);
  EXPECT_THAT(wrong.err, HasSubstr("contradicts the recording: --T-body-lidar "));
  EXPECT_THAT(read_file(folder / "wrong" / "estimate.json"),
              HasSubstr("The pose before the run was (-0.0045 0.497 0.1)"));
  const Vector3d expected_m = positions_m(folder / "right" / "trajectory.tum").rbegin()->second;
  EXPECT_LT((positions_m(folder / "wrong" / "trajectory.tum").rbegin()->second - expected_m).norm(), 0.15);

  // 0.3 m: the mounting hardly changes, but the change is larger than a correct mounting explains
  const Ended lag =
      run_program({"odometry", recording, "-o", (folder / "lag").string(), "--json", "--method", "slam/tumble_lag",
                   "--T-body-lidar", "-0.0045", "0.297", "0.1", "0.00497", "-0.002", "-0.707", "0.707"});
  EXPECT_EQ(lag.status, 1) << lag.err;
  EXPECT_THAT(json_of(lag)["summary"]["health"].get<std::string>(), HasSubstr("lidar_calibration"));
}

TEST(Odometry, DropsPointsInsideTheGivenBox) {
  const auto map_of = [](const std::string& corner) {
    const std::string out = (test_folder() / ("box" + corner)).string(), low = "-" + corner;
    run_successfully({"odometry", short_stroll().string(), "--own-body", low, low, low, corner, corner, corner, "-o",
                      out, "--live"});
    return fs::file_size(fs::path(out) / "map.ply");
  };
  EXPECT_LT(map_of("3"), map_of("0.3"));
}

TEST(Odometry, RefusesARecordingWithoutALidarAndOptionsThatExcludeEachOther) {
  const fs::path folder = test_folder();
  std::ofstream table(folder / "imu.csv");
  table << "time,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z\n";
  for (int k = 0; k < 200; ++k)
    table << 0.01 * k << "," << 0.001 * (k % 3) << ",0,0,0.01,0," << 9.81 + 0.001 * (k % 5) << "\n";
  table.close();
  const std::string out = (folder / "out").string();
  const Ended imu_only = run_program({"odometry", (folder / "imu.csv").string(), "-o", out});
  EXPECT_EQ(imu_only.status, 2);
  EXPECT_THAT(imu_only.err, HasSubstr("the recording has no lidar"));
  EXPECT_FALSE(fs::exists(out));
  const Ended both = run_program({"odometry", short_stroll().string(), "-o", out, "--live", "--method", "icp"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("--live and --method exclude each other"));
}

}  // namespace
}  // namespace tumble::system_test
