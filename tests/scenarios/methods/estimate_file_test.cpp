// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/methods/registry.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/estimates/map_file.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/recordings/table_file.hpp"
#include "scenarios/scoring/score.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

class EstimateFile : public test::TemporaryFolder {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    TemporaryFolder::write(name, text);
    return folder_ / name;
  }

  std::string complaint(const fs::path& path) const {
    Kind kind;
    std::string method;
    return test::complaint([&] { read_estimate(path, kind, method, Frame::imu); });
  }
};

TEST_F(EstimateFile, ScoresOfWhatIsReadBackAreTheSame) {
  // this recording is half as long as the recording of other tests
  const sim::Recording rig =
      testing::synthetic_rig({.angle_rad = 12.0, .start_s = 1.0, .end_s = 2.6, .duration_s = 3.2});
  const sim::Recording sphere = testing::synthetic_sphere();
  for (const Method& method : methods()) {
    const sim::Recording& recording = method.info.applies_to({"rig"}) ? rig : sphere;
    const Estimate estimate = method.run(recording.sensors, {}, {&recording.truth});
    ASSERT_TRUE(estimate.status.ok()) << method.info.name;
    write_estimate(folder_, method.info.name, method.info.kind, estimate);
    Kind kind;
    std::string name;
    const Estimate back = read_estimate(folder_, kind, name, Frame::lidar);
    EXPECT_EQ(kind, method.info.kind);
    EXPECT_EQ(name, method.info.name);
    EXPECT_EQ(back.frame, estimate.frame);
    EXPECT_EQ(back.health, estimate.health);
    EXPECT_EQ(back.faults.findings.size(), estimate.faults.findings.size());
    EXPECT_EQ(back.parameters, estimate.parameters);
    EXPECT_EQ(back.map.size(), estimate.map.size());
    const ScoringInput input{&recording.sensors, &recording.truth, nullptr};
    const auto before = score(kind, {estimate, input});
    const auto after = score(kind, {back, input});
    ASSERT_EQ(before.size(), after.size()) << method.info.name;
    ASSERT_GT(before.size(), 0u);
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_EQ(before[k].metric, after[k].metric);
      // reading a quaternion normalises it, which changes its last bit
      EXPECT_NEAR(before[k].value, after[k].value, 1e-12 * (1.0 + std::abs(before[k].value))) << before[k].metric;
    }
  }
}

TEST_F(EstimateFile, AStatusThatIsNotOkComesBack) {
  Estimate failed;
  failed.status = {ErrorCode::gap, "imu.time_ns", 2.0, 1.0};
  write_estimate(folder_, "raw", Kind::rate, failed);
  Kind kind;
  std::string method;
  EXPECT_EQ(read_estimate(folder_, kind, method, Frame::imu).status.error_code, ErrorCode::gap);
}

TEST_F(EstimateFile, StatesTheOriginOfTheRecordingsClock) {
  write_estimate(folder_, "raw", Kind::rate, {}, "", 1'700'000'000'123'456'789);
  std::ifstream file(folder_ / "estimate.json");
  EXPECT_EQ(nlohmann::json::parse(file)["origin_ns"], 1'700'000'000'123'456'789);
}

TEST_F(EstimateFile, WhatAProgramSaidStandsBesideItAndGoesWithIt) {
  Estimate failed;
  failed.transcript = "out of luck\n";
  write_estimate(folder_, "theirs", Kind::rate, failed);
  std::string said;
  std::getline(std::ifstream(folder_ / "transcript.txt"), said);
  EXPECT_EQ(said, "out of luck");
  write_estimate(folder_, "raw", Kind::rate, {});
  EXPECT_FALSE(fs::exists(folder_ / "transcript.txt"));
}

TEST_F(EstimateFile, ReadsATumFileOfSomebodyElse) {
  // the file has comments, several blanks, fewer digits, and an epoch stamp that no double represents to the nanosecond
  const auto path = write("theirs.tum",
                          "# time x y z qx qy qz qw\n"
                          "1689175049.435000123 1 2 3 0 0 0 1\n"
                          "1689175049.440000123  1.5 2 3  0 0 0.7071068 0.7071068\n");
  Kind kind;
  std::string method;
  const Estimate estimate = read_estimate(path, kind, method, Frame::lidar);
  EXPECT_EQ(kind, Kind::position);
  EXPECT_EQ(method, "theirs");
  EXPECT_EQ(estimate.frame, Frame::lidar);
  ASSERT_EQ(estimate.poses.size(), 2u);
  EXPECT_EQ(estimate.poses[0].time_ns, 1689175049435000123);
  EXPECT_EQ(estimate.poses[1].position_W_m, Vector3d(1.5, 2, 3));
  EXPECT_NEAR(estimate.poses[1].orientation_W.norm(), 1.0, 1e-15);
}

