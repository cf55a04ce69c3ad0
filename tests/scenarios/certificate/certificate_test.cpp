// SPDX-License-Identifier: BSD-3-Clause
// The test checks that every row of the certificate passes on this build, and fails when one part of its set-up is
// wrong.
#include <unistd.h>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/certificate/rows.hpp"
#include "stand_ins/short_scenario.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

CertificateInput input() {
  return {test::tree_data(), test::program()};
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
  const fs::path folder = fs::path(testing::TempDir()) / ("tumble_certificate_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const DataRoot data{test::write_short_data(folder)};
  const Certificate certificate = measure_certificate({data, test::program()}, options);
  CertificateStore(test::certificates(), data).keep(certificate);
  fs::remove_all(folder);
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

/// A WrongSetup is a row of the certificate with one wrong part, and the entries that must fail.
struct WrongSetup {
  const char* name;
  std::vector<CertificateEntry> (*certify)();
  ::testing::Matcher<std::vector<std::string>> failing;
};

void PrintTo(const WrongSetup& wrong, std::ostream* out) {
  *out << wrong.name;
}

class Rows : public ::testing::TestWithParam<WrongSetup> {};

TEST_P(Rows, FailIfOnePartOfTheirSetupIsWrong) {
  EXPECT_THAT(failures(GetParam().certify()), GetParam().failing);
}

/// Returns the row of the planes measured on real gyros.
std::vector<CertificateEntry> real_rails(RealRailsSetup setup) {
  setup.devices = 100;
  return certify_real_rails(input(), setup);
}

/// Returns a matcher for entries that contain each of the combinations of row, device and sensor.
::testing::Matcher<std::vector<std::string>> contains_each(const std::string& row,
                                                           const std::vector<std::string>& subjects) {
  std::vector<::testing::Matcher<std::vector<std::string>>> each;
  for (const std::string& subject : subjects) each.push_back(Contains(row + " (" + subject + ")"));
  return ::testing::AllOfArray(each);
}

const std::vector<std::string> kSensors = {"mti30 gyro",  "mti30 accel",      "vn100 gyro",
                                           "vn100 accel", "phidget1044 gyro", "phidget1044 accel"};

INSTANTIATE_TEST_SUITE_P(
    , Rows,
    ::testing::Values(
        WrongSetup{"EulerIntegration",
                   [] { return certify_free_flight(input(), {.integrator = sim::Integrator::euler}); },
                   ElementsAre("free_flight_energy (rig)", "free_flight_momentum (rig)")},
        // 2.3 ms earlier, 4.5 steps
        WrongSetup{"AnotherHeight", [] { return certify_free_fall(input(), {.stated_height_m = 0.99}); },
                   ::testing::SizeIs(1)},
        WrongSetup{"AnotherFriction", [] { return certify_slip_to_grip(input(), {.friction = 0.102}); },
                   ::testing::SizeIs(1)},
        WrongSetup{"ALongStep", [] { return certify_impact(input(), {.step_s = 0.008}); },
                   Contains("impact_peak_step (rig)")},
        // the simulator keeps the time constant of a contact above two steps: below that, a smaller value changes
        // nothing
        WrongSetup{"SoftnessThatTheEngineCannotFollow",
                   [] { return certify_impact(input(), {.step_s = 0.004, .soft_s = 0.008, .hard_s = 0.005}); },
                   Contains("impact_peak_softness (rig)")},
        WrongSetup{"TwoMillimetresOfRange", [] { return certify_lidar_range(input(), {.added_range_m = 0.002}); },
                   ElementsAre("lidar_range_analytic (rs16)", "lidar_range_analytic (mid100)")},
        WrongSetup{"AMirrorLiftedByTwoMillimetres",
                   [] { return certify_lidar_rays(input(), {.rays = 320, .mirror_shift_m = 0.002}); },
                   Contains("lidar_range_engine (hill)")},
        WrongSetup{"AMirrorThatNamesOtherSurfaces",
                   [] { return certify_lidar_rays(input(), {.rays = 320, .surface_shift = 1}); },
                   contains_each("lidar_surface_engine", {"hill", "corridor", "tube"})},
        WrongSetup{"FivePerCentMoreNoise", [] { return certify_imu_noise(input(), {.noise_factor = 1.05}); },
                   contains_each("imu_white_noise", kSensors)},
        WrongSetup{"TwiceTheBias", [] { return certify_imu_noise(input(), {.bias_factor = 2.0}); },
                   AllOf(contains_each("imu_bias_instability", kSensors),
                         contains_each("imu_bias_walk", {kSensors.begin(), kSensors.begin() + 4}))},
        WrongSetup{"RightTilt", [] { return certify_tilted_rail(input(), {.devices = 1}); }, IsEmpty()},
        // a tenth of the tilt tolerance of real devices
        WrongSetup{"ATiltOfTwoTenThousandths",
                   [] { return certify_tilted_rail(input(), {.assumed_tilt = 2e-4, .devices = 1}); },
                   ElementsAre("tilted_rail_slope (mti30 gyro)", "tilted_rail_slope (mti30 accel)")},
        WrongSetup{"NoDevice", [] { return certify_tilted_rail(input(), {.devices = 0}); }, ::testing::SizeIs(4)},
        WrongSetup{"RealRails", [] { return real_rails({}); }, IsEmpty()},
        // the rows of a slope whose interval contains 0 are measured without a sign, so they fail for a level plane too
        WrongSetup{"LevelRails", [] { return real_rails({.tilt_factor = 0.0}); },
                   ElementsAre("real_rail_slope (wand x, z)", "real_rail_slope (wand y, z)",
                               "real_rail_slope (pendulum z, x)", "real_rail_slope (pendulum z, y)")},
        WrongSetup{"RailsTiltedToTheOtherSide", [] { return real_rails({.tilt_factor = -1.0}); },
                   Contains("real_rail_slope (wand y, x)")},
        WrongSetup{"RailsTiltedByOneHundredthMore", [] { return real_rails({.added_tilt = 0.01}); },
                   ElementsAre("real_rail_slope (wand x, y)", "real_rail_slope (wand x, z)",
                               "real_rail_slope (wand y, z)", "real_rail_slope (wand y, x)",
                               "real_rail_slope (pendulum z, x)", "real_rail_slope (pendulum z, y)")},
        WrongSetup{"RailsAThousandthHigher", [] { return real_rails({.rail_factor = 1.001}); },
                   ElementsAre("real_rail_distance (wand x)", "real_rail_distance (wand y)",
                               "real_rail_distance (pendulum z)")},
        WrongSetup{
            "AnotherOffsetOfTheElements", [] { return real_rails({.added_offset_rad_s = 0.01}); },
            ElementsAre("real_rail_offset (wand x)", "real_rail_offset (wand y)", "real_rail_offset (pendulum z)")},
        WrongSetup{"ElementsDrawnHalfAsWide", [] { return real_rails({.spread_factor = 0.5}); },
                   AllOf(contains_each("real_rail_slope_drawn",
                                       {"mti30 gyro", "vn100 gyro", "phidget1044 gyro", "mpu6050 gyro"}),
                         contains_each("real_rail_offset_drawn", {"mti30 gyro", "vn100 gyro", "phidget1044 gyro"}))},
        // the data sheet of this device states offsets more than twice as wide
        WrongSetup{"ElementsDrawnAThirdAsWide", [] { return real_rails({.spread_factor = 0.3}); },
                   Contains("real_rail_offset_drawn (mpu6050 gyro)")},
        // slope and offset of each of the sixteen data sheets
        WrongSetup{"UprightElements", [] { return real_rails({.spread_factor = 0.0}); }, ::testing::SizeIs(32)},
        // 0.25001 m instead of 0.25 m
        WrongSetup{"APendulumOfAnotherLength", [] { return certify_pendulum(input(), {.stated_segment_m = 0.25001}); },
                   ElementsAre("pendulum_energy (pendulum)", "pendulum_period (pendulum)")},
        WrongSetup{"ALeverArmOfOneMillimetreOnThePendulum",
                   [] { return certify_pendulum(input(), {.duration_s = 0.1, .lever_arm_error_m = 0.001}); },
                   ElementsAre("pendulum_specific_force (pendulum)")},
        WrongSetup{"OtherDraws",
                   [] { return certify_digests(input(), {.restart_seed = 2, .duration_s = 2.5, .disturbance = 0.1}); },
                   ElementsAre("digest_threads (hill)", "digest_order (hill, slip)", "digest_restart (slip)")}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(Certificate, ALeverArmOfOneMillimetreFailsTheSpecificForce) {
  const std::vector<CertificateEntry> entries = certify_flight_force(input(), {.lever_arm_m = 0.001});
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_FALSE(entries[0].passes());
  EXPECT_NEAR(entries[0].value, 18.0 * 18.0 * 0.001, 0.02);  // w^2 r; the small rates of the other axes change little
}

TEST(Certificate, AnotherRadiusFailsTheRollingLawOnEachGround) {
  const std::vector<CertificateEntry> entries = certify_rolling(input(), {.stated_radius_m = 0.148});  // 2 %
  ASSERT_GT(entries.size(), 2u);
  EXPECT_EQ(failures(entries).size(), entries.size());
}

TEST(Certificate, AProgramThatCannotBeStartedFailsTheRestart) {
  CertificateInput without = input();
  without.program = "/nowhere/tumble";
  const std::vector<CertificateEntry> entries = certify_digests(without, {.duration_s = 2.5});
  EXPECT_THAT(failures(entries), ElementsAre("digest_restart (slip)"));
  EXPECT_THAT(entries.back().note, HasSubstr("/nowhere/tumble"));
}

}  // namespace
}  // namespace tumble::scenarios
