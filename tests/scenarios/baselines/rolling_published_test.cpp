// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/rolling/rolling_truth.hpp"
#include "scenarios/baselines/rolling/autogain_fusion.hpp"
#include "tests/scenarios/baselines/rolled.hpp"
#include "tests/testing.hpp"

namespace tumble::baselines {
namespace {

using testing::l_shape;
using testing::no_slip;
using testing::RollingMotion;
using testing::RollingTruth;

TEST(AutogainFusion, SplitRunsAndSignOfQ) {
  const AutogainFusion method({});
  RollingTruth truth = testing::roll({.velocity_m_s = l_shape, .contact_velocity_m_s = no_slip, .duration_s = 5.0});
  const std::size_t count = truth.samples.size();
  const auto whole = rolled(method, truth);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{700}, count - 1}) {
    const auto carried = rolled(method, truth, 0, cut);
    EXPECT_FALSE(carried == whole);
    EXPECT_TRUE(whole == rolled(method, truth, cut, count, carried)) << cut;
  }
  for (Quaterniond& q : truth.q_WI) q.coeffs() = -q.coeffs();
  EXPECT_EQ(rolled(method, truth).p_WG_m, whole.p_WG_m);
}

TEST(AutogainFusion, RefusesBadInputAndKeepsItsState) {
  const AutogainFusion method({});
  const RollingTruth truth =
      testing::roll({.velocity_m_s = l_shape, .contact_velocity_m_s = no_slip, .duration_s = 3.0});
  const auto before = rolled(method, truth, 0, 700);
  const auto refused = [&](const ImuSample& sample, const Quaterniond& q) {
    auto state = before;
    const ErrorCode error_code = method.step(sample, q, state).error_code;
    EXPECT_TRUE(state == before) << to_string(error_code);
    return error_code;
  };
  const ImuSample good = truth.samples[700];
  const Quaterniond q = truth.q_WI[700];
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ImuSample bad = good;
  bad.specific_force_m_s2.y() = kNan;
  EXPECT_EQ(refused(bad, q), ErrorCode::non_finite);
  EXPECT_EQ(refused(good, Quaterniond(1, kNan, 0, 0)), ErrorCode::non_finite);
  EXPECT_EQ(refused(good, Quaterniond(0.5, 0, 0, 0)), ErrorCode::out_of_range);
  bad = good;
  bad.time_ns = before.last_time_ns;
  EXPECT_EQ(refused(bad, q), ErrorCode::time_order);
  bad.time_ns = before.last_time_ns + 1'000'000'001;
  EXPECT_EQ(refused(bad, q), ErrorCode::gap);
}

TEST(AutogainFusion, CleanRollEndsFarOffAsPublished) {
  const RollingTruth truth = testing::roll({.velocity_m_s = l_shape, .contact_velocity_m_s = no_slip});
  const double error = (rolled(AutogainFusion({}), truth).p_WG_m - truth.p_WG_m.back()).norm();
  // the error is 0.77 m on another L-shaped path of the same size; a fusion with a small error here would not be the
  // published one
  EXPECT_GT(error, 0.4);
  EXPECT_LT(error, 1.2);
}

TEST(AutogainFusion, WithoutAccelerationItIsHalfOfRolling) {
  const RollingTruth truth = testing::roll({.velocity_m_s = l_shape, .contact_velocity_m_s = no_slip});
  const AutogainFusion half({.limiter = 0.0});
  // eq 12 also subtracts the apparent climb: measured 0.076 m
  EXPECT_NEAR((rolled(half, truth).p_WG_m.head<2>() - 0.5 * truth.p_WG_m.back().head<2>()).norm(), 0.0, 0.1);
}

