// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bag_kinds.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/sweep_messages.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::int64_t kOrigin_ns = 1'700'000'000'000'000'000, kMs_ns = 1'000'000;

/// Stamps has a bag of an IMU and a lidar whose headers contain the stamps that each test chooses.
class Stamps : public test::TemporaryFolder, public testing::WithParamInterface<fixture::BagKind> {
 protected:
  using HeaderOf = std::int64_t (*)(std::int64_t record_ns);

  Imported written(HeaderOf imu, HeaderOf lidar, StampSource source = StampSource::header) {
    const fs::path path = folder_ / ("bag" + std::to_string(count_++));
    const auto bag = GetParam().writer(path);
    sim::Recording recording = fixture::recording();
    sim::ImuRecord& readings = recording.sensors.imus[0];
    readings.accel_m_s2.assign(readings.accel_m_s2.size(), Vector3d(0.0, 0.0, 9.8));
    for (std::uint32_t& offset : recording.sensors.lidars[0].offset_ns) offset *= offsets_;
    for (int k = 1; k <= 60; ++k) {
      const std::int64_t record_ns = kOrigin_ns + 5 * kMs_ns * k;
      bag->write("/imu", record_ns,
                 imu_message(readings, static_cast<std::size_t>(k), header_of(imu(record_ns), "imu")));
      if (k % 20 == 0) {
        bag->write("/points", record_ns,
                   sweep_message(recording.sensors.lidars[0], static_cast<std::size_t>(k / 20 - 1), own_sweep_layout(),
                                 lidar(record_ns), header_of(lidar(record_ns), "lidar")));
      }
    }
    bag->finish();
    BagReading reading;
    reading.stamps = source;
    return GetParam().read(path, reading);
  }
  std::string complaint_of(HeaderOf imu, HeaderOf lidar, StampSource source = StampSource::header) {
    return test::complaint([&] { written(imu, lidar, source); });
  }
  static std::int64_t same(std::int64_t record_ns) { return record_ns; }
  static std::int64_t sweep_before(std::int64_t record_ns) { return record_ns - 100 * kMs_ns; }
  static std::int64_t zero(std::int64_t) { return 0; }
  static std::int64_t constant(std::int64_t) { return kOrigin_ns; }
  static std::int64_t long_ago(std::int64_t record_ns) { return record_ns - 3600'000 * kMs_ns; }
  static std::int64_t back(std::int64_t record_ns) { return 2 * kOrigin_ns - record_ns; }
  static std::int64_t since_boot(std::int64_t record_ns) { return record_ns - kOrigin_ns + 1'000'000'000; }
  std::uint32_t offsets_ = 1;  ///< sweep duration relative to the fixture's

 private:
  int count_ = 0;
};

TEST_P(Stamps, HeadersCountAndTheirDistanceToTheRecordsIsSaid) {
  const Imported read = written(same, sweep_before);
  EXPECT_EQ(read.sensors.imus[0].time_ns.front() + read.info.origin_ns, kOrigin_ns + 5 * kMs_ns);
  EXPECT_EQ(read.sensors.lidars[0].sweep_start_ns.front() + read.info.origin_ns, kOrigin_ns);
  EXPECT_THAT(read.notes,
              Contains(AllOf(HasSubstr("/points: the record stamps of the messages are 0.1 s to 0.1 s later than"),
                             HasSubstr("this import uses the stamps of the headers"))));
  EXPECT_THAT(read.notes, Not(Contains(HasSubstr("/imu: the record stamps of the messages"))))
      << "nothing is said of what agrees";
}

TEST_P(Stamps, AnotherClockIsACaution) {
  EXPECT_THAT(written(since_boot, since_boot).notes,
              Contains(AllOf(HasSubstr("/imu: caution: the record stamps of the messages"),
                             HasSubstr("the clocks of sensor and recorder may differ"))));
  EXPECT_THAT(written(since_boot, since_boot, StampSource::record).notes, Not(Contains(HasSubstr("caution"))))
      << "the header stamps are not used";
  const auto ahead = [](std::int64_t record_ns) { return record_ns + 20 * kMs_ns; };
  EXPECT_THAT(
      written(ahead, sweep_before).notes,
      Contains(HasSubstr(
          "/imu: caution: the header stamps of the messages are 0.02 s to 0.02 s later than the record stamps")));
  const auto drifting = [](std::int64_t record_ns) {
    return kOrigin_ns - 700 * kMs_ns + 10 * (record_ns - kOrigin_ns) / 3;
  };
  EXPECT_THAT(written(drifting, sweep_before).notes,
              Contains(AllOf(HasSubstr("/imu: caution: the record stamps of the messages"),
                             HasSubstr("the clock of the sensor or of the recorder may drift"))));
  EXPECT_THAT(written(same, same).notes, Not(Contains(HasSubstr("caution"))));
}

TEST_P(Stamps, TheShiftFromHeadersToRecordsIsKnown) {
  const auto earlier = [](std::int64_t record_ns) { return record_ns - 10'000 * kMs_ns; };
  EXPECT_NEAR(written(same, sweep_before).record_shift_s.value(), 0.0, 1e-9);
  EXPECT_NEAR(written(same, same).record_shift_s.value(), -0.1, 1e-9) << "the sweep is recorded at its end";
  EXPECT_NEAR(written(earlier, earlier).record_shift_s.value(), -0.1, 1e-9);
  EXPECT_FALSE(written(same, same, StampSource::record).record_shift_s);
}

// a driver may stamp a sweep at its end, and count the times of its points from its start
TEST_P(Stamps, PointsBeyondTheirRecordAreACaution) {
  const auto said =
      AllOf(HasSubstr("/points: caution: the last points of a sweep"), HasSubstr("(set '--stamps record'"));
  offsets_ = 600;  // points cover most of a sweep
  EXPECT_THAT(written(same, same).notes, Contains(said));
  EXPECT_THAT(written(same, sweep_before).notes, Not(Contains(said)));
  EXPECT_THAT(written(same, same, StampSource::record).notes, Not(Contains(said)));
}

TEST_P(Stamps, ClocksThatDoNotMeetAreRefusedWithTheWayOut) {
  EXPECT_THAT(complaint_of(same, long_ago), AllOf(HasSubstr("the time ranges of 'points' and 'imu' do not overlap"),
                                                  HasSubstr("set '--stamps record'")));
}

TEST_P(Stamps, APlaceThatNobodyStatesIsSaid) {
  const std::vector<std::string> notes = written(same, sweep_before).notes;
  EXPECT_THAT(notes,
              Contains(HasSubstr("/imu: neither /tf_static nor --lever-arm states the sensor's pose on the body")));
  EXPECT_THAT(
      notes,
      Contains(HasSubstr("/points: neither /tf_static nor --T-body-lidar states the sensor's pose on the body")));
}

TEST_P(Stamps, BrokenHeadersAreRefusedWithTheWayOut) {
  EXPECT_THAT(
      complaint_of(zero, sweep_before),
      AllOf(HasSubstr("message 1 of /imu: the time stamp does not increase: the header stamp is 0 in this message"),
            HasSubstr("the record stamp increases by 0.005 s (set '--stamps record')")));
  EXPECT_THAT(complaint_of(constant, sweep_before), HasSubstr("the header stamp does not change"));
  EXPECT_THAT(complaint_of(back, sweep_before), HasSubstr("the header stamp decreases by 0.005 s"));
  EXPECT_THAT(complaint_of(same, constant), HasSubstr("message 1 of /points: the time stamp does not increase"));
}

TEST_P(Stamps, RecordsAreTakenInstead) {
  for (const HeaderOf broken : {zero, constant, back}) {
    const Imported read = written(broken, broken, StampSource::record);
    ASSERT_EQ(read.sensors.imus[0].time_ns.size(), 60u);
    EXPECT_EQ(read.sensors.imus[0].period_ns, 5 * kMs_ns);
    EXPECT_EQ(read.sensors.imus[0].time_ns.back() + read.info.origin_ns, kOrigin_ns + 300 * kMs_ns);
    ASSERT_EQ(read.sensors.lidars[0].sweep_start_ns.size(), 3u);
    EXPECT_EQ(read.sensors.lidars[0].sweep_start_ns.back() + read.info.origin_ns, kOrigin_ns + 200 * kMs_ns)
        << "recorded when it was over";
    EXPECT_THAT(
        read.notes,
        Contains(AllOf(
            HasSubstr("/points: "), HasSubstr("this import uses the stamps of the records"),
            HasSubstr(
                "the import assumes that each sweep starts 0.100000 s (one sweep period) before its record stamp"))));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Stamps, testing::Values(fixture::kRos1, fixture::kRos2, fixture::kMcap),
                         fixture::name_of);

}  // namespace
}  // namespace tumble::scenarios
