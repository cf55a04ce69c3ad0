// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/registry.hpp"
#include "scenarios/sweep/variation.hpp"

#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kRail = 10.5;

/// Returns the synthetic rig with its own calibration errors and a situation that states its saturation level.
SimulatedDraw sample_draw(std::uint64_t seed = 5001) {
  SimulatedDraw draw;
  draw.recording = testing::synthetic_rig();
  sim::Sensors& sensors = draw.recording.sensors;
  sensors.imus[0].T_BI.translation() += Vector3d(0.004, -0.003, 0.001);
  sensors.lidars[0].T_BL.linear() *= Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  sensors.imus[0].clip_flags.assign(sensors.imus[0].time_ns.size(), 0b111111);
  sim::SensorSpec imu{"imu", "imu", "ideal", "mti30", {}, {}};
  imu.values.set("time_offset_s", 0.002);
  imu.values.set("gyro_rail_rad_s", kRail);
  const sim::Situation situation{"hill", seed, 10.0, {"floor", {}}, {"rig", {}}, {"push", {}}, {imu}, {}};
  draw.built.emplace(sim::resolve(situation), test::source_dir() / "models");
  return draw;
}

Vector3d lever_error_m(const SimulatedDraw& draw) {
  return draw.recording.sensors.imus[0].T_BI.translation() - draw.recording.truth.imus[0].T_BI.translation();
}

double extrinsic_angle_rad(const SimulatedDraw& draw) {
  const auto& [sensors, truth] = draw.recording;
  const Matrix3d given = sensors.imus[0].T_BI.linear().transpose() * sensors.lidars[0].T_BL.linear();
  const Matrix3d exact = truth.imus[0].T_BI.linear().transpose() * truth.lidars[0].T_BL.linear();
  return Eigen::AngleAxisd(Matrix3d(exact.transpose() * given)).angle();
}

