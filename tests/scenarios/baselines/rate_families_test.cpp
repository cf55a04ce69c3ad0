// SPDX-License-Identifier: BSD-3-Clause
// The test runs the interpolation of clipped readings on a swing in closed form, for which it was made.
#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"

namespace tumble::baselines {
namespace {

constexpr double kRail = 10.5, kPeriod = 0.01, kGravity = 9.80665;

// Swing is a swing about a fixed horizontal axis, smooth, from rest to rest, that exceeds the saturation level once:
// rate = peak sin^2(pi t / T).
struct Swing {
  Vector3d axis = Vector3d(0.2, 1.0, 0.1).normalized();
  double peak = 13.0, duration = 0.6, rest = 1.0;

  double phase(double t) const { return std::clamp((t - rest) / duration, 0.0, 1.0); }
  double rate(double t) const { return peak * std::pow(std::sin(std::numbers::pi * phase(t)), 2); }
  double acceleration(double t) const {
    const double pi = std::numbers::pi;
    return phase(t) <= 0.0 || phase(t) >= 1.0 ? 0.0 : peak * pi / duration * std::sin(2.0 * pi * phase(t));
  }
  double angle(double t) const {
    const double pi = std::numbers::pi, s = phase(t);
    return peak * duration * (0.5 * s - std::sin(2.0 * pi * s) / (4.0 * pi));
  }
  std::size_t count() const { return static_cast<std::size_t>(std::lround((2.0 * rest + duration) / kPeriod)); }
  double middle(std::size_t k) const { return (static_cast<double>(k) + 0.5) * kPeriod; }
  Vector3d truth(std::size_t k) const { return axis * rate(middle(k)); }
  // returns a vector that is constant in the world, in the turning body axes
  Vector3d turned(const Vector3d& v_W, std::size_t k) const { return Eigen::AngleAxisd(-angle(middle(k)), axis) * v_W; }
  Vector3d force_at(const Vector3d& p_I_m, std::size_t k) const {
    const Vector3d w = truth(k), alpha = axis * acceleration(middle(k));
    return turned(Vector3d(0.0, 0.0, kGravity), k) + alpha.cross(p_I_m) + w.cross(w.cross(p_I_m));
  }

  std::vector<ImuSample> samples() const {
    std::vector<ImuSample> out(count());
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k].time_ns = static_cast<TimeNs>(k + 1) * 10'000'000;
      out[k].angular_velocity_rad_s = truth(k).cwiseMin(kRail).cwiseMax(-kRail);
      out[k].specific_force_m_s2 = force_at(Vector3d::Zero(), k);
    }
    return out;
  }
  bool clipped(std::size_t k) const { return truth(k).cwiseAbs().maxCoeff() > kRail; }
  double worst(const std::function<Vector3d(std::size_t)>& estimate) const {
    double worst = 0.0;
    for (std::size_t k = 0; k < count(); ++k) {
      if (clipped(k)) worst = std::max(worst, (estimate(k) - truth(k)).norm());
    }
    return worst;
  }
};

SaturationLimitDetector::Params rails() {
  return {.stated_gyro_range_rad_s = kRail};
}

template <typename Run>
double worst_of(const Swing& swing, Run run) {
  std::vector<AngularRateState> states;
  const Status status = run(states);
  EXPECT_TRUE(status.ok()) << status.message();
  if (states.size() != swing.count()) return std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_GE(states[k].clipped_axes != 0, swing.clipped(k)) << k;  // partly clipped windows at the edge may count too
    EXPECT_GT(states[k].covariance_rad2_s2(1, 1), 0.0) << k;
  }
  return swing.worst([&](std::size_t k) { return states[k].w_WI_I_rad_s; });
}

double worst_baseline(const Swing& swing) {
  const std::vector<ImuSample> samples = swing.samples();
  return worst_of(swing, [&](std::vector<AngularRateState>& out) {
    return ClippedBaseline({.rails = rails()}).estimate(samples, out);
  });
}

double raw(const Swing& swing) {
  const std::vector<ImuSample> samples = swing.samples();
  return swing.worst([&](std::size_t k) { return samples[k].angular_velocity_rad_s; });
}

TEST(ClippedBaseline, BridgesASwingThatPassesTheRailOnce) {
  const Swing swing;
  EXPECT_NEAR(raw(swing), 2.15, 0.1);
  EXPECT_LT(worst_baseline(swing), 0.35 * raw(swing));  // measured 0.21
}

