// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {
namespace {

std::vector<std::vector<double>> rows_of(const fs::path& path) {
  std::ifstream stream(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; fields >> field;) rows.back().push_back(std::stod(field));
  }
  return rows;
}

class Export : public test::TemporaryFolder {
 protected:
  sim::Recording recording_ = fixture::recording();
};

TEST_F(Export, TumHoldsTimeAndPoseExactly) {
  export_tum(recording_.truth, folder_ / "truth.tum");
  const auto rows = rows_of(folder_ / "truth.tum");
  ASSERT_EQ(rows.size(), 40u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 8u);
    EXPECT_EQ(rows[i][0], static_cast<double>(i) / 1000.0);
    EXPECT_EQ(Vector3d(rows[i][1], rows[i][2], rows[i][3]), recording_.truth.p_WB_m[i]);
    EXPECT_EQ(Eigen::Vector4d(rows[i][4], rows[i][5], rows[i][6], rows[i][7]), recording_.truth.q_WB[i].coeffs());
  }
}

TEST_F(Export, ATrajectoryIsOfTheFrameThatIsAskedFor) {
  sim::Truth& truth = recording_.truth;
  truth.p_BG_m = {0.01, 0.0, -0.02};
  const auto expect = [&](const std::string& frame, const Isometry3d& T_BA) {
    export_tum(truth, folder_ / "a.tum", 0, frame);
    export_kitti(truth, folder_ / "a.txt", frame);
    const auto poses = rows_of(folder_ / "a.tum"), matrices = rows_of(folder_ / "a.txt");
    ASSERT_EQ(poses.size(), 40u);
    for (const std::size_t i : {std::size_t{0}, std::size_t{23}}) {
      const Isometry3d T_WA = Eigen::Translation3d(truth.p_WB_m[i]) * truth.q_WB[i] * T_BA;
      const Quaterniond q(poses[i][7], poses[i][4], poses[i][5], poses[i][6]);
      EXPECT_TRUE(T_WA.translation().isApprox(Vector3d(poses[i][1], poses[i][2], poses[i][3]), 1e-12)) << frame;
      EXPECT_TRUE(T_WA.linear().isApprox(q.toRotationMatrix(), 1e-12)) << frame;
      EXPECT_NEAR(matrices[i][3], T_WA.translation().x(), 1e-12) << frame;
      EXPECT_NEAR(matrices[i][6], T_WA.linear()(1, 2), 1e-12) << frame;
    }
  };
  truth.imus[0].T_BI = Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY());
  truth.lidars[0].T_BL = Eigen::Translation3d(-0.3, 0.0, 0.1) * Eigen::AngleAxisd(-1.1, Eigen::Vector3d::UnitZ());
  expect("body", Eigen::Isometry3d::Identity());
  expect("centre", Isometry3d(Eigen::Translation3d(truth.p_BG_m)));
  expect(truth.imus[0].name, truth.imus[0].T_BI);
  expect(truth.lidars[0].name, truth.lidars[0].T_BL);
  expect(truth.series[0].name, truth.series[0].T_BX);
  // the export reads the file a segment at a time, and names its origin in the first line
  write_recording(folder_ / "a.h5", fixture::info(), recording_.sensors, &truth);
  ExportChoices choices;
  choices.frame = truth.imus[0].name;
  export_recording(folder_ / "a.h5", "tum", folder_ / "b.tum", choices);
  export_tum(truth, folder_ / "a.tum", export_origin_ns(fixture::info().origin_ns), choices.frame);
  EXPECT_EQ(test::read_file(folder_ / "b.tum"), test::read_file(folder_ / "a.tum"));
  EXPECT_THAT(test::read_file(folder_ / "b.tum"), HasSubstr("true pose of '" + choices.frame + "' in the world"));
  choices.frame = "wheel";
  EXPECT_THAT(test::complaint([&] { export_recording(folder_ / "a.h5", "kitti", folder_ / "c", choices); }),
              HasSubstr("the recording's truth has no frame 'wheel' (known frames: body centre " + truth.imus[0].name));
  EXPECT_FALSE(fs::exists(folder_ / "c"));
}

