// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_clock.hpp"

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using testing::Pair;

constexpr std::int64_t kFirst_ns = 5'000'000'000;

/// Returns the sensors of each sort alone, with stamps as if the clock had begun long before.
std::vector<sim::Sensors> sorts() {
  const sim::Sensors all = fixture::recording().sensors;
  // this line does not compile when a member is added to Sensors: a new list must be added below, and to
  // recording_clock.cpp and recording_check.cpp, where no compiler error demands it
  const auto& [robot, radius_m, gravity_m_s2, imus, lidars, series] = all;
  std::vector<sim::Sensors> out(3);
  out[0].imus = imus;
  out[1].lidars = lidars;
  out[2].series = series;
  for (sim::ImuRecord& imu : out[0].imus)
    for (std::int64_t& time : imu.time_ns) time += kFirst_ns;
  for (std::int64_t& time : out[1].lidars.at(0).sweep_start_ns) time += kFirst_ns;
  for (std::int64_t& time : out[2].series.at(0).time_ns) time += kFirst_ns;
  return out;
}

TEST(RecordingClock, SpansTheReadingsOfEverySort) {
  const std::vector<sim::Sensors> of = sorts();
  EXPECT_THAT(span_of(of[0]), Pair(of[0].imus[0].time_ns.front(), of[0].imus[0].time_ns.back()));
  EXPECT_THAT(span_of(of[1]), Pair(kFirst_ns, kFirst_ns + 300'000'000));
  EXPECT_THAT(span_of(of[2]), Pair(kFirst_ns + 20'000'000, kFirst_ns + 100'000'000));
  EXPECT_THROW(span_of(sim::Sensors{}), BadInput);
}

TEST(RecordingClock, StartsWithTheFirstReadingOfEverySort) {
  for (const sim::Sensors& sensors : sorts()) {
    Imported imported;
    imported.sensors = sensors;
    const auto [first_ns, last_ns] = span_of(sensors);
    start_clock(imported);
    EXPECT_EQ(imported.info.origin_ns, first_ns);
    EXPECT_THAT(span_of(imported.sensors), Pair(0, last_ns - first_ns));
  }
}

TEST(RecordingClock, ExportsStartWithTheirOwnZero) {
  EXPECT_EQ(export_origin_ns(0), kExportOrigin_ns);
  EXPECT_EQ(export_origin_ns(-5), kExportOrigin_ns);
  EXPECT_EQ(export_origin_ns(1'700'000'000'000'000'000), 1'700'000'000'000'000'000);
  EXPECT_EQ(origin_of(4'000'000), 0);
  EXPECT_EQ(origin_of(kExportOrigin_ns + 4'000'000), kExportOrigin_ns);
  EXPECT_EQ(origin_of(kExportOrigin_ns + 2'000'000'000), kExportOrigin_ns + 2'000'000'000);
}

TEST(RecordingClock, ClocksOfExportsAreConverted) {
  const std::int64_t second = 1'000'000'000;
  const StampSpan recording{0, 10 * second};
  const auto shift = [&](std::int64_t first, std::int64_t last) {
    return clock_shift_ns({first, last}, recording, {0, -kExportOrigin_ns, kExportOrigin_ns});
  };
  EXPECT_EQ(shift(second, 20 * second), 0);
  EXPECT_EQ(shift(kExportOrigin_ns + second, kExportOrigin_ns + 2 * second), -kExportOrigin_ns);
  EXPECT_EQ(shift(-kExportOrigin_ns, -kExportOrigin_ns + second), kExportOrigin_ns);
  EXPECT_EQ(shift(kExportOrigin_ns + 11 * second, kExportOrigin_ns + 12 * second), std::nullopt);
}

// the poses count from zero, and the recording was exported and imported
TEST(RecordingClock, AReferenceFromZeroFitsAnExport) {
  sim::Recording recording = fixture::recording();
  Imported imported;
  imported.sensors = recording.sensors;
  imported.info.origin_ns = kExportOrigin_ns;
  std::vector<ReferencePose> poses;
  for (int k = 0; k < 4; ++k) poses.push_back({10'000'000 * k, Vector3d(k, 0, 0), Eigen::Quaterniond::Identity()});
  attach_poses(imported, poses, Eigen::Isometry3d::Identity(), "poses");
  ASSERT_TRUE(imported.reference.has_value());
  EXPECT_EQ(imported.reference->p_WB_m.at(1).x(), 1.0);
  EXPECT_THAT(imported.notes, Contains(HasSubstr("the time stamps of the reference count from 0 s. "
                                                 "The import shifts these time stamps by 1000000000 s")));
}

}  // namespace
}  // namespace tumble::scenarios
