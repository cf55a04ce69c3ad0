// SPDX-License-Identifier: BSD-3-Clause
// The test checks that point clouds in the fields and units of each driver give the same points, and that damaged
// clouds are rejected.
#include "tumble_ros/point_cloud.hpp"

#include "cloud_message.hpp"
#include "tests/testing.hpp"

namespace tumble {

namespace {

using ros::PointCloudReader;
using ros::TimedSweep;
using test::CloudMessage;
using test::Column;

constexpr TimeNs kStamp_ns = 1'732'700'000'123'456'789;  // in 2024

/// Returns 400 points over 0.1 s, not sorted by time.
std::vector<LidarPoint> some_points() {
  std::vector<LidarPoint> out;
  for (int i = 0; i < 400; ++i) {
    LidarPoint point;
    point.position_L_m = {1.0f + 0.01f * float(i), -2.0f, 0.5f};
    point.offset_ns = std::uint32_t(i * 37 % 400) * 250'000u;
    point.intensity = float(i % 256) / 255.0f;
    point.ring = std::uint16_t(i % 16);
    out.push_back(point);
  }
  return out;
}

double after_s(const LidarPoint& point) {
  return 1e-9 * point.offset_ns;
}
double since_1970_s(const LidarPoint& point) {
  return 1e-9 * double(kStamp_ns + TimeNs(point.offset_ns));
}

struct Dialect {
  const char* name;
  Column time;
  double tolerance_ns;  ///< rounding of the field
  std::vector<Column> more = {};
};

/// At 0.1 s, float32 seconds have a resolution of 7 ns; since 1970, float64 seconds have a resolution of 239 ns and
/// float64 nanoseconds one of 256 ns.
const std::vector<Dialect>& dialects() {
  const Column ring{"ring", 4, [](const LidarPoint& p) { return double(p.ring); }};
  const Column line{"line", 2, [](const LidarPoint& p) { return double(p.ring); }};
  const Column bright{"intensity", 7, [](const LidarPoint& p) { return 255.0 * p.intensity; }};
  const Column reflectivity{"reflectivity", 2, [](const LidarPoint& p) { return 255.0 * p.intensity + 0.5; }};
  static const std::vector<Dialect> all = {
      {"Velodyne", {"time", 7, after_s}, 8.0, {ring, bright}},
      {"VelodyneStampAtEnd",
       {"time", 7, [](const LidarPoint& p) { return after_s(p) - 0.09975; }},
       16.0,
       {ring, bright}},
      {"Ouster", {"t", 6, [](const LidarPoint& p) { return double(p.offset_ns); }}, 0.0, {ring, bright}},
      {"HesaiRoboSense", {"timestamp", 8, since_1970_s}, 480.0, {ring, bright}},
      {"LivoxOffset",
       {"offset_time", 6, [](const LidarPoint& p) { return double(p.offset_ns); }},
       0.0,
       {line, reflectivity}},
      {"LivoxAbsolute",
       {"timestamp", 8, [](const LidarPoint& p) { return 1e9 * since_1970_s(p); }},
       600.0,
       {line, bright}},
      {"Milliseconds", {"time_ms", 7, [](const LidarPoint& p) { return 1e3 * after_s(p); }}, 8.0, {ring, bright}},
      {"Microseconds", {"TIME", 7, [](const LidarPoint& p) { return 1e6 * after_s(p); }}, 8.0, {ring, bright}}};
  return all;
}

CloudMessage message(const Dialect& dialect, const std::vector<LidarPoint>& points) {
  std::vector<Column> columns = test::xyz();
  columns.push_back(dialect.time);
  columns.insert(columns.end(), dialect.more.begin(), dialect.more.end());
  return cloud_message(points, columns);
}

class EveryDriver : public ::testing::TestWithParam<Dialect> {};

TEST_P(EveryDriver, GivesTheSamePoints) {
  const std::vector<LidarPoint> points = some_points();
  const TimeNs stamp_ns = std::string(GetParam().name) == "VelodyneStampAtEnd" ? kStamp_ns + 99'750'000 : kStamp_ns;
  TimedSweep sweep;
  const CloudMessage cloud = message(GetParam(), points);
  ASSERT_TRUE(PointCloudReader().read(cloud.view(stamp_ns), sweep).ok());
  EXPECT_NEAR(double(sweep.start_ns - kStamp_ns), 0.0, GetParam().tolerance_ns);
  EXPECT_NEAR(double(sweep.end_ns - kStamp_ns), 99'750'000.0, 2.0 * GetParam().tolerance_ns);
  ASSERT_EQ(sweep.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(sweep.points[i].position_L_m, points[i].position_L_m);
    EXPECT_NEAR(double(sweep.points[i].offset_ns), double(points[i].offset_ns), 2.0 * GetParam().tolerance_ns);
    EXPECT_LE(sweep.points[i].offset_ns, sweep.end_ns - sweep.start_ns) << "TumblingOdometry rejects later points";
    EXPECT_EQ(sweep.points[i].ring, points[i].ring);
    EXPECT_NEAR(sweep.points[i].intensity, points[i].intensity, 1.0 / 255.0);  // integers of 8 bits
  }
}

INSTANTIATE_TEST_SUITE_P(Dialects, EveryDriver, ::testing::ValuesIn(dialects()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(PointClouds, AnotherClockCountsFromTheStamp) {
  const Dialect uptime{"", {"timestamp", 8, [](const LidarPoint& p) { return 5000.0 + after_s(p); }}, 0.0};
  TimedSweep sweep;
  const CloudMessage cloud = message(uptime, some_points());
  ASSERT_TRUE(PointCloudReader().read(cloud.view(kStamp_ns), sweep).ok());
  EXPECT_EQ(sweep.start_ns, kStamp_ns);
  ASSERT_TRUE(PointCloudReader().read(cloud.view(5'000'000'100'000), sweep).ok());
  EXPECT_EQ(sweep.start_ns, 5'000'000'000'000) << "the same times in the stamp's clock";
}

TEST(PointClouds, LivoxMessagesGiveTheSamePoints) {
  const std::vector<LidarPoint> points = some_points();
  for (const char* frame : {"", "livox_frame", "l"}) {
    const std::vector<std::uint8_t> bytes = test::livox_cdr(kStamp_ns, frame, points);
    ros::LivoxCloud cloud;
    ASSERT_TRUE(cloud.parse(bytes).ok());
    EXPECT_EQ(cloud.frame_id, frame);
    TimedSweep sweep;
    ASSERT_TRUE(PointCloudReader().read(cloud.view(), sweep).ok());
    EXPECT_EQ(sweep.start_ns, kStamp_ns);
    ASSERT_EQ(sweep.points.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(sweep.points[i].position_L_m, points[i].position_L_m);
      EXPECT_EQ(sweep.points[i].offset_ns, points[i].offset_ns);
      EXPECT_EQ(sweep.points[i].ring, points[i].ring);
      EXPECT_NEAR(sweep.points[i].intensity, points[i].intensity, 1.0 / 255.0);
    }
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_EQ(cloud.parse(std::span(bytes).first(size)).error_code, ErrorCode::insufficient_data) << size;
  }
  std::vector<std::uint8_t> big_endian = test::livox_cdr(kStamp_ns, "l", points);
  big_endian[1] = 0;
  EXPECT_EQ(ros::LivoxCloud().parse(big_endian).error_code, ErrorCode::out_of_range);
  const std::vector<std::uint8_t> none = test::livox_cdr(kStamp_ns, "l", {});
  EXPECT_EQ(ros::LivoxCloud().parse(none).error_code, ErrorCode::empty);
}

TEST(PointClouds, MissesAreDropped) {
  std::vector<LidarPoint> points = some_points();
  points[3].position_L_m[1] = std::numeric_limits<float>::quiet_NaN();
  points[7].position_L_m.setZero();
  TimedSweep sweep;
  const CloudMessage cloud = test::ouster_cloud(points);
  ASSERT_TRUE(PointCloudReader().read(cloud.view(0), sweep).ok());
  EXPECT_EQ(sweep.points.size(), points.size() - 2);
}

TEST(PointClouds, RowsMayHavePadding) {
  const std::vector<LidarPoint> points = some_points();
  const CloudMessage tight = test::ouster_cloud(points);
  CloudMessage padded = tight;
  const std::uint32_t row = tight.point_step * 100;
  padded.data.clear();
  for (int k = 0; k < 4; ++k) {
    padded.data.insert(padded.data.end(), tight.data.begin() + k * row, tight.data.begin() + (k + 1) * row);
    padded.data.insert(padded.data.end(), 12, std::uint8_t{255});
  }
  TimedSweep sweep;
  const ros::PointCloudView view{0, 4, 100, padded.fields, false, padded.point_step, row + 12, padded.data};
  ASSERT_TRUE(PointCloudReader().read(view, sweep).ok());
  ASSERT_EQ(sweep.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(sweep.points[i].offset_ns, points[i].offset_ns);
}

// A quarter of a thousandth of a sweep in one time unit would be a whole sweep in the next larger unit.
TEST(PointClouds, TheUnitIsThatOfTheFirstWholeSweep) {
  const std::vector<LidarPoint> points = some_points();
  std::vector<LidarPoint> few;
  for (const LidarPoint& point : points)
    if (point.offset_ns <= 250'000) few.push_back(point);
  ASSERT_EQ(few.size(), 2u);
  PointCloudReader reader;
  TimedSweep sweep;
  const CloudMessage small = test::ouster_cloud(few), whole = test::ouster_cloud(points);
  EXPECT_EQ(reader.read(small.view(0), sweep).error_code, ErrorCode::insufficient_data);
  ASSERT_TRUE(reader.read(whole.view(0), sweep).ok());
  ASSERT_TRUE(reader.read(small.view(0), sweep).ok());
  EXPECT_EQ(sweep.end_ns, 250'000);
}

TEST(PointClouds, DamagedCloudsAreRejected) {
  const std::vector<LidarPoint> points = some_points();
  const CloudMessage fine = test::ouster_cloud(points);
  TimedSweep sweep;
  const auto error_code = [&](const ros::PointCloudView& view) {
    return PointCloudReader().read(view, sweep).error_code;
  };
  ASSERT_EQ(error_code(fine.view(0)), ErrorCode::none);
  ros::PointCloudView view = fine.view(0);
  view.is_bigendian = true;
  EXPECT_EQ(error_code(view), ErrorCode::out_of_range);
  view = fine.view(0);
  view.data = view.data.first(view.data.size() - 1);
  EXPECT_EQ(error_code(view), ErrorCode::out_of_range);
  view = fine.view(0);
  view.height = 0xffffffffu;
  EXPECT_EQ(error_code(view), ErrorCode::out_of_range);
  view = fine.view(0);
  view.point_step = 0;
  EXPECT_EQ(error_code(view), ErrorCode::out_of_range);
  view = fine.view(0);
  view.width = 0;
  EXPECT_EQ(error_code(view), ErrorCode::empty);
  std::vector<ros::PointField> fields = fine.fields;
  fields[3].offset = fine.point_step - 3;
  view = fine.view(0);
  view.fields = fields;
  EXPECT_EQ(error_code(view), ErrorCode::out_of_range) << "a field beyond its point";
  fields = fine.fields;
  fields[1].name = "w";
  view.fields = fields;
  EXPECT_EQ(error_code(view), ErrorCode::empty) << "no y";
  fields = fine.fields;
  fields[3].name = "w";
  view.fields = fields;
  EXPECT_EQ(error_code(view), ErrorCode::empty) << "no times";
}

TEST(PointClouds, TheTimeFieldMustBeUnique) {
  std::vector<Column> columns = test::xyz();
  const auto offset = [](const LidarPoint& p) { return double(p.offset_ns); };
  columns.push_back({"time", 6, offset});
  columns.push_back({"t", 6, [](const LidarPoint& p) { return double(p.offset_ns) + 5e8; }});
  const CloudMessage two = cloud_message(some_points(), columns);
  TimedSweep sweep;
  EXPECT_EQ(PointCloudReader().read(two.view(0), sweep).error_code, ErrorCode::out_of_range);
  ASSERT_TRUE(PointCloudReader("t").read(two.view(0), sweep).ok());
  EXPECT_EQ(sweep.start_ns, 500'000'000);
  EXPECT_EQ(PointCloudReader("ts").read(two.view(0), sweep).error_code, ErrorCode::empty);
  columns[4].name = "t_ns";
  const CloudMessage stated = cloud_message(some_points(), columns);
  ASSERT_TRUE(PointCloudReader().read(stated.view(0), sweep).ok()) << "the field that states its unit";
  EXPECT_EQ(sweep.start_ns, 500'000'000);
}

TEST(PointClouds, EqualAndWildTimesAreRejected) {
  std::vector<LidarPoint> points = some_points();
  TimedSweep sweep;
  points[0].offset_ns = 2'000'000'000;
  std::vector<Column> columns = test::xyz();
  columns.push_back({"t_ns", 6, [](const LidarPoint& p) { return double(p.offset_ns); }});
  const CloudMessage wild = cloud_message(points, columns);
  EXPECT_EQ(PointCloudReader().read(wild.view(0), sweep).error_code, ErrorCode::out_of_range);
  for (LidarPoint& point : points) point.offset_ns = 5;
  const CloudMessage equal = cloud_message(points, columns);
  EXPECT_EQ(PointCloudReader().read(equal.view(0), sweep).error_code, ErrorCode::degenerate);
}

}  // namespace

}  // namespace tumble
