// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_clock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using testing::Pair;

constexpr std::int64_t kFirst_ns = 5'000'000'000;

/// The sensors of one sort alone, for each sort, their stamps as if the clock had begun long before.
std::vector<sim::Sensors> sorts() {
  const sim::Sensors all = fixture::recording().sensors;
  // does not compile when a member joins Sensors: a new list belongs below, and into recording_clock.cpp and
  // recording_check.cpp, of which nothing else reminds
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

}  // namespace
}  // namespace tumble::scenarios
