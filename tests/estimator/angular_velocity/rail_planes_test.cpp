// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

#include "estimator/angular_velocity/drawn_elements.hpp"
#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/common/status.hpp"

namespace tumble {
namespace {

std::vector<ImuSample> samples_of(const std::vector<Vector3d>& rates) {
  std::vector<ImuSample> out(rates.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    out[k].angular_velocity_rad_s = rates[k];
  }
  return out;
}

// Returns a rate of several sines of size `scale`, smooth like a hand's motion.
Vector3d waving(double t, double scale) {
  return scale * Vector3d(std::sin(3.1 * t) + 0.4 * std::sin(11.3 * t + 1.0), 0.7 * std::sin(4.3 * t + 0.5),
                          0.6 * std::sin(2.3 * t) + 0.3 * std::sin(7.9 * t));
}

// Returns the output of a device with elements along `rows` and `offset`, clipped at `rail`.
std::vector<Vector3d> clipped_along(const std::vector<Vector3d>& rates, const Eigen::Matrix3d& rows,
                                    const Vector3d& offset, double rail) {
  std::vector<Vector3d> out;
  for (const Vector3d& w : rates) {
    const Vector3d sensed = rows * w + offset;
    out.push_back(rows.inverse() * (sensed.cwiseMin(rail).cwiseMax(-rail) - offset));
  }
  return out;
}

std::vector<Vector3d> waved(double scale, double seconds, double noise_rad_s, std::uint64_t seed) {
  oracles::Gaussian noise(seed);
  std::vector<Vector3d> rates;
  for (double t = 0.0; t < seconds; t += 0.01) rates.push_back(waving(t, scale) + noise_rad_s * noise.vector());
  return rates;
}

SaturationPlanes find(const std::vector<Vector3d>& rates) {
  return SaturationPlaneFinder({}).find(samples_of(rates));
}

// Score counts the found saturated samples, all saturated samples, and false detections.
struct Score {
  int deep = 0, found = 0, wrong = 0;
  void add(const std::vector<ImuSample>& samples, const std::vector<Vector3d>& hidden) {
    const SaturationPlanes planes = SaturationPlaneFinder({}).find(samples);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      for (int j = 0; j < 3; ++j) {
        const auto& rail = planes.sensing_axis[static_cast<std::size_t>(j)];
        const Vector3d& reading = samples[k].angular_velocity_rad_s;
        const bool called = rail && (rail->is_saturated(reading, -1) || rail->is_saturated(reading, 1));
        deep += std::abs(hidden[k][j]) > 0.1;
        found += std::abs(hidden[k][j]) > 0.1 && called;
        wrong += called && hidden[k][j] == 0.0;
      }
    }
  }
};

TEST(SaturationPlanes, ThePlaneOfAKnownDeviceComesBack) {
  Eigen::Matrix3d rows;
  rows << 1.0, 0.006, -0.018, -0.04, 1.0, 0.02, 0.05, 0.01, 1.0;
  const Vector3d offset(-0.05, 0.13, 0.0);
  const SaturationPlanes planes = find(clipped_along(waved(12.0, 30.0, 0.004, 1), rows, offset, 7.3));
  for (int j = 0; j < 3; ++j) {
    ASSERT_TRUE(planes.sensing_axis[static_cast<std::size_t>(j)].has_value()) << j;
    const SaturationPlane& rail = *planes.sensing_axis[static_cast<std::size_t>(j)];
    // the element's offset is subtracted after clipping, so the planes are at +-7.3 minus the offset
    EXPECT_NEAR((rail.row - rows.row(j).transpose()).norm(), 0.0, 1e-3) << j;
    EXPECT_NEAR(rail.saturation_limit_rad_s, 7.3, 2e-3) << j;
    EXPECT_NEAR(rail.offset_rad_s, -offset[j], 2e-3) << j;
    EXPECT_TRUE(rail.was_reached(-1) && rail.was_reached(1));
    EXPECT_LT(rail.deviation_rad_s, 1e-3);
  }
}

TEST(SaturationPlanes, DrawnDevicesAreFoundOnTumbles) {
  Score score;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    TumbleOptions options;
    options.seed = seed;
    options.gyro_rows = drawn_rows(seed, seed % 2 == 0 ? 0.02 : 0.05);
    const TumbleRecording tumble = make_tumble(options);
    score.add(tumble.samples, tumble.hidden);
  }
  ASSERT_GT(score.deep, 500);
  EXPECT_GE(score.found, 0.995 * score.deep);
  EXPECT_LE(score.wrong, 0.005 * score.found);
}

TEST(SaturationPlanes, NothingIsFoundWhereNothingClips) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    TumbleOptions options;
    options.seed = seed;
    options.gyro_rail_rad_s = 1e3;
    EXPECT_FALSE(SaturationPlaneFinder({}).find(make_tumble(options).samples).any_plane_found()) << seed;
    EXPECT_FALSE(find(waved(8.0, 20.0, 0.004, seed)).any_plane_found()) << seed;
  }
}

