// SPDX-License-Identifier: BSD-3-Clause
// Tests several merged IMUs whose gyros clip below the stated range, along tilted elements, and with device flags.
#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using testing::kGravity_m_s2;

constexpr double kStated_rad_s = 34.9;
constexpr TimeNs kTick_ns = 4'000'000;
constexpr std::uint8_t kGyroFlags = kClipGyroX | kClipGyroY | kClipGyroZ;

/// TiltedSpin contains three IMUs about the centre of a body that turns about a fixed level axis, up to `top` and down
/// again within 2 s.
struct TiltedSpin {
  double top = 0.0, rail = 1e3;
  std::array<Matrix3d, 3> rows = {Matrix3d::Identity(), Matrix3d::Identity(), Matrix3d::Identity()};
  std::array<Vector3d, 3> position_m{{{0.08, 0.0, 0.01}, {-0.04, 0.069, 0.01}, {-0.04, -0.069, 0.01}}};
  Vector3d axis = Vector3d(0.2, 0.95, -0.24).normalized();

  Vector3d rate(double t) const { return top * std::clamp(std::min(t, 2.0 - t) / 0.4, 0.0, 1.0) * axis; }

  ImuSample sample(std::size_t unit, int k, double angle) const {
    const double t = seconds(k * kTick_ns);
    const Vector3d w = rate(t), a = (rate(t + 1e-4) - rate(t - 1e-4)) / 2e-4;
    ImuSample out;
    out.time_ns = k * kTick_ns;
    const Vector3d sensed = rows[unit] * w, kept = sensed.cwiseMax(-rail).cwiseMin(rail);
    out.angular_velocity_rad_s = rows[unit].inverse() * kept;
    for (int axis_ = 0; axis_ < 3; ++axis_) {
      if (kept[axis_] == sensed[axis_]) continue;
      out.device_clip_flags = static_cast<std::uint8_t>(out.device_clip_flags | kClipGyroX << axis_);
    }
    const Vector3d up = so3::exp(-angle * axis) * Vector3d::UnitZ();
    out.specific_force_m_s2 = kGravity_m_s2 * up + a.cross(position_m[unit]) + w.cross(w.cross(position_m[unit]));
    return out;
  }
};

ImuMerge::Setup tilted_params(const TiltedSpin& spin, int count) {
  ImuMerge::Setup out;
  out.count = count;
  for (std::size_t k = 0; k < 3; ++k) {
    out.T_mean_imu[k] = Eigen::Isometry3d::Identity();
    out.T_mean_imu[k].translation() = spin.position_m[k];
    out.gyro_sensing_directions[k].sensing_directions = spin.rows[k];
  }
  out.gyro_range_rad_s = 0.98 * kStated_rad_s;
  return out;
}

struct RailedMerge {
  double error_rad_s = 0.0;      ///< largest error some time after a gyro has clipped
  double raw_error_rad_s = 0.0;  ///< error of a single gyro
  int clipped = 0, unflagged = 0;
  ImuMerge::State state;
};

/// The first `flagged` IMUs report that they clip.
RailedMerge merge_tilted(const TiltedSpin& spin, const ImuMerge::Setup& p,
                         std::array<bool, 3> flagged = {true, true, true}) {
  const ImuMerge merge(p);
  RailedMerge out;
  double angle = 0.0;
  int since = 0;
  for (int k = 0; k <= 500; ++k) {
    const double t = seconds(k * kTick_ns);
    angle += seconds(kTick_ns) * spin.rate(t).norm();
    std::array<ImuSample, 3> now;
    bool clipped = false;
    for (std::size_t unit = 0; unit < 3; ++unit) {
      now[unit] = spin.sample(unit, k, angle);
      clipped |= now[unit].device_clip_flags != 0;
      if (!flagged[unit]) now[unit].device_clip_flags = 0;
    }
    std::optional<ImuSample> merged;
    EXPECT_TRUE(merge.step(std::span(now).first(static_cast<std::size_t>(p.count)), out.state, merged).ok());
    since = clipped ? since + 1 : 0;
    out.clipped += clipped;
    out.unflagged += clipped && (merged->device_clip_flags & kGyroFlags) == 0;
    if (since <= 25) continue;
    out.error_rad_s = std::max(out.error_rad_s, (merged->angular_velocity_rad_s - spin.rate(t)).norm());
    out.raw_error_rad_s = std::max(out.raw_error_rad_s, (now[0].angular_velocity_rad_s - spin.rate(t)).norm());
  }
  return out;
}

