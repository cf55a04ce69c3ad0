// SPDX-License-Identifier: BSD-3-Clause
// The test runs tilted sensing elements through all stages of a device.
#include "sim/imu/imu_simulation.hpp"
#include "tests/sim/imu/simulated_imu.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kRail_rad_s = 10.0;

/// Returns a turn about an axis that itself turns (coning), up to `size` times 15 rad/s about z and 6 about the others,
/// with a shake along x.
Truth wobbling(double duration_s, double size) {
  Truth truth;
  Quaterniond q = Eigen::Quaterniond::Identity();
  for (int k = 0; k <= std::lround(duration_s / 0.0005); ++k) {
    const double t = k * 0.0005;
    const Vector3d rate = size * Vector3d(6.0 * std::sin(9.0 * t), 6.0 * std::cos(13.0 * t), 15.0 * std::sin(3.0 * t));
    truth.q_WB.push_back(q);
    truth.w_WB_B_rad_s.push_back(rate);
    truth.v_WB_m_s.emplace_back(0.5 * std::sin(40.0 * t), 0.0, 0.0);
    truth.p_WB_m.emplace_back(Vector3d::Zero());
    q = (q * Quaterniond(Eigen::AngleAxisd(rate.norm() * 0.0005, rate.normalized()))).normalized();
  }
  return truth;
}

SensorSpec device(Numbers numbers, double rate_hz = 100.0) {
  SensorSpec sensor = imu_with(numbers, rate_hz);
  sensor.values.set("gyro_rail_rad_s", kRail_rad_s);
  sensor.values.set("clip_flags", 1.0);
  return sensor;
}

Matrix3d matrix(const std::vector<Vector3d>& rows) {
  Matrix3d out;
  for (int i = 0; i < 3; ++i) out.row(i) = rows.at(static_cast<std::size_t>(i));
  return out;
}

/// Returns the largest distance of a whole window at the positive saturation level of z from `row` . y = `level`, and
/// the number of such windows.
std::pair<double, int> off_plane(const SimulatedImu& r, const Vector3d& row, double level) {
  double largest = 0.0;
  int windows = 0;
  for (std::size_t k = 1; k + 1 < r.record.gyro_rad_s.size(); ++k) {
    const auto whole = [&](std::size_t i) { return r.truth.gyro_unclipped_rad_s[i].z() > kRail_rad_s + 1.5; };
    if (!whole(k - 1) || !whole(k) || !whole(k + 1)) continue;  // at the saturation limit during the whole window
    largest = std::max(largest, std::abs(row.dot(r.record.gyro_rad_s[k]) - level));
    ++windows;
  }
  return {largest, windows};
}

TEST(TiltedRail, WholeWindowsLieOnThePlaneOfTheElement) {
  for (const double after : {0.0, 1.0}) {
    const SimulatedImu r = simulated(wobbling(2.0, 1.0), device({{"gyro_element_misalignment", 0.05},
                                                                 {"gyro_element_scale", 0.01},
                                                                 {"gyro_element_offset_rad_s", 0.05},
                                                                 {"clip_after_low_pass", after}}));
    ASSERT_EQ(r.truth.gyro_elements.size(), 3u);
    const double level = kRail_rad_s - r.truth.gyro_element_offset_rad_s.z();
    const auto [off, windows] = off_plane(r, r.truth.gyro_elements[2], level);
    EXPECT_LT(off, 1e-12);
    EXPECT_GT(windows, 20);
    // an upright plane of any level does not fit: the reading moves with the other axes
    const Vector3d upright = Vector3d::UnitZ() * r.truth.gyro_elements[2].z();
    EXPECT_GT(off_plane(r, upright, level).first, 0.05);
  }
}