TEST(GivenErrors, OfTheLeverArmHaveTheirSizeAndOneDirection) {
  const SimulatedDraw draw = sample_draw();
  const SimulatedDraw small = with_setting(draw, {"given.lever_arm_error_m", 0.01});
  const SimulatedDraw large = with_setting(draw, {"given.lever_arm_error_m", 0.03});
  EXPECT_NEAR(lever_error_m(with_setting(draw, {"given.lever_arm_error_m", 0.0})).norm(), 0.0, 1e-15);
  EXPECT_NEAR(lever_error_m(small).norm(), 0.01, 1e-15);
  EXPECT_NEAR((lever_error_m(large) - 3.0 * lever_error_m(small)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(extrinsic_angle_rad(small), extrinsic_angle_rad(draw), 1e-9) << "the sensors among each other stay";
  const SimulatedDraw other = sample_draw(5002);
  EXPECT_GT((lever_error_m(with_setting(other, {"given.lever_arm_error_m", 0.01})) - lever_error_m(small)).norm(), 1e-4)
      << "each draw has a direction of its own";
}

TEST(GivenErrors, OfTheRadiusIsAddedAndNeedsASphere) {
  SimulatedDraw draw = sample_draw();
  draw.recording.sensors.sphere_radius_m = 0.145;
  EXPECT_NEAR(with_setting(draw, {"given.radius_error_m", 0.003}).recording.sensors.sphere_radius_m, 0.148, 1e-15);
  EXPECT_NEAR(with_setting(draw, {"given.radius_error_m", -0.003}).recording.sensors.sphere_radius_m, 0.142, 1e-15);
  EXPECT_THROW(with_setting(draw, {"given.radius_error_m", -0.5}), BadInput);
  draw.recording.sensors.sphere_radius_m = 0.0;
  EXPECT_THROW(with_setting(draw, {"given.radius_error_m", 0.003}), BadInput);
}

TEST(GivenErrors, OfTheExtrinsicRotationHaveTheirSize) {
  const SimulatedDraw draw = sample_draw();
  ASSERT_GT(extrinsic_angle_rad(draw), 0.019);
  // the angle of a matrix near the identity has half of the digits
  EXPECT_NEAR(extrinsic_angle_rad(with_setting(draw, {"given.extrinsic_rotation_rad", 0.0})), 0.0, 1e-7);
  EXPECT_NEAR(extrinsic_angle_rad(with_setting(draw, {"given.extrinsic_rotation_rad", 0.03})), 0.03, 1e-9);
  EXPECT_EQ(lever_error_m(with_setting(draw, {"given.extrinsic_rotation_rad", 0.03})), lever_error_m(draw));
}

TEST(GivenErrors, OfTheClockReplaceTheScenariosOwn) {
  const SimulatedDraw draw = sample_draw();
  const SimulatedDraw late = with_setting(draw, {"given.time_offset_s", 0.01});
  for (std::size_t k = 0; k < draw.recording.sensors.imus[0].time_ns.size(); ++k) {
    ASSERT_EQ(late.recording.sensors.imus[0].time_ns[k] - draw.recording.sensors.imus[0].time_ns[k], 8'000'000);
  }
  EXPECT_EQ(scored_by(draw, late).recording.sensors.imus[0].time_ns, late.recording.sensors.imus[0].time_ns);
}

TEST(GivenErrors, OfTheRateAreConstantOverASegmentAndNowhereElse) {
  const SimulatedDraw draw = sample_draw();
  const ClippingTruth clipping(draw.recording.sensors, draw.recording.truth);
  const SimulatedDraw wrong = with_setting(draw, {"given.rate_error_rad_s", 0.5});
  const sim::ImuRecord& before = draw.recording.sensors.imus[0];
  const sim::ImuRecord& after = wrong.recording.sensors.imus[0];
  std::size_t clipped = 0;
  Vector3d last = Eigen::Vector3d::Zero();
  double largest = 0.0;
  for (std::size_t k = 0; k < clipping.size(); ++k) {
    largest = std::max(largest, after.gyro_rad_s[k].lpNorm<Eigen::Infinity>());
    EXPECT_EQ(after.clip_flags[k], 0b111000) << "nothing tells of the gyro's clipping, and the accelerometer's stays";
    if (clipping.clipped_axes(k) == 0) {
      ASSERT_EQ(after.gyro_rad_s[k], before.gyro_rad_s[k]);
      continue;
    }
    const Vector3d error = after.gyro_rad_s[k] - draw.recording.truth.imus[0].gyro_unclipped_rad_s[k];
    EXPECT_NEAR(error.norm(), 0.5, 1e-12);
    if (clipped > 0 && clipping.clipped_axes(k - 1) != 0) {
      EXPECT_NEAR((error - last).norm(), 0.0, 1e-12);
    }
    last = error;
    ++clipped;
  }
  EXPECT_GT(clipped, 20u);
  EXPECT_GT(after.stated_gyro_range_rad_s, largest);
}

TEST(GivenErrors, OfTheStatedSaturationLimitReachMethodsThatUseIt) {
  const SimulatedDraw draw = sample_draw();
  const Setting setting{"given.stated_rail_error", -0.1};
  EXPECT_NEAR(with_setting(draw, setting).recording.sensors.imus[0].stated_gyro_range_rad_s, 0.9 * kRail, 1e-12);
  EXPECT_EQ(with_setting(draw, setting).recording.sensors.imus[0].clip_flags.front(), 0b111000);
  // the gyro is saturated at 10.5 and the method saave takes values beyond 9.4 for saturated: it estimates more samples
  // than necessary
  const Method& saave = *find_methods("rate/saave").front();
  sim::Sensors free = draw.recording.sensors;
  const auto estimated = [&](const Method& method) {
    const Estimate estimate = method.run(free, {}, {});
    EXPECT_TRUE(estimate.status.ok()) << estimate.status.message();
    return std::count_if(estimate.rates.begin(), estimate.rates.end(),
                         [](const AngularRateState& rate) { return rate.clipped_axes != 0; });
  };
  EXPECT_GT(estimated(with_setting(saave, setting)), estimated(saave));
}

TEST(GivenErrors, NeedTheSensorThatTheyAreOf) {
  SimulatedDraw blind = sample_draw();
  blind.recording.sensors.lidars.clear();
  EXPECT_THROW(with_setting(blind, {"given.extrinsic_rotation_rad", 0.03}), BadInput);
  EXPECT_NO_THROW(with_setting(blind, {"given.lever_arm_error_m", 0.03}));
  blind.built.reset();
  EXPECT_THROW(with_setting(blind, {"given.lever_arm_error_m", 0.03}), BadInput) << "a recording has no situation";
}

TEST(Settings, ReachOneMethodAlone) {
  const Method& saave = *find_methods("rate/saave").front();
  const Method& raw = *find_methods("rate/raw").front();
  const Setting setting{"rate/saave.saturation_point_rad_s", 9.0};
  EXPECT_EQ(reach(setting), Reach::method);
  EXPECT_TRUE(concerns(setting, saave.info));
  EXPECT_FALSE(concerns(setting, raw.info));
  EXPECT_TRUE(concerns({"given.time_offset_s", 0.0}, raw.info));
  EXPECT_EQ(reach({"world.rock_count+world.trunk_count", 3.0}), Reach::simulation);
  EXPECT_EQ(reach({}), Reach::nothing);
}

}  // namespace
}  // namespace tumble::scenarios