TiltedSpin tilted() {
  TiltedSpin spin{44.0, 0.96 * kStated_rad_s};
  spin.rows[0] << 1.0, 0.03, -0.02, 0.04, 1.0, 0.03, -0.05, 0.02, 1.0;
  spin.rows[1] << 1.0, -0.04, 0.03, -0.03, 1.0, 0.05, 0.02, 0.04, 1.0;
  spin.rows[2] << 1.0, 0.05, 0.04, 0.02, 1.0, -0.04, 0.03, -0.05, 1.0;
  return spin;
}

TEST(ImuMergeSaturation, ReadsTiltedElementsAlongTheirRows) {
  const TiltedSpin spin = tilted();
  const RailedMerge ours = merge_tilted(spin, tilted_params(spin, 3));
  ASSERT_GT(ours.clipped, 100);
  EXPECT_GT(ours.raw_error_rad_s, 5.0);
  EXPECT_LT(ours.error_rad_s, 0.5);
  // negative control: axis by axis, the free axes would be used although they are wrong
  ImuMerge::Setup upright = tilted_params(spin, 3);
  upright.gyro_sensing_directions = {};
  EXPECT_GT(merge_tilted(spin, upright).error_rad_s, 1.5 * ours.error_rad_s);  // measured: 0.275 and 0.139 rad/s
}

// The device saturates at 12 rad/s, where its data sheet states 34.9, and sets its flag.
TEST(ImuMergeSaturation, AFlagFarBelowTheRangeIsUsed) {
  const TiltedSpin spin{16.0, 12.0};
  const RailedMerge ours = merge_tilted(spin, tilted_params(spin, 3));
  ASSERT_GT(ours.clipped, 100);
  EXPECT_GT(ours.raw_error_rad_s, 2.0);
  EXPECT_LT(ours.error_rad_s, 0.5);
  // negative control: without flags, the saturation is not detectable
  EXPECT_GT(merge_tilted(spin, tilted_params(spin, 3), {false, false, false}).error_rad_s, 2.0);
}

TEST(ImuMergeSaturation, OneUnitOrTwoKeepTheirFlags) {
  const TiltedSpin spin{16.0, 12.0};
  for (const int count : {1, 2}) {
    const RailedMerge ours = merge_tilted(spin, tilted_params(spin, count));
    ASSERT_GT(ours.clipped, 100);
    EXPECT_EQ(ours.unflagged, 0) << count;
  }
}

TEST(ImuMergeSaturation, FlagsTurnWithTheMounting) {
  const TiltedSpin spin{16.0, 12.0};
  ImuMerge::Setup p = tilted_params(spin, 1);
  p.T_mean_imu[0].linear() = so3::exp(0.5 * 3.14159265358979 * Vector3d::UnitZ()).toRotationMatrix();
  const ImuMerge merge(p);
  ImuMerge::State state;
  std::optional<ImuSample> merged;
  std::array<ImuSample, 1> now = {spin.sample(0, 0, 0.0)};
  now[0].device_clip_flags = kClipGyroX | kClipAccelY;
  ASSERT_TRUE(merge.step(now, state, merged).ok());
  EXPECT_EQ(merged->device_clip_flags, kClipGyroY | kClipAccelX);
}

TEST(ImuMergeSaturation, OfTwoTheUnsaturatedOneIsUsed) {
  TiltedSpin spin{16.0, 12.0};
  const ImuMerge merge(tilted_params(spin, 2));
  ImuMerge::State state;
  double angle = 0.0, error = 0.0;
  for (int k = 0; k <= 500; ++k) {
    angle += seconds(kTick_ns) * spin.rate(seconds(k * kTick_ns)).norm();
    std::array<ImuSample, 2> now = {spin.sample(0, k, angle), spin.sample(1, k, angle)};
    now[1].angular_velocity_rad_s = spin.rate(seconds(k * kTick_ns));
    now[1].device_clip_flags = 0;
    std::optional<ImuSample> merged;
    ASSERT_TRUE(merge.step(now, state, merged).ok());
    EXPECT_EQ(merged->device_clip_flags, 0) << k;
    error = std::max(error, (merged->angular_velocity_rad_s - spin.rate(seconds(k * kTick_ns))).norm());
  }
  EXPECT_LT(error, 1e-6);
  // the deficit of the clipped IMU must not count as an error of its scale or bias
  EXPECT_LT(state.imus[0].x.head<12>().norm(), 1e-3);
}

}  // namespace
}  // namespace tumble