TEST(TiltedRail, FreeElementsAreRightAndFreeAxesAreNot) {
  const SimulatedImu r = simulated(wobbling(2.0, 1.0), device({{"gyro_element_misalignment", 0.05}}, 500.0));
  const Matrix3d axes = matrix(r.truth.gyro_elements);
  int clipped = 0;
  double largest = 0.0;
  for (std::size_t k = 0; k < r.record.gyro_rad_s.size(); ++k) {
    const Vector3d lost = r.truth.gyro_unclipped_rad_s[k] - r.record.gyro_rad_s[k];
    const Vector3d deficit = axes * lost;
    for (int i = 0; i < 3; ++i) {
      if ((r.record.clip_flags[k] >> i & 1) == 0) {
        ASSERT_NEAR(deficit[i], 0.0, 1e-12) << k;
      } else {
        // the deficit points outwards
        ASSERT_GE(deficit[i] * axes.row(i).dot(r.truth.gyro_unclipped_rad_s[k]), 0.0) << k;
      }
    }
    if (r.record.clip_flags[k] == 0) {
      ASSERT_EQ(r.record.gyro_rad_s[k], r.truth.gyro_unclipped_rad_s[k]);
    } else if (r.record.clip_flags[k] == 0b100) {
      ++clipped;
      largest = std::max(largest, lost.head<2>().cwiseAbs().maxCoeff());
    }
  }
  EXPECT_GT(clipped, 100);
  EXPECT_GT(largest, 0.1);  // unflagged axes have errors of some hundredths of 5 rad/s
}

TEST(TiltedRail, CannotBeSeenWhileNothingClips) {
  const Numbers noisy = {{"gyro_noise_rad_s_sqrt_hz", 1e-3}, {"gyro_bias_turn_on_rad_s", 0.01},
                         {"gyro_scale_error", 0.01},         {"accel_noise_m_s2_sqrt_hz", 1e-3},
                         {"accel_rail_m_s2", 100.0},         {"gyro_quantum_rad_s", 1e-3}};
  SensorSpec upright = device(noisy), tilted = upright;
  for (const auto& [name, value] : Numbers{{"gyro_element_misalignment", 0.05},
                                           {"gyro_element_scale", 0.03},
                                           {"gyro_element_offset_rad_s", 0.1},
                                           {"accel_element_misalignment", 0.05},
                                           {"accel_element_scale", 0.03},
                                           {"accel_element_offset_m_s2", 0.3}}) {
    tilted.values.set(name, value);
  }
  const Truth slow = wobbling(1.0, 0.4);
  const SimulatedImu a = simulated(slow, upright), b = simulated(slow, tilted);
  ASSERT_EQ(a.record.gyro_rad_s.size(), 100u);
  EXPECT_EQ(a.record.gyro_rad_s, b.record.gyro_rad_s);
  EXPECT_EQ(a.record.accel_m_s2, b.record.accel_m_s2);
  EXPECT_THAT(b.record.clip_flags, testing::Each(0));
  const Truth fast = wobbling(1.0, 1.0);
  const SimulatedImu c = simulated(fast, upright), d = simulated(fast, tilted);
  EXPECT_NE(c.record.gyro_rad_s, d.record.gyro_rad_s);  // negative control: with clipping, they differ
  EXPECT_EQ(c.truth.gyro_unclipped_rad_s, d.truth.gyro_unclipped_rad_s);
}

