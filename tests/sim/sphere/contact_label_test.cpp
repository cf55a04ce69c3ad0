// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sim/sphere/free_sphere.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// The contact point of a sphere that is launched with slip speed u0 stops slipping after T = u0 / k, with k = mu g (1
/// + m r^2 / I). The label is grip once the mean of k (T - t) over 10 ms before and after is below 0.02 m/s: the window
/// determines the border, and the threshold does not.
double slide_time_s(double u0_m_s, double friction, double mass_ratio) {
  constexpr double kWindow_s = 0.01, kGrip_m_s = 0.02;
  const double k = friction * kGravity_m_s2 * (1.0 + mass_ratio);
  return u0_m_s / k + kWindow_s - std::sqrt(4.0 * kWindow_s * kGrip_m_s / k);
}

// the contact alternates, so that the mean covers some of the steps; measured 0.2 to 1.3 ms
constexpr double kBlur_s = 0.003;

TEST(ContactLabel, ALaunchedSphereSlidesAsLongAsCoulombSays) {
  for (const double friction : {0.1, 0.3}) {
    FreeSphere sphere(level_floor(friction));
    const Truth truth = sphere.launch({0, 0, kRadius_m}, {1.5, 0, 0}, Vector3d::Zero(), 1.0);
    const double expected_s = slide_time_s(1.5, friction, sphere.mass_ratio());
    EXPECT_NEAR(first_s(truth, ContactLabel::grip), expected_s, kBlur_s) << friction;
    EXPECT_EQ(truth.label[static_cast<std::size_t>(expected_s / 0.001)], ContactLabel::slide);
    EXPECT_EQ(count(truth, ContactLabel::slip), 0u);
    // negative control: the law of a sliding block would be wrong by a factor
    EXPECT_GT(std::abs(first_s(truth, ContactLabel::grip) - 1.5 / (friction * kGravity_m_s2)), 20 * kBlur_s);
    // the sphere never slips again
    EXPECT_EQ(first_s(truth, ContactLabel::slide, expected_s + kBlur_s), -1.0);
  }
}

TEST(ContactLabel, TheTimeFollowsTheInertia) {
  Situation hollow = level_floor(0.1);
  hollow.robot.values.set("inner_mass_kg", 0.05);
  FreeSphere sphere(hollow);
  ASSERT_NEAR(sphere.mass_ratio(), 1.5, 0.05);  // a thin shell
  const Truth truth = sphere.launch({0, 0, kRadius_m}, {1.0, 0, 0}, Vector3d::Zero(), 1.0);
  EXPECT_NEAR(first_s(truth, ContactLabel::grip), slide_time_s(1.0, 0.1, sphere.mass_ratio()), kBlur_s);
}

TEST(ContactLabel, ASpunSphereSlipsUntilItRolls) {
  FreeSphere sphere(level_floor(0.1));
  const Truth truth = sphere.launch({0, 0, kRadius_m}, Vector3d::Zero(), {0, 10.0, 0}, 1.0);
  // the contact point starts with r w instead of v0
  const double expected_s = slide_time_s(10.0 * kRadius_m, 0.1, sphere.mass_ratio());
  EXPECT_NEAR(first_s(truth, ContactLabel::grip), expected_s, kBlur_s);
  EXPECT_EQ(truth.label[static_cast<std::size_t>(expected_s / 0.001)], ContactLabel::slip);
  EXPECT_EQ(count(truth, ContactLabel::slide), 0u);
}

TEST(ContactLabel, ASphereThatRollsFromTheStartGrips) {
  FreeSphere sphere(level_floor(0.1));
  const Truth truth = sphere.launch({0, 0, kRadius_m}, {1.0, 0, 0}, {0, 1.0 / kRadius_m, 0}, 0.5);
  EXPECT_EQ(count(truth, ContactLabel::grip), truth.label.size());
}

TEST(ContactLabel, ABouncingSphereIsInTheAirForTheTimeOfFreeFall) {
  Situation situation = level_floor(0.5);
  situation.robot.values.set("contact_damping_ratio", 0.2);
  situation.robot.values.set("contact_time_s", 0.01);
  FreeSphere sphere(situation);
  const double height_m = 0.2;
  const Truth truth = sphere.launch({0, 0, kRadius_m + height_m}, Vector3d::Zero(), Vector3d::Zero(), 1.0, false);
  // the label includes contacts up to 10 ms before and after
  const double fall_s = std::sqrt(2.0 * height_m / kGravity_m_s2);
  const double touched_s = first_s(truth, ContactLabel::grip);
  EXPECT_NEAR(touched_s, fall_s - 0.01, 0.0011);
  const double left_s = first_s(truth, ContactLabel::air, touched_s);
  ASSERT_GT(left_s, touched_s);
  // the sphere leaves the ground with some speed v and is back after 2 v / g
  const double v_m_s = truth.v_WB_m_s[static_cast<std::size_t>((left_s - 0.01) / 0.0005)].z();
  ASSERT_GT(v_m_s, 0.3);
  // the tolerance is 2 mm: the remaining compression of the contact at the release, and one step
  EXPECT_NEAR(first_s(truth, ContactLabel::grip, left_s) - left_s, 2.0 * v_m_s / kGravity_m_s2 - 0.02, 0.004);
}

TEST(ContactLabel, ContactsGivePointNormalAndSlipVelocity) {
  FreeSphere sphere(level_floor(0.1));
  const Truth truth = sphere.launch({0, 0, kRadius_m}, {1.0, 0, 0}, {0, 2.0, 0}, 0.05);
  ASSERT_GT(truth.contacts.size(), 20u);
  for (const ContactTruth& contact : truth.contacts) {
    const auto k = static_cast<std::size_t>(contact.time_ns / truth.period_ns);
    EXPECT_LT((contact.normal_W - Vector3d::UnitZ()).norm(), 1e-9);
    EXPECT_LT((contact.point_W_m - (truth.p_WB_m[k] - Vector3d(0, 0, kRadius_m))).norm(), 2e-4);
    const Vector3d w_W = truth.q_WB[k] * truth.w_WB_B_rad_s[k];
    const Vector3d expected = truth.v_WB_m_s[k] + w_W.cross(contact.point_W_m - truth.p_WB_m[k]);
    EXPECT_NEAR((contact.slip_velocity_W_m_s - Vector3d(expected.x(), expected.y(), 0)).norm(), 0.0, 1e-9);
    EXPECT_GT(contact.slip_velocity_W_m_s.x(), 0.4);
  }
}

// negative control: without slip velocities the same motion is grip, and without contacts it is air
TEST(ContactLabel, RestsOnTheContactsAlone) {
  FreeSphere sphere(level_floor(0.1));
  Truth truth = sphere.launch({0, 0, kRadius_m}, {1.0, 0, 0}, Vector3d::Zero(), 0.1);
  ASSERT_EQ(count(truth, ContactLabel::slide), truth.label.size());
  for (ContactTruth& contact : truth.contacts) contact.slip_velocity_W_m_s.setZero();
  truth.label = label_contacts(truth);
  EXPECT_EQ(count(truth, ContactLabel::grip), truth.label.size());
  truth.contacts.clear();
  truth.label = label_contacts(truth);
  EXPECT_EQ(count(truth, ContactLabel::air), truth.label.size());
}

}  // namespace
}  // namespace tumble::sim