// These motions misled early detectors. A spin is a constant rate that begins and ends with an impact; a top turns
// around slowly.
TEST(SaturationPlanes, SpinsTopsRestAndCreepingAreNoRails) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    oracles::Gaussian noise(seed);
    std::vector<Vector3d> spin, top, rest, creep;
    const double rate = noise.uniform(4.0, 12.0), curve = noise.uniform(1.0, 300.0);
    for (int k = 0; k < 1000; ++k) {
      const double t = 0.01 * k;
      const Vector3d error = 0.005 * noise.vector();
      // torque-free, with a small wobble about its axis
      const Vector3d flight(0.3 * std::cos(5.0 * t), 0.3 * std::sin(5.0 * t), rate);
      spin.push_back((k < 300 || k > 380 ? Vector3d(0.2 * std::sin(3.0 * t), 0.3, 0.1) : flight) + error);
      top.push_back(Vector3d(std::sin(t), std::cos(2.0 * t), 8.0 - curve * std::pow(std::fmod(t, 1.0) - 0.5, 2)) +
                    error);
      rest.push_back(error);
      creep.push_back(Vector3d(0.0, 0.0, k < 300 || k > 700 ? 0.0 : 1.4) + error);
    }
    EXPECT_FALSE(find(spin).any_plane_found()) << seed;
    EXPECT_FALSE(find(top).any_plane_found()) << seed;
    EXPECT_FALSE(find(rest).any_plane_found()) << seed;
    EXPECT_FALSE(find(creep).any_plane_found()) << seed;
  }
}

TEST(SaturationPlanes, ReadingsThatRepeatOrAreCoarseDoNotHideASaturationLimit) {
  const Eigen::Matrix3d rows = drawn_rows(3, 0.03);
  const std::vector<Vector3d> exact = clipped_along(waved(18.0, 20.0, 0.004, 5), rows, Vector3d::Zero(), 10.3);
  std::vector<Vector3d> held;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const Vector3d& latest = exact[k - k % 3];
    held.push_back((latest / 5e-4).array().round().matrix() * 5e-4);
  }
  const SaturationPlanes planes = find(held);
  for (int j = 0; j < 3; ++j) {
    ASSERT_TRUE(planes.sensing_axis[static_cast<std::size_t>(j)].has_value()) << j;
    EXPECT_NEAR((planes.sensing_axis[static_cast<std::size_t>(j)]->row - rows.row(j).transpose()).norm(), 0.0, 3e-3)
        << j;
  }
  // negative control: the same motion, never clipped
  std::vector<Vector3d> free;
  const std::vector<Vector3d> smooth = waved(18.0, 20.0, 0.004, 5);
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    free.push_back((smooth[k - k % 3] / 5e-4).array().round().matrix() * 5e-4);
  }
  EXPECT_FALSE(find(free).any_plane_found());
}

// The low-pass filter of a gyro overshoots where a saturation begins. On each side, two readings are beyond the plane.
TEST(SaturationPlanes, AnOvershootWhereASaturationBeginsHidesNoPlane) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Eigen::Matrix3d rows = drawn_rows(seed, 0.03);
    std::vector<Vector3d> rates = clipped_along(waved(12.0, 10.0, 0.002, seed), rows, Vector3d::Zero(), 7.3);
    int positive = 0, negative = 0;
    for (std::size_t k = 1; k < rates.size(); ++k) {
      const double now = rows.row(0).dot(rates[k]), before = rows.row(0).dot(rates[k - 1]);
      if (std::abs(now) < 7.29 || std::abs(before) > 7.2) continue;
      int& overshoots = now > 0.0 ? positive : negative;
      if (++overshoots <= 2) rates[k][0] += std::copysign(0.3, now);
    }
    ASSERT_GE(std::min(positive, negative), 2) << seed;
    const auto plane = find(rates).sensing_axis[0];
    ASSERT_TRUE(plane.has_value()) << seed;
    EXPECT_TRUE(plane->was_reached(-1) && plane->was_reached(1)) << seed;
    EXPECT_NEAR((plane->row - rows.row(0).transpose()).norm(), 0.0, 3e-3) << seed;
    EXPECT_NEAR(plane->saturation_limit_rad_s, 7.3, 5e-3) << seed;
  }
}

// A stated range speaks against a level far below it, but many segments outweigh it, because the range may have been
// set differently.
TEST(SaturationPlanes, AStatedRangeCountsAsMuchAsItIsWorth) {
  const Eigen::Matrix3d rows = drawn_rows(1, 0.03);
  const std::vector<ImuSample> many =
      samples_of(clipped_along(waved(12.0, 20.0, 0.004, 1), rows, Vector3d::Zero(), 7.3));
  const std::vector<ImuSample> few = samples_of(clipped_along(waved(7.6, 2.5, 0.004, 1), rows, Vector3d::Zero(), 7.3));
  ASSERT_TRUE(SaturationPlaneFinder({.stated_range_rad_s = 7.0}).find(few).any_plane_found());
  EXPECT_FALSE(SaturationPlaneFinder({.stated_range_rad_s = 17.0}).find(few).any_plane_found());
  EXPECT_TRUE(SaturationPlaneFinder({.stated_range_rad_s = 17.0}).find(many).any_plane_found());
}

TEST(SaturationPlanes, ShortAndEmptyRecordingsHaveNone) {
  EXPECT_FALSE(find({}).any_plane_found());
  EXPECT_FALSE(find({Vector3d::Ones(), Vector3d::Zero(), Vector3d::Ones()}).any_plane_found());
}

TEST(SaturationPlanes, ParametersOutsideOfTheirBoundThrow) {
  EXPECT_THROW(SaturationPlaneFinder({.samples_min = 1}), InvalidParams);
  EXPECT_THROW(SaturationPlaneFinder({.stated_range_rad_s = -1.0}), InvalidParams);
}

}  // namespace
}  // namespace tumble