TEST_F(EstimateFile, ComplaintsNameFileAndLine) {
  EXPECT_NE(complaint(folder_ / "absent.tum").find("absent.tum: no such file"), std::string::npos);
  EXPECT_NE(complaint(write("a.tum", "0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 0\n"))
                .find("a.tum:2: the row has 7 columns; it must have 8"),
            std::string::npos);
  EXPECT_NE(complaint(write("b.tum", "0 1 2 x 0 0 0 1\n")).find("b.tum:1: 'x' is not a number"), std::string::npos);
  EXPECT_NE(
      complaint(write("nan.tum", "0 1 2 3 0 0 0 1\n1 nan 2 3 0 0 0 1\n")).find("nan.tum:2: the pose is not finite"),
      std::string::npos);
  EXPECT_NE(complaint(write("d.tum", "0 1 2 3 0 0 0 1e200\n")).find("d.tum:1: the quaternion has norm 1e+200"),
            std::string::npos);
  EXPECT_NE(complaint(write("c.tum", "0 1 2 3 0 0 0 0\n")).find("c.tum:1: the quaternion has norm"), std::string::npos);
  EXPECT_NE(complaint(write("d.tum", "1 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n")).find("d.tum:2: time stamps must increase"),
            std::string::npos);
  EXPECT_NE(complaint(write("f.tum", "0 1 2 3 0 0 0 1\n1.-5 1 2 3 0 0 0 1\n")).find("f.tum:2: '1.-5' is not"),
            std::string::npos);
  EXPECT_NE(complaint(write("e.tum", "")).find("no pose"), std::string::npos);
  EXPECT_NE(complaint(folder_).find("estimate.json"), std::string::npos);
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"null", "the file is not a JSON object"},
           {R"({"format": "1"})", R"('format' is "1"; it must be 1)"},
           {R"({"format": 1})", "'method' is missing"},
           {R"({"format": 1, "method": 5})", "'method' is 5; it must be text"},
           {R"({"format": 1, "method": "a", "kind": "slan"})",
            R"('kind' is "slan"; it must be one of rate, attitude, position, slam)"},
           {R"({"format": 1, "method": "a", "kind": "rate", "frame": "imu", "status": null})",
            "'status' is null; it must be an object"},
           {R"({"format": 1, "method": "a", "kind": "rate", "frame": "imu", "status": {}})", "'trouble' is missing"}}) {
    write("estimate.json", text);
    EXPECT_NE(complaint(folder_).find("estimate.json: " + says), std::string::npos) << complaint(folder_);
  }
  write("estimate.json", "{\"format\": 1, ");
  EXPECT_NE(complaint(folder_).find("estimate.json"), std::string::npos);
}

// without this check, the reader would read an endless device such as /dev/zero into memory
TEST_F(EstimateFile, ALineWithoutEndIsRefused) {
  const std::string said = complaint(write("z.tum", "0 1 2 3 0 0 0 1\n" + std::string((1 << 20) + 1, '\0')));
  EXPECT_NE(said.find("z.tum:2: the line has more than 1048576 bytes, so the file is not a table of numbers"),
            std::string::npos)
      << said;
  EXPECT_NE(complaint("/dev/zero").find("/dev/zero:1: the line has more than"), std::string::npos);
}

TEST_F(EstimateFile, ATruncatedMapIsRecognised) {
  Estimate estimate;
  estimate.map.resize(10);
  write_estimate(folder_, "icp", Kind::slam, estimate);
  EXPECT_EQ(complaint(folder_), "");
  fs::resize_file(folder_ / "map.ply", fs::file_size(folder_ / "map.ply") - 5);
  EXPECT_THAT(complaint(folder_), HasSubstr("map.ply: the map cannot be read"));
}

Estimate three_poses() {
  Estimate estimate;
  estimate.poses.resize(3);
  for (int k = 0; k < 3; ++k) estimate.poses[static_cast<std::size_t>(k)].time_ns = 5'000'000 * k;
  return estimate;
}

TEST_F(EstimateFile, ContactsComeBackAndBelongToTheirPoses) {
  Estimate estimate = three_poses();
  estimate.contacts = {sim::ContactLabel::grip, sim::ContactLabel::slide, sim::ContactLabel::air};
  write_estimate(folder_, "tumble", Kind::position, estimate);
  Kind kind;
  std::string method;
  EXPECT_EQ(read_estimate(folder_, kind, method, Frame::imu).contacts, estimate.contacts);

  write("contacts.csv", "time_ns,label\n0,1\n5000000,3\n");
  EXPECT_NE(complaint(folder_).find("contacts.csv: the file has 2 rows; it must have 3"), std::string::npos);
  write("contacts.csv", "time_ns,label\n0,1\n5000000,3\n11000000,0\n");
  EXPECT_NE(complaint(folder_).find("contacts.csv:4: the time is"), std::string::npos);
  write("contacts.csv", "time_ns,label\n0,1\n5000000,4\n10000000,0\n");
  EXPECT_NE(complaint(folder_).find("contacts.csv:3: unknown label 4"), std::string::npos);
  estimate.contacts.pop_back();
  EXPECT_THROW(write_estimate(folder_, "tumble", Kind::position, estimate), std::invalid_argument);
}

