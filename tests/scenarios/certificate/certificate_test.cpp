// SPDX-License-Identifier: BSD-3-Clause
// The test checks that every row of the certificate passes on this build, and fails when one part of its set-up is
// wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/certificate/rows.hpp"
#include "scenarios/errors.hpp"
#include "stand_ins/short_scenario.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

CertificateInput input() {
  return {DataRoot{test::source_dir()}, test::program()};
}

/// Returns "row (subject)" of every entry that does not pass.
std::vector<std::string> failures(const std::vector<CertificateEntry>& entries) {
  std::vector<std::string> names;
  for (const CertificateEntry& entry : entries) {
    if (!entry.passes()) names.push_back(entry.row + " (" + entry.subject + ")");
  }
  return names;
}

TEST(Certificate, OfThisBuildPassesAndSaysWhatItMeasured) {
  std::vector<std::string> announced;
  CertifyOptions options;
  options.on_row = [&](const CertificateRow& row, double) { announced.push_back(row.name); };
  // the certificate is measured over the data of the sweep tests, so that those measure no certificate of their own
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("tumble_certificate_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const DataRoot data{test::write_short_data(folder)};
  const Certificate certificate = measure_certificate({data, test::program()}, options);
  CertificateStore(test::certificates(), data).keep(certificate);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(announced.size(), certificate_rows().size());
  EXPECT_THAT(failures(certificate.entries), IsEmpty());
  EXPECT_TRUE(certificate.passes());
  EXPECT_FALSE(certificate.build.empty());
  std::set<std::pair<std::string, std::string>> keys;
  for (const CertificateEntry& entry : certificate.entries) {
    EXPECT_TRUE(keys.insert({entry.row, entry.subject}).second) << entry.row << " " << entry.subject << " twice";
    EXPECT_TRUE(std::isfinite(entry.value)) << entry.row << ": " << entry.note;
    EXPECT_FALSE(entry.law.empty()) << entry.row;
    EXPECT_FALSE(entry.unit.empty()) << entry.row;
    EXPECT_LE(entry.low, entry.high) << entry.row;
  }
}

TEST(Certificate, WithoutEntriesDoesNotPass) {
  EXPECT_FALSE(Certificate{}.passes());
  CertificateEntry entry{"row", "subject", "law", "1", std::nan(""), 0.0, 1.0, ""};
  EXPECT_FALSE(entry.passes());
  entry.value = 1.0;
  EXPECT_TRUE(entry.passes());
}

TEST(Certificate, UnknownRowNamesTheNearest) {
  CertifyOptions options;
  options.rows = {"free_fligth"};
  try {
    measure_certificate(input(), options);
    FAIL() << "an unknown row was accepted";
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("'free_flight'"));
  }
}

TEST(Certificate, StopsBetweenRows) {
  std::atomic<bool> stop = false;
  CertifyOptions options;
  options.rows = {"flight_force", "free_fall"};
  options.stop = &stop;
  options.on_row = [&](const CertificateRow&, double) { stop = true; };
  EXPECT_EQ(measure_certificate(input(), options).entries.size(), 1u);
}

TEST(Rows, EulerIntegrationFailsEnergyAndMomentum) {
  FreeFlightSetup setup;
  setup.integrator = sim::Integrator::euler;
  EXPECT_THAT(failures(certify_free_flight(input(), setup)),
              testing::ElementsAre("free_flight_energy (rig)", "free_flight_momentum (rig)"));
}

TEST(Rows, ALeverArmOfOneMillimetreFailsTheSpecificForce) {
  FlightForceSetup setup;
  setup.lever_arm_m = 0.001;
  const std::vector<CertificateEntry> entries = certify_flight_force(input(), setup);
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_FALSE(entries[0].passes());
  EXPECT_NEAR(entries[0].value, 18.0 * 18.0 * 0.001, 0.02);  // w^2 r; the small rates of the other axes change little
}

TEST(Rows, ADropFromElsewhereFailsTheFreeFall) {
  FreeFallSetup setup;
  setup.stated_height_m = 0.99;  // 2.3 ms earlier, 4.5 steps
  EXPECT_THAT(failures(certify_free_fall(input(), setup)), testing::SizeIs(1));
}

TEST(Rows, AnotherRadiusFailsTheRollingLawOnEachGround) {
  RollingSetup setup;
  setup.stated_radius_m = 0.148;  // 2 %
  const std::vector<CertificateEntry> entries = certify_rolling(input(), setup);
  ASSERT_GT(entries.size(), 2u);
  EXPECT_EQ(failures(entries).size(), entries.size());
}