TEST_F(Export, TumTimesStayExactInLongRecordings) {
  recording_.truth.period_ns = 1234567891;
  export_tum(recording_.truth, folder_ / "truth.tum");
  EXPECT_THAT(test::read_file(folder_ / "truth.tum"), HasSubstr("\n48.148147749 "));
}

TEST_F(Export, KittiHoldsTheMatrixRowByRow) {
  export_kitti(recording_.truth, folder_ / "truth.txt");
  const auto rows = rows_of(folder_ / "truth.txt");
  ASSERT_EQ(rows.size(), 40u);
  ASSERT_EQ(rows[7].size(), 12u);
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows[7].data());
  EXPECT_EQ((T.leftCols<3>()), recording_.truth.q_WB[7].toRotationMatrix());
  EXPECT_EQ((T.col(3)), recording_.truth.p_WB_m[7]);
}

TEST_F(Export, CsvHasAFilePerImuAndOneOfTheTruth) {
  export_csv(recording_.sensors, &recording_.truth, folder_ / "csv");
  EXPECT_TRUE(fs::exists(folder_ / "csv/imu.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "csv/imu_reference.csv"));
  const sim::SeriesRecord& barometer = recording_.sensors.series.at(0);
  std::istringstream series(test::read_file(folder_ / "csv/barometer.csv"));
  std::string line;
  ASSERT_TRUE(std::getline(series, line));
  EXPECT_EQ(line, "stamp_s,stamp_ns,frame_id,pressure_pa,temperature_k");
  ASSERT_TRUE(std::getline(series, line));
  ASSERT_THAT(line, StartsWith("0,20000000,barometer,"));
  EXPECT_EQ(std::stod(line.substr(std::string("0,20000000,barometer,").size())), barometer.quantities[0].values[0]);
  const std::string truth = test::read_file(folder_ / "csv/truth.csv");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 41);
  export_csv(recording_.sensors, nullptr, folder_ / "real");
  EXPECT_FALSE(fs::exists(folder_ / "real/truth.csv"));
}

TEST_F(Export, EachOfTwoSensorsOfOneNameHasAFrame) {
  sim::Truth& truth = recording_.truth;
  ASSERT_GE(truth.imus.size(), 2u);
  truth.imus[0].name = truth.imus[1].name = "imu";
  truth.imus[0].T_BI = Eigen::Translation3d(0.1, 0.0, 0.0);
  truth.imus[1].T_BI = Eigen::Translation3d(0.2, 0.0, 0.0);
  EXPECT_EQ(true_mounting(truth, "imu").translation().x(), 0.1);
  EXPECT_EQ(true_mounting(truth, "imu_2").translation().x(), 0.2);
  truth.imus[1].name = "/imu/data";  // this name cannot be a file name
  EXPECT_EQ(true_mounting(truth, "imu_1").translation().x(), 0.2);
  EXPECT_EQ(true_mounting(truth, "/imu/data").translation().x(), 0.2);
  EXPECT_THROW(true_mounting(truth, "imu_2"), BadInput);
}

TEST_F(Export, NoFileOfASensorIsWrittenOverAnother) {
  recording_.sensors.imus[0].name = "truth";
  recording_.sensors.imus[1].name = recording_.truth.imus[1].name = "imu";
  fixture::Numbers numbers;
  fixture::add_lidar(numbers, recording_, "lidar", 2, 4);
  write_recording(folder_ / "a.h5", fixture::info(), recording_.sensors, &recording_.truth);
  EXPECT_THAT(
      export_recording(folder_ / "a.h5", "csv", folder_ / "csv"),
      ElementsAre("name conflict in the export: 'truth' is reserved for another topic or frame, so the sensor IMU 0 is "
                  "exported as 'truth_2'",
                  "the sweeps of the lidar are left out; export them with --format pcd or --format ply"));
  const auto lines = [&](const char* file) {
    const std::string text = test::read_file(folder_ / "csv" / file);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines("truth.csv"), 41);
  EXPECT_EQ(lines("truth_2.csv"), 71);
  EXPECT_EQ(lines("imu.csv"), 71);
  EXPECT_THAT(export_recording(folder_ / "a.h5", "pcd", folder_ / "pcd"),
              ElementsAre("name conflict in the export: 'lidar' is the name of another sensor, so the sensor lidar 1 "
                          "is exported as 'lidar_2'"));
  EXPECT_TRUE(fs::exists(folder_ / "pcd/lidar_000002.pcd"));
  EXPECT_TRUE(fs::exists(folder_ / "pcd/lidar_2_000001.pcd"));
}

TEST(ExportNames, ASensorGivesWayOnlyToAnother) {
  const auto named = [](const std::vector<std::string>& imus, const std::vector<std::string>& lidars) {
    sim::Sensors sensors;
    for (const std::string& name : imus) sensors.imus.emplace_back().name = name;
    for (const std::string& name : lidars) sensors.lidars.emplace_back().name = name;
    return export_names(sensors);
  };
  const ExportNames alone = named({"imu", "imu_reference"}, {"lidar"});
  EXPECT_THAT(alone.imus.names, ElementsAre("imu", "imu_reference"));
  EXPECT_THAT(alone.lidars.names, ElementsAre("lidar"));
  EXPECT_TRUE(alone.imus.notes.empty() && alone.lidars.notes.empty());
  // only the third sensor has that name alone, so it keeps the name
  EXPECT_THAT(named({"a", "a", "a_2"}, {}).imus.names, ElementsAre("a", "a_3", "a_2"));
  const ExportNames mixed = named({"os", "no name of a file", "imu_1"}, {"os", "os"});
  EXPECT_THAT(mixed.imus.names, ElementsAre("os", "imu_1_2", "imu_1"));
  EXPECT_THAT(mixed.lidars.names, ElementsAre("os_2", "os_3"));
  EXPECT_THAT(mixed.lidars.notes, ElementsAre("name conflict in the export: 'os' is the name of another sensor, so the "
                                              "sensor lidar 0 is exported as 'os_2'",
                                              "name conflict in the export: 'os' is the name of another sensor, so the "
                                              "sensor lidar 1 is exported as 'os_3'"));
  for (const char* name : {"truth", "body", "world", "map", "odom", "base_link", "tf", "tf_static", "clock"})
    EXPECT_THAT(named({}, {name}).lidars.names, ElementsAre(std::string(name) + "_2"));
}

TEST_F(Export, ANameCannotLeadOutOfTheFolder) {
  recording_.sensors.imus[0].name = "../outside";
  export_csv(recording_.sensors, nullptr, folder_ / "csv");
  EXPECT_FALSE(fs::exists(folder_ / "outside.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "csv/imu_0.csv"));
}

TEST_F(Export, EveryFormatGoesFromFileToFile) {
  write_recording(folder_ / "a.h5", fixture::info(), recording_.sensors, &recording_.truth);
  ASSERT_EQ(export_formats().size(), 9u);
  for (const std::string& format : export_formats()) {
    export_recording(folder_ / "a.h5", format, folder_ / format);
    EXPECT_TRUE(fs::exists(folder_ / format)) << format;
  }
  EXPECT_EQ(rows_of(folder_ / "tum").size(), 40u);
}

TEST_F(Export, WrongUseIsNamed) {
  write_recording(folder_ / "real.h5", {}, recording_.sensors, nullptr);
  const auto complaint_of = [&](const std::string& format, const fs::path& out) {
    return test::complaint([&] { export_recording(folder_ / "real.h5", format, out); });
  };
  EXPECT_THAT(complaint_of("tums", folder_ / "x"), HasSubstr("unknown export format 'tums' (did you mean 'tum'?)"));
  EXPECT_THAT(complaint_of("tum", folder_ / "x"), HasSubstr("has no truth"));
  EXPECT_THAT(complaint_of("csv", folder_ / "real.h5"), HasSubstr("cannot be written"));
  sim::Sensors no_lidar = recording_.sensors;
  no_lidar.lidars.clear();
  EXPECT_THAT(test::complaint([&] { export_ply(no_lidar, folder_ / "x"); }), HasSubstr("no lidar"));
  EXPECT_FALSE(fs::exists(folder_ / "x"));
}

}  // namespace
}  // namespace tumble::scenarios