TEST(TiltedRail, GivenElementsAreThoseOfTheDeviceAndChangeNoOtherDraw) {
  const SensorSpec sensor = device({{"gyro_element_misalignment", 0.05},
                                    {"gyro_element_offset_rad_s", 0.1},
                                    {"accel_rail_m_s2", 9.0},
                                    {"accel_element_misalignment", 0.05},
                                    {"gyro_noise_rad_s_sqrt_hz", 1e-3},
                                    {"gyro_scale_error", 0.01},
                                    {"accel_noise_m_s2_sqrt_hz", 1e-3}});
  const Truth fast = wobbling(1.0, 1.0);
  const SimulatedImu drawn = simulated(fast, sensor);
  const auto given = [&](const GivenElements& elements) {
    SimulatedImu out;
    simulate_imu(fast, sensor, Eigen::Isometry3d::Identity(), kGravity_m_s2, 1, out.record, out.truth, elements);
    return out;
  };
  const SimulatedImu same =
      given({Elements(matrix(drawn.truth.gyro_elements), drawn.truth.gyro_element_offset_rad_s), std::nullopt});
  EXPECT_EQ(same.record.gyro_rad_s, drawn.record.gyro_rad_s);
  EXPECT_EQ(same.record.accel_m_s2, drawn.record.accel_m_s2);
  Matrix3d axes = Matrix3d::Identity();
  axes(2, 0) = 0.08;
  const SimulatedImu other = given({Elements(axes, Vector3d(0.0, 0.0, 0.2)), Elements()});
  EXPECT_EQ(matrix(other.truth.gyro_elements), axes);
  EXPECT_EQ(other.truth.gyro_element_offset_rad_s.z(), 0.2);
  EXPECT_TRUE(other.truth.accel_elements.empty());
  EXPECT_EQ(other.truth.gyro_unclipped_rad_s, drawn.truth.gyro_unclipped_rad_s);
  EXPECT_EQ(other.truth.accel_unclipped_m_s2, drawn.truth.accel_unclipped_m_s2);
  EXPECT_NE(other.record.gyro_rad_s, drawn.record.gyro_rad_s);
  EXPECT_NE(other.record.accel_m_s2, drawn.record.accel_m_s2);
}

TEST(TiltedRail, AccelerometerHasElementsOfItsOwn) {
  const Numbers numbers = {{"accel_rail_m_s2", 9.0}, {"accel_element_misalignment", 0.05}};
  const SimulatedImu r =
      simulated(wobbling(1.0, 0.1), device(numbers, 2000.0));  // one sample per step, so that no mean hides the plane
  ASSERT_EQ(r.truth.accel_elements.size(), 3u);
  EXPECT_TRUE(r.truth.gyro_elements.empty());  // upright elements: the list is empty
  int clipped = 0;
  for (std::size_t k = 0; k < r.record.accel_m_s2.size(); ++k) {
    for (int i = 0; i < 3; ++i) {
      if ((r.record.clip_flags[k] >> (3 + i) & 1) == 0) continue;
      ASSERT_NEAR(std::abs(r.truth.accel_elements[static_cast<std::size_t>(i)].dot(r.record.accel_m_s2[k])), 9.0, 1e-9);
      ++clipped;
    }
  }
  EXPECT_GT(clipped, 500);
}

TEST(TiltedRail, TheSeedDrawsTheDevice) {
  const SensorSpec sensor = device({{"gyro_element_misalignment", 0.02}, {"accel_element_misalignment", 0.02}});
  const Truth still = wobbling(0.1, 0.1);
  const Isometry3d same_T = Eigen::Isometry3d::Identity();
  const SimulatedImu a = simulated(still, sensor), again = simulated(still, sensor),
                     b = simulated(still, sensor, same_T, 2);
  EXPECT_EQ(a.truth.gyro_elements, again.truth.gyro_elements);
  EXPECT_NE(a.truth.gyro_elements, b.truth.gyro_elements);
  EXPECT_NE(a.truth.gyro_elements, a.truth.accel_elements);
}

TEST(TiltedRail, RefusesOffsetsThatLeaveNoRail) {
  try {
    simulated(wobbling(0.1, 0.1), device({{"gyro_element_offset_rad_s", 4.0}}));
    FAIL() << "an offset of 4 was accepted for a rail of 10";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), HasSubstr("gyro_element_offset_rad_s"));
    EXPECT_THAT(error.what(), HasSubstr("below a third of gyro_rail_rad_s, which is 10"));
  }
}

}  // namespace
}  // namespace tumble::sim