TEST(Rows, AnotherFrictionFailsTheSlipToGripTime) {
  SlipToGripSetup setup;
  setup.friction = 0.102;
  EXPECT_THAT(failures(certify_slip_to_grip(input(), setup)), testing::SizeIs(1));
}

TEST(Rows, ALongStepFailsTheImpactPeak) {
  ImpactSetup setup;
  setup.step_s = 0.008;
  EXPECT_THAT(failures(certify_impact(input(), setup)), testing::Contains("impact_peak_step (rig)"));
}

TEST(Rows, SoftnessThatTheEngineCannotFollowFailsItsExponent) {
  ImpactSetup setup;
  // the simulator keeps the time constant of a contact above two steps: below that, a smaller value changes nothing
  setup.soft_s = 0.008;
  setup.hard_s = 0.005;
  setup.step_s = 0.004;
  EXPECT_THAT(failures(certify_impact(input(), setup)), testing::Contains("impact_peak_softness (rig)"));
}

TEST(Rows, TwoMillimetresOfRangeFailTheLidar) {
  LidarRangeSetup setup;
  setup.added_range_m = 0.002;
  EXPECT_THAT(failures(certify_lidar_range(input(), setup)),
              testing::ElementsAre("lidar_range_analytic (rs16)", "lidar_range_analytic (mid100)"));
}

TEST(Rows, AMirrorLiftedByTwoMillimetresFailsTheRays) {
  LidarRaysSetup setup;
  setup.rays = 320;
  setup.mirror_shift_m = 0.002;
  EXPECT_THAT(failures(certify_lidar_rays(input(), setup)), testing::Contains("lidar_range_engine (hill)"));
}

TEST(Rows, AMirrorThatNamesOtherSurfacesFailsTheRays) {
  LidarRaysSetup setup;
  setup.rays = 320;
  setup.surface_shift = 1;
  const std::vector<std::string> failed = failures(certify_lidar_rays(input(), setup));
  for (const char* world : {"hill", "corridor", "tube"}) {
    EXPECT_THAT(failed, testing::Contains("lidar_surface_engine (" + std::string(world) + ")"));
  }
}

TEST(Rows, FivePerCentMoreNoiseFailsTheImus) {
  ImuNoiseSetup setup;
  setup.noise_factor = 1.05;
  const std::vector<std::string> failed = failures(certify_imu_noise(input(), setup));
  for (const char* device : {"mti30", "vn100", "phidget1044"}) {
    EXPECT_THAT(failed, testing::Contains("imu_white_noise (" + std::string(device) + " gyro)"));
    EXPECT_THAT(failed, testing::Contains("imu_white_noise (" + std::string(device) + " accel)"));
  }
}

TEST(Rows, TwiceTheBiasFailsTheImus) {
  ImuNoiseSetup setup;
  setup.bias_factor = 2.0;
  const std::vector<std::string> failed = failures(certify_imu_noise(input(), setup));
  for (const char* device : {"mti30", "vn100", "phidget1044"}) {
    EXPECT_THAT(failed, testing::Contains("imu_bias_instability (" + std::string(device) + " gyro)"));
    EXPECT_THAT(failed, testing::Contains("imu_bias_instability (" + std::string(device) + " accel)"));
  }
  for (const char* walking : {"mti30 gyro", "mti30 accel", "vn100 gyro", "vn100 accel"}) {
    EXPECT_THAT(failed, testing::Contains("imu_bias_walk (" + std::string(walking) + ")"));
  }
}

TEST(Rows, ATiltOfTwoTenThousandthsFailsTheTiltedRail) {
  TiltedRailSetup setup;
  setup.devices = 1;
  EXPECT_THAT(failures(certify_tilted_rail(input(), setup)), IsEmpty());
  setup.assumed_tilt = 2e-4;  // a tenth of the tilt tolerance of real devices
  EXPECT_THAT(failures(certify_tilted_rail(input(), setup)),
              testing::ElementsAre("tilted_rail_slope (mti30 gyro)", "tilted_rail_slope (mti30 accel)"));
}

TEST(Rows, WithoutADeviceTheTiltedRailSaysNothing) {
  TiltedRailSetup setup;
  setup.devices = 0;
  EXPECT_EQ(failures(certify_tilted_rail(input(), setup)).size(), 4u);
}

/// Returns which rows fail for the planes measured on real gyros, after a check that one of them passes.
std::vector<std::string> real_rail_failures(RealRailsSetup setup) {
  setup.devices = 100;
  return failures(certify_real_rails(input(), setup));
}