/// While the integral is at its limit, the fused step is a fixed multiple of the rolling step, as in the published
/// figures.
TEST(AutogainFusion, SaturatedStepsHaveTheRatiosOfThePublishedFigures) {
  const auto ratio = [](double rotation_weight, double sign) {
    const AutogainFusion method({.limiter = 1.1, .rotation_weight = rotation_weight});
    AutogainFusion::State state;
    state.started = true;
    state.v_integral_m_s = {sign * 100.0, 0.0, 0.0};
    const ImuSample sample{4'000'000, {0.0, 3.0, 0.0}, {0.0, 0.0, 9.80665}, 0};
    EXPECT_TRUE(method.step(sample, Eigen::Quaterniond::Identity(), state).ok());
    return state.v_WG_m_s.x() / (0.145 * 3.0);
  };
  // the remaining deviation is the apparent climb in eq 12 from the turn within the sample; measured 1.3e-12
  EXPECT_NEAR(ratio(0.5, 1.0), 1.05, 1e-9);
  EXPECT_NEAR(ratio(0.5, -1.0), -0.05, 1e-9);
  EXPECT_NEAR(ratio(1.0, 1.0), 1.55, 1e-9);
  EXPECT_NEAR(ratio(1.0, -1.0), 0.45, 1e-9);
}

TEST(AutogainFusion, ClimbingFasterThanRollingIsLimitedWithoutNaN) {
  for (const bool per_axis : {true, false}) {
    for (const bool by_norm : {true, false}) {
      const AutogainFusion method({.shrink_per_axis = per_axis, .vertical_by_norm = by_norm});
      AutogainFusion::State state;
      state.started = true;
      state.v_integral_m_s = {0.0, 0.0, 50.0};
      ASSERT_TRUE(
          method.step({4'000'000, {0.0, 3.0, 0.0}, {0, 0, 9.80665}, 0}, Eigen::Quaterniond::Identity(), state).ok());
      EXPECT_TRUE(state.v_WG_m_s.allFinite());
      EXPECT_NEAR(state.v_WG_m_s.z(), 0.145 * 3.0 * (by_norm ? 1.0 : 0.5), 1e-12);
    }
  }
}

TEST(AutogainFusion, MountingDoesNotMatterWithTheNormBasedFactor) {
  const RollingTruth truth = testing::roll({.velocity_m_s = l_shape, .contact_velocity_m_s = no_slip});
  RollingTruth turned = truth;
  const Quaterniond q_IB = so3::exp({0.4, -1.3, 0.9});
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    turned.samples[k].angular_velocity_rad_s = q_IB * truth.samples[k].angular_velocity_rad_s;
    turned.samples[k].specific_force_m_s2 = q_IB * truth.samples[k].specific_force_m_s2;
    turned.q_WI[k] = truth.q_WI[k] * q_IB.conjugate();
  }
  AutogainFusion::Params smooth;
  smooth.autogain.profile = AutogainProfile::smooth;
  const auto difference = [&](const AutogainFusion::Params& params) {
    return (rolled(AutogainFusion(params), truth).p_WG_m - rolled(AutogainFusion(params), turned).p_WG_m).norm();
  };
  EXPECT_NEAR(difference(smooth), 0.0, 1e-9);
  EXPECT_GT(difference({}), 1e-3) << "the paper's factor depends on the mounting";
}

TEST(AutogainFusion, EachSwitchChangesTheResult) {
  // the start is turned, so that no world axis is a body axis
  const RollingTruth truth = testing::roll({.velocity_m_s = [](double t) -> Vector3d {
                                              return Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) * l_shape(t);
                                            },
                                            .contact_velocity_m_s = no_slip,
                                            .q_start = so3::exp({0.3, 0.2, 0.1})});
  const Vector3d printed = rolled(AutogainFusion({}), truth).p_WG_m;
  const AutogainFusion::Params switched[] = {{.integrate_in_body = false}, {.direction_only = true},
                                             {.recursive_coupling = true}, {.limit_per_axis = false},
                                             {.shrink_per_axis = false},   {.vertical_by_norm = true}};
  for (const AutogainFusion::Params& params : switched) {
    EXPECT_GT((rolled(AutogainFusion(params), truth).p_WG_m - printed).norm(), 1e-6);
  }
}

TEST(AutogainFusion, RefusesBadParams) {
  EXPECT_THROW(AutogainFusion({.radius_m = 0.0}), InvalidParams);
  EXPECT_THROW(AutogainFusion({.limiter = -1.0}), InvalidParams);
  EXPECT_THROW(AutogainFusion({.autogain = {.tau_s = 0.0}}), InvalidParams);
}

}  // namespace
}  // namespace tumble::baselines