TEST_F(EstimateFile, UncertainEventsComeBackWithTheirContacts) {
  Estimate estimate = three_poses();
  estimate.contacts = {sim::ContactLabel::grip, sim::ContactLabel::slip, sim::ContactLabel::slip};
  estimate.uncertain = {false, true, true};
  write_estimate(folder_, "tumble", Kind::position, estimate);
  Kind kind;
  std::string method;
  const Estimate back = read_estimate(folder_, kind, method, Frame::imu);
  EXPECT_EQ(back.uncertain, estimate.uncertain);
  EXPECT_EQ(back.contacts, estimate.contacts);
  std::ifstream file(folder_ / "contacts.csv");
  std::string header, first, second;
  std::getline(std::getline(std::getline(file, header), first), second);
  EXPECT_EQ(header, "time_ns,label,uncertain");
  EXPECT_EQ(first, "0,1,0");
  EXPECT_EQ(second, "5000000,2,1");

  write("contacts.csv", "time_ns,label,uncertain\n0,1,0\n5000000,2,2\n10000000,2,1\n");
  EXPECT_NE(complaint(folder_).find("contacts.csv:3: column 'uncertain' is 2; it must be 0 or 1"), std::string::npos);
  estimate.uncertain.pop_back();
  EXPECT_THROW(write_estimate(folder_, "tumble", Kind::position, estimate), std::invalid_argument);
}

TEST_F(EstimateFile, NothingOfAnEarlierEstimateStays) {
  Estimate with_map;
  with_map.map.resize(3);
  write_estimate(folder_, "icp", Kind::slam, with_map);
  write_estimate(folder_, "icp", Kind::slam, Estimate{});
  Kind kind;
  std::string method;
  EXPECT_EQ(read_estimate(folder_, kind, method, Frame::imu).map.size(), 0u);
}

// the program writes the file under a temporary name and then renames the file
TEST_F(EstimateFile, WhatIsNotFinishedReplacesNothing) {
  const fs::path path = write("rates.csv", "old\n");
  const auto text = [&] { return test::read_file(path); };
  {
    TableWriter table(path, ',', "a,b");
    for (int k = 0; k < 100000; ++k) {
      table.integer(k);
      table.number(0.5);
      table.end_row();
    }
  }  // as with a full disk, or if the run crashes
  EXPECT_EQ(text(), "old\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "nothing is left beside it";
  TableWriter table(path, ',', "a,b");
  table.integer(1);
  table.integer(2);
  table.end_row();
  EXPECT_EQ(text(), "old\n");
  table.close();
  EXPECT_EQ(text(), "a,b\n1,2\n");
}

TEST_F(EstimateFile, OnlyRegularFilesAreReplaced) {
  fs::create_symlink("/dev/null", folder_ / "link");
  EXPECT_THROW(TableWriter(folder_ / "link", ',', "a"), BadInput);
  EXPECT_THROW(write_map(folder_ / "link", std::vector<MapPoint>(3)), BadInput);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(EstimateFile, AFolderThatCannotBeMadeIsBadInput) {
  write("file", "");
  EXPECT_THROW(write_estimate(folder_ / "file" / "below", "raw", Kind::rate, Estimate{}), BadInput);
}

using MapFile = test::TemporaryFolder;

std::vector<MapPoint> some_map() {
  std::vector<MapPoint> map(500);
  for (std::size_t k = 0; k < map.size(); ++k) {
    const float x = 0.37f * static_cast<float>(k);
    map[k] = {{x, -1.0f / (1.0f + x), 1e-6f * x}, Vector3f(std::sin(x), 0.0f, std::cos(x)), 0.001f * x};
  }
  map[7].normal_W.setZero();
  return map;
}

void expect_equal(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].position_W_m, b[k].position_W_m) << k;
    ASSERT_EQ(a[k].normal_W, b[k].normal_W) << k;
    ASSERT_EQ(a[k].sigma_m, b[k].sigma_m) << k;
  }
}

TEST_F(MapFile, PlyGivesBackEveryBit) {
  const std::vector<MapPoint> map = some_map();
  write_map(folder_ / "map.ply", map);
  expect_equal(read_map(folder_ / "map.ply"), map);
}

}  // namespace
}  // namespace tumble::scenarios