TEST(Rows, ALevelRailIsNoneOfTheRealOnes) {
  EXPECT_THAT(real_rail_failures({}), IsEmpty());
  // the rows of a slope whose interval contains 0 are measured without a sign, so they fail for a level plane too
  EXPECT_THAT(real_rail_failures({.tilt_factor = 0.0}),
              testing::ElementsAre("real_rail_slope (wand x, z)", "real_rail_slope (wand y, z)",
                                   "real_rail_slope (pendulum z, x)", "real_rail_slope (pendulum z, y)"));
  EXPECT_THAT(real_rail_failures({.tilt_factor = -1.0}), testing::Contains("real_rail_slope (wand y, x)"));
}

TEST(Rows, ATiltOfOneHundredthMoreIsNoneOfTheRealRails) {
  EXPECT_THAT(real_rail_failures({.added_tilt = 0.01}),
              testing::ElementsAre("real_rail_slope (wand x, y)", "real_rail_slope (wand x, z)",
                                   "real_rail_slope (wand y, z)", "real_rail_slope (wand y, x)",
                                   "real_rail_slope (pendulum z, x)", "real_rail_slope (pendulum z, y)"));
}

TEST(Rows, ARailAThousandthHigherIsNoneOfTheRealOnes) {
  EXPECT_THAT(real_rail_failures({.rail_factor = 1.001}),
              testing::ElementsAre("real_rail_distance (wand x)", "real_rail_distance (wand y)",
                                   "real_rail_distance (pendulum z)"));
}

TEST(Rows, AnotherOffsetOfTheElementsIsNoneOfTheRealOnes) {
  EXPECT_THAT(
      real_rail_failures({.added_offset_rad_s = 0.01}),
      testing::ElementsAre("real_rail_offset (wand x)", "real_rail_offset (wand y)", "real_rail_offset (pendulum z)"));
}

TEST(Rows, ElementsDrawnHalfAsWideDoNotReachTheRealRails) {
  const std::vector<std::string> failed = real_rail_failures({.spread_factor = 0.5});
  for (const char* device : {"mti30", "vn100", "phidget1044", "mpu6050"})
    EXPECT_THAT(failed, testing::Contains("real_rail_slope_drawn (" + std::string(device) + " gyro)"));
  for (const char* device : {"mti30", "vn100", "phidget1044"})
    EXPECT_THAT(failed, testing::Contains("real_rail_offset_drawn (" + std::string(device) + " gyro)"));
  // the data sheet of the fourth device states offsets more than twice as wide
  EXPECT_THAT(real_rail_failures({.spread_factor = 0.3}), testing::Contains("real_rail_offset_drawn (mpu6050 gyro)"));
}

TEST(Rows, UprightElementsDoNotReachTheRealRails) {
  const std::vector<std::string> failed = real_rail_failures({.spread_factor = 0.0});
  EXPECT_EQ(failed.size(), 32u);  // slope and offset of each of the sixteen data sheets
}

TEST(Rows, APendulumOfAnotherLengthFailsEnergyAndPeriods) {
  PendulumSetup setup;
  setup.stated_segment_m = 0.25001;  // instead of 0.25
  EXPECT_THAT(failures(certify_pendulum(input(), setup)),
              testing::ElementsAre("pendulum_energy (pendulum)", "pendulum_period (pendulum)"));
}

TEST(Rows, ALeverArmOfOneMillimetreFailsThePendulumsSpecificForce) {
  PendulumSetup setup;
  setup.duration_s = 0.1;
  setup.lever_arm_error_m = 0.001;
  EXPECT_THAT(failures(certify_pendulum(input(), setup)), testing::ElementsAre("pendulum_specific_force (pendulum)"));
}

TEST(Rows, OtherDrawsFailTheDigests) {
  DigestSetup setup;
  setup.duration_s = 2.5;
  setup.disturbance = 0.1;
  setup.restart_seed = 2;
  EXPECT_THAT(failures(certify_digests(input(), setup)),
              testing::ElementsAre("digest_threads (hill)", "digest_order (hill, slip)", "digest_restart (slip)"));
}

TEST(Rows, AProgramThatCannotBeStartedFailsTheRestart) {
  CertificateInput without = input();
  without.program = "/nowhere/tumble";
  DigestSetup setup;
  setup.duration_s = 2.5;
  const std::vector<CertificateEntry> entries = certify_digests(without, setup);
  EXPECT_THAT(failures(entries), testing::ElementsAre("digest_restart (slip)"));
  EXPECT_THAT(entries.back().note, HasSubstr("/nowhere/tumble"));
}

}  // namespace
}  // namespace tumble::scenarios
