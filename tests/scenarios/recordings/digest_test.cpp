// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

std::string digest_of(const sim::Recording& recording) {
  return digest(recording.sensors, &recording.truth);
}

TEST(Digest, IsThirtyTwoHexadecimalDigitsAndRepeats) {
  const std::string found = digest_of(fixture::recording());
  EXPECT_EQ(found.size(), 32u);
  EXPECT_EQ(found.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(found, digest_of(fixture::recording()));
  // the digest is pinned: a change means that stored digests of older files are invalid, and requires a new format
  // version
  EXPECT_EQ(digest(sim::Sensors{}, nullptr), "320fa1dc4c37d86ecef0f4970469eddc");
  // the digest of an IMU without magnetometer must be the same as before there were magnetometers
  sim::Sensors sensors;
  sim::Truth truth;
  sensors.imus.emplace_back().name = truth.imus.emplace_back().name = "imu";
  EXPECT_EQ(digest(sensors, nullptr), "6093a0fd6559636640d2697aa44bf7a9");
  EXPECT_EQ(digest(sensors, &truth), "ed580d53149a29ebc7465707bc797da9");
}

// The test makes one change in each field; every digest must differ from all the others.
TEST(Digest, EveryFieldCounts) {
  using Change = std::function<void(sim::Sensors&, sim::Truth&)>;
  const std::vector<Change> changes = {[](auto&, auto&) {},
                                       [](auto& s, auto&) { s.robot += "x"; },
                                       [](auto& s, auto&) { s.sphere_radius_m = 0.15; },
                                       [](auto& s, auto&) { s.gravity_m_s2 = 9.8; },
                                       [](auto& s, auto&) { std::swap(s.imus[0], s.imus[1]); },
                                       [](auto& s, auto&) { s.imus.pop_back(); },
                                       [](auto& s, auto&) { s.lidars.pop_back(); },
                                       [](auto& s, auto&) { s.imus[1].name += "x"; },
                                       [](auto& s, auto&) { s.imus[1].device += "x"; },
                                       [](auto& s, auto&) { s.imus[1].period_ns += 1; },
                                       [](auto& s, auto&) { s.imus[1].stated_gyro_range_rad_s += 1; },
                                       [](auto& s, auto&) { s.imus[1].stated_accel_range_m_s2 += 1; },
                                       [](auto& s, auto&) { s.imus[1].gyro_noise_rad_s_sqrt_hz += 1; },
                                       [](auto& s, auto&) { s.imus[1].accel_noise_m_s2_sqrt_hz += 1; },
                                       [](auto& s, auto&) { s.imus[1].T_BI.translation().z() += 1e-9; },
                                       [](auto& s, auto&) { s.imus[1].time_ns.back() += 1; },
                                       [](auto& s, auto&) { s.imus[1].gyro_rad_s.back().z() += 1e-9; },
                                       [](auto& s, auto&) { s.imus[1].accel_m_s2.back().z() += 1e-9; },
                                       [](auto& s, auto&) { s.imus[1].clip_flags.back() ^= 1; },
                                       [](auto& s, auto&) { s.imus[1].magnetic_field_t.back().z() += 1e-12; },
                                       [](auto& s, auto&) { s.imus[1].magnetic_field_t.clear(); },
                                       [](auto& s, auto&) { s.imus[1].earth_field_W_t.z() += 1e-12; },
                                       [](auto& s, auto&) { s.lidars[0].name += "x"; },
                                       [](auto& s, auto&) { s.lidars[0].device += "x"; },
                                       [](auto& s, auto&) { s.lidars[0].T_BL.translation().x() += 1e-9; },
                                       [](auto& s, auto&) { s.lidars[0].sweep_period_ns += 1; },
                                       [](auto& s, auto&) { s.lidars[0].sweep_start_ns.back() += 1; },
                                       [](auto& s, auto&) { s.lidars[0].sweep_first[1] += 1; },
                                       [](auto& s, auto&) { s.lidars[0].position_L_m.back().z() += 1e-3f; },
                                       [](auto& s, auto&) { s.lidars[0].range_m.back() += 1e-3f; },
                                       [](auto& s, auto&) { s.lidars[0].intensity.back() += 1e-3f; },
                                       [](auto& s, auto&) { s.lidars[0].offset_ns.back() += 1; },
                                       [](auto& s, auto&) { s.lidars[0].ring.back() += 1; },
                                       [](auto& s, auto&) { s.series.clear(); },
                                       [](auto& s, auto&) { s.series[0].name += "x"; },
                                       [](auto& s, auto&) { s.series[0].kind += "x"; },
                                       [](auto& s, auto&) { s.series[0].device += "x"; },
                                       [](auto& s, auto&) { s.series[0].period_ns += 1; },
                                       [](auto& s, auto&) { s.series[0].T_BX.translation().z() += 1e-9; },
                                       [](auto& s, auto&) { s.series[0].time_ns.back() += 1; },
                                       [](auto& s, auto&) { s.series[0].quantities.pop_back(); },
                                       [](auto& s, auto&) { s.series[0].quantities[1].name += "x"; },
                                       [](auto& s, auto&) { s.series[0].quantities[1].unit += "x"; },
                                       [](auto& s, auto&) { s.series[0].quantities[1].noise += 1; },
                                       [](auto& s, auto&) { s.series[0].quantities[1].values.back() += 1e-6; },
                                       [](auto& s, auto&) { s.series[0].constants.clear(); },
                                       [](auto& s, auto&) { s.series[0].constants[0].name += "x"; },
                                       [](auto& s, auto&) { s.series[0].constants[0].value += 1e-9; },
                                       [](auto&, auto& t) { t.series.clear(); },
                                       [](auto&, auto& t) { t.series[0].name += "x"; },
                                       [](auto&, auto& t) { t.series[0].T_BX.translation().z() += 1e-9; },
                                       [](auto&, auto& t) { t.series[0].quantities.pop_back(); },
                                       [](auto&, auto& t) { t.series[0].quantities[1].name += "x"; },
                                       [](auto&, auto& t) { t.series[0].quantities[1].unit += "x"; },
                                       [](auto&, auto& t) { t.series[0].quantities[1].values.back() += 1e-6; },
                                       [](auto&, auto& t) { t.period_ns += 1; },
                                       [](auto&, auto& t) { t.p_WB_m.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.q_WB.back().w() += 1e-9; },
                                       [](auto&, auto& t) { t.v_WB_m_s.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.w_WB_B_rad_s.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.f_B_m_s2.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.label.back() = sim::ContactLabel::air; },
                                       [](auto&, auto& t) { t.contacts.back().time_ns += 1; },
                                       [](auto&, auto& t) { t.contacts.back().point_W_m.x() += 1e-9; },
                                       [](auto&, auto& t) { t.contacts.back().normal_W.x() += 1e-9; },
                                       [](auto&, auto& t) { t.contacts.back().slip_velocity_W_m_s.x() += 1e-9; },
                                       [](auto&, auto& t) { t.contacts.back().normal_force_n += 1e-9; },
                                       [](auto&, auto& t) { t.contacts.back().surface_id -= 1; },
                                       [](auto&, auto& t) { t.p_BG_m.x() += 1e-9; },
                                       [](auto&, auto& t) { t.surfaces[0] += "x"; },
                                       [](auto&, auto& t) {
                                         t.surfaces = {"terrai", "nrock \xc3\xa9"};
                                       },
                                       [](auto&, auto& t) { t.imus[1].name += "x"; },
                                       [](auto&, auto& t) { t.imus[1].T_BI.translation().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].rate_rad_s.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].specific_force_m_s2.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].gyro_unclipped_rad_s.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].accel_unclipped_m_s2.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].gyro_bias_rad_s.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].accel_bias_m_s2.back().x() += 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].magnetic_field_t.back().x() += 1e-12; },
                                       [](auto&, auto& t) {
                                         t.imus[1].gyro_elements.assign(3, {1, 2, 3});
                                       },
                                       [](auto&, auto& t) {
                                         t.imus[1].accel_elements.assign(3, {1, 2, 3});
                                       },
                                       [](auto&, auto& t) { t.imus[1].gyro_element_offset_rad_s.x() = 1e-9; },
                                       [](auto&, auto& t) { t.imus[1].accel_element_offset_m_s2.x() = 1e-9; },
                                       [](auto&, auto& t) { t.lidars[0].name += "x"; },
                                       [](auto&, auto& t) { t.lidars[0].T_BL.translation().x() += 1e-9; },
                                       [](auto&, auto& t) { t.lidars[0].hit_W_m.back().x() += 1e-3f; },
                                       [](auto&, auto& t) { t.lidars[0].surface_id.back() -= 1; }};
  std::set<std::string> seen;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    sim::Recording recording = fixture::recording();
    changes[i](recording.sensors, recording.truth);
    EXPECT_TRUE(seen.insert(digest_of(recording)).second) << "change " << i;
  }
}

TEST(Digest, TruthCountsEvenWhenEmpty) {
  const sim::Recording recording = fixture::recording();
  const sim::Truth empty;
  EXPECT_NE(digest(recording.sensors, nullptr), digest(recording.sensors, &recording.truth));
  EXPECT_NE(digest(recording.sensors, nullptr), digest(recording.sensors, &empty));
}

}  // namespace
}  // namespace tumble::scenarios