TEST(ClippedBaseline, RefusesBadInput) {
  const Swing swing;
  std::vector<ImuSample> spoilt = swing.samples(), falling = spoilt;
  spoilt[50].angular_velocity_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  std::swap(falling[50].time_ns, falling[51].time_ns);
  std::vector<AngularRateState> out(3);
  const auto refuses = [&](auto estimate) {
    EXPECT_EQ(estimate(std::span<const ImuSample>{}).error_code, ErrorCode::empty);
    EXPECT_EQ(estimate(std::span<const ImuSample>(spoilt)).error_code, ErrorCode::non_finite);
    EXPECT_EQ(estimate(std::span<const ImuSample>(falling)).error_code, ErrorCode::time_order);
    EXPECT_EQ(out.size(), 3u);  // the output is unchanged
  };
  refuses([&](std::span<const ImuSample> s) { return ClippedBaseline(ClippedBaseline::Params{}).estimate(s, out); });
  EXPECT_THROW(ClippedBaseline({.rails = {}, .rate_max_rad_s = 0.0}), InvalidParams);
}

// The test uses a rate that crosses the saturation level with constant slope, for which loss and reading have a closed
// form.
TEST(PartialSaturation, IsExactForAConstantSlope) {
  for (const double slope : {0.5, 2.0, 5.0}) {    // slope per window
    for (const double share : {0.2, 0.5, 0.8}) {  // clipped share of the window
      const double free = 1.0 - share, reading = kRail - 0.5 * free * free * slope;
      const double unclipped = reading + 0.5 * share * share * slope, neighbour = unclipped - slope;
      const PartialSaturation loss = partial_saturation(reading, neighbour, kRail, 1e-6);
      ASSERT_TRUE(loss.saturated) << slope << " " << share;
      EXPECT_NEAR(loss.expected_saturation_deficit_rad_s, 0.5 * share * share * slope, 1e-9) << slope << " " << share;
      EXPECT_GT(loss.sigma_rad_s, 0.0);
    }
  }
  EXPECT_FALSE(partial_saturation(kRail, 9.0, kRail, 1e-3).saturated);         // hidden all along
  EXPECT_FALSE(partial_saturation(kRail - 1e-3, 0.0, kRail, 1e-6).saturated);  // but for a hundredth
  // a plateau sinks, as at a saturation level tilted by a thousandth: the samples are flagged throughout, and there is
  // no step to a neighbouring sample
  EXPECT_FALSE(partial_saturation(kRail - 2e-3, kRail - 2.1e-3, kRail, 5e-3).saturated);
  EXPECT_TRUE(partial_saturation(kRail - 0.05, kRail - 0.3, kRail, 5e-3).saturated);
}

// All readings sink from sample to sample along a tilted saturation level, and all are flagged: none of them was
// saturated for only a part of its window, except the one that follows an unsaturated reading.
TEST(PartialSaturation, OfAFlaggedNeighbourNothingIsReported) {
  SaturationLimitDetector::State state;
  state.channels[0].plateau_limit = kRail;
  const SaturationLimitDetector rails({});
  ASSERT_TRUE(rails.saturation_limit(state, 0).has_value());
  std::vector<ImuSample> samples(6);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].angular_velocity_rad_s.x() = kRail - 0.1 - 0.02 * static_cast<double>(samples.size() - k);
    samples[k].device_clip_flags = kClipGyroX;
  }
  samples[0].angular_velocity_rad_s.x() = kRail - 2.0;
  samples[0].device_clip_flags = 0;
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    AngularRateObservation now;
    now.sample = samples[k];
    now.clipping.gyro = 1;
    mark_partial_saturation(rails, state, 5e-3, &samples[k - 1], now, &samples[k + 1]);
    EXPECT_EQ(now.partial_saturation_flags, k == 1 ? 1 : 0) << k;
    // negative control: the sample before is treated as unsaturated
    ImuSample before = samples[k - 1];
    before.device_clip_flags = 0;
    mark_partial_saturation(rails, state, 5e-3, &before, now, &samples[k + 1]);
    EXPECT_EQ(now.partial_saturation_flags, 1) << k;
  }
}

}  // namespace
}  // namespace tumble::baselines
