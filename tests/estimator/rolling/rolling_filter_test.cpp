// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/detail/rolling_filter.hpp"

#include "estimator/rolling/rolling_truth.hpp"
#include "scenarios/baselines/rolling/rolling_odometry.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::l_shape;
using testing::no_slip;
using testing::RollingMotion;
using testing::RollingTruth;
using Contact = std::function<Eigen::Vector3d(double)>;

/// Noise generates normal numbers that are equal on every machine: SplitMix64 and a sum of twelve.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  Eigen::Vector3d vector() { return {normal(), normal(), normal()}; }
  Eigen::Matrix3d matrix() {
    Eigen::Matrix3d m;
    m << vector(), vector(), vector();
    return m;
  }

 private:
  double uniform() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double normal() {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += uniform();
    return sum;
  }
  std::uint64_t state_;
};

/// Returns a contact velocity that rises to `u` and falls again, each within a fifth of the event.
Contact event(double start_s, double length_s, const Eigen::Vector3d& u) {
  return [=](double t) -> Eigen::Vector3d {
    const auto rise = [edge = 0.2 * length_s](double s) {
      const double x = std::clamp(s / edge, 0.0, 1.0);
      return x * x * (3.0 - 2.0 * x);
    };
    return rise(t - start_s) * rise(start_s + length_s - t) * u;
  };
}

using testing::kLeverArm;

RollingTruth truth_of(const Contact& velocity, const Contact& contact, double duration_s = 10.0) {
  return testing::roll({.velocity_m_s = velocity,
                        .contact_velocity_m_s = contact,
                        .duration_s = duration_s,
                        .lever_arm_m = kLeverArm,
                        .q_start = so3::exp({0.0, -0.2, 0.0}) * so3::exp({0.1, 0.0, 0.0})});
}

/// Adds errors of a gyro and accelerometer of the Phidget class: bias 0.017 deg/s and 3 mg, scale and misalignment 0.2
/// and 0.3 %, noise 0.23 deg/s and 3 mg per sample at 250 Hz.
void add_errors(std::uint64_t seed, RollingTruth& truth) {
  Noise noise(seed);
  const Eigen::Vector3d w_bias = 3e-4 * noise.vector(), f_bias = 0.03 * noise.vector();
  const Eigen::Matrix3d w_scale = 2e-3 * noise.matrix(), f_scale = 3e-3 * noise.matrix();
  for (ImuSample& sample : truth.samples) {
    sample.angular_velocity_rad_s += w_bias + w_scale * sample.angular_velocity_rad_s + 0.004 * noise.vector();
    sample.specific_force_m_s2 += f_bias + f_scale * sample.specific_force_m_s2 + 0.03 * noise.vector();
  }
}

struct Result {
  double end_error_m = 0.0, end_sigma_m = 0.0;
  double recall = 1.0, precision = 1.0;  ///< of samples without grip, contact velocities of 1 to 50 mm/s not counted
  double delay_s = 0.0;                  ///< from 50 mm/s of contact velocity to the first sample without grip
};

Result filtered(const RollingTruth& truth, const Contact& contact, const RollingFilter::Params& params) {
  const RollingFilter filter(params);
  const auto state = std::make_unique<RollingFilter::State>();  // 360 KiB
  int hit = 0, missed = 0, wrong = 0;
  Result result;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    const Status status = filter.step(truth.samples[k], *state);
    EXPECT_TRUE(status.ok()) << k << ": " << status.message();
    const bool may_slip = contact(seconds(truth.samples[k].time_ns)).norm() > 0.05;
    const bool found = state->mode != ContactMode::grip;
    if (may_slip && hit == 0 && !found) result.delay_s += 0.004;
    hit += may_slip && found;
    missed += may_slip && !found;
    wrong += found && truth.gripping[k];
  }
  if (hit + missed > 0) result.recall = static_cast<double>(hit) / (hit + missed);
  if (hit + wrong > 0) result.precision = static_cast<double>(hit) / (hit + wrong);
  result.end_error_m = (state->sphere_centre_W_m - truth.p_WG_m.back()).norm();
  result.end_sigma_m = std::sqrt(state->position_covariance_m2.trace());
  return result;
}

double rolling_error(const RollingTruth& truth) {
  const baselines::RollingOdometry odometry({});
  baselines::RollingOdometry::State state;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    EXPECT_TRUE(
        odometry.step(truth.samples[k].time_ns, truth.samples[k].angular_velocity_rad_s, truth.q_WI[k], state).ok());
  }
  return (state.p_WG_m - truth.p_WG_m.back()).norm();
}

struct Case {
  const char* name;
  Contact velocity, contact;
  double rolling_at_least_m;  ///< lower bound for the error of pure rolling, so that the case is meaningful
};

std::vector<Case> cases() {
  const Contact slip = event(2.8, 0.8, {-0.6, 0.1, 0.0}), slide = event(2.8, 0.8, {0.3, 0.0, 0.0});
  const Contact pushed = event(1.9, 0.8, {0.4, 0.0, 0.0});
  const Contact pushed_path = [pushed](double t) -> Eigen::Vector3d { return l_shape(t) + pushed(t); };
  return {{"clean", l_shape, no_slip, 0.0},
          {"slip", l_shape, slip, 0.3},
          {"slide", l_shape, slide, 0.15},
          {"slide before roll", pushed_path, pushed, 0.2}};
}

TEST(RollingFilter, PerfectSensorsLeaveLittle) {
  for (const Case& c : cases()) {
    const RollingTruth truth = truth_of(c.velocity, c.contact);
    EXPECT_GE(rolling_error(truth), c.rolling_at_least_m) << c.name;
    EXPECT_LT(filtered(truth, c.contact, {.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm}).end_error_m, 0.004)
        << c.name;  // measured 0 to 2.4 mm
  }
}

TEST(RollingFilter, StandsStillWhereTheSphereDoes) {
  const Contact slip = event(2.8, 0.8, {-0.6, 0.1, 0.0});
  RollingTruth truth = truth_of(l_shape, slip);
  add_errors(1001, truth);
  const RollingFilter filter({.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
  const auto state = std::make_unique<RollingFilter::State>();
  double drift_m = 0.0;
  int still = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    ASSERT_TRUE(filter.step(truth.samples[k], *state).ok());
    const double time_s = seconds(truth.samples[k].time_ns);
    if (time_s < 8.3) continue;  // the roll ends at 8.0 s
    if (still++ == 0) first = state->sphere_centre_W_m;
    drift_m = std::max(drift_m, (state->sphere_centre_W_m - first).norm());
  }
  EXPECT_EQ(still, 426);
  EXPECT_EQ(drift_m, 0.0);
  EXPECT_LT((first - truth.p_WG_m.back()).norm(), 0.02);  // the path before must not be corrected yet
}

TEST(RollingFilter, ProbabilityOfSlipIsThatOfAllHypotheses) {
  const Contact slip = event(2.8, 0.8, {-0.6, 0.1, 0.0});
  RollingTruth truth = truth_of(l_shape, slip);
  add_errors(1002, truth);
  const RollingFilter filter({.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
  const auto state = std::make_unique<RollingFilter::State>();
  double deepest = 0.0, before = 0.0;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    ASSERT_TRUE(filter.step(truth.samples[k], *state).ok());
    ASSERT_GE(state->slip_probability, 0.0);
    ASSERT_LE(state->slip_probability, 1.0);
    const double time_s = seconds(truth.samples[k].time_ns);
    if (time_s > 2.0 && time_s < 2.78) before = std::max(before, state->slip_probability);
    if (time_s > 3.1 && time_s < 3.3) deepest = std::max(deepest, 1.0 - state->slip_probability);
  }
  EXPECT_LT(before, 0.2);
  EXPECT_LT(deepest, 1e-3);
}

/// With a gyro of large angle random walk, an event is uncertain; without an event, the position is never uncertain.
TEST(RollingFilter, CallsAnEventUncertainByHowMuchItsSigmaGrows) {
  const Contact slip = event(2.8, 0.8, {-0.6, 0.1, 0.0});
  const double usual_rad_sqrts = RollingParams{}.expert.noise.attitude_walk_rad_sqrts;
  const auto called = [&](const Contact& contact, double attitude_walk_rad_sqrts) {
    RollingTruth truth = truth_of(l_shape, contact);
    add_errors(1003, truth);
    const RollingFilter filter({.radius_m = testing::kRadius_m,
                                .lever_arm_m = kLeverArm,
                                .expert = {.noise = {.attitude_walk_rad_sqrts = attitude_walk_rad_sqrts}}});
    const auto state = std::make_unique<RollingFilter::State>();
    int inside = 0, outside = 0;
    for (std::size_t k = 0; k < truth.samples.size(); ++k) {
      EXPECT_TRUE(filter.step(truth.samples[k], *state).ok());
      const double time_s = seconds(truth.samples[k].time_ns);
      (time_s > 2.78 && time_s < 3.75 ? inside : outside) += state->position_uncertain;
    }
    return std::pair(inside, outside);
  };
  EXPECT_GT(called(slip, 0.05).first, 20);  // the integrated tilt error grows beyond 3 cm within half a second
  EXPECT_EQ(called(slip, usual_rad_sqrts).second, 0);
  EXPECT_EQ(called(no_slip, usual_rad_sqrts), std::pair(0, 0));
}

TEST(RollingFilter, FindsItsWayThroughSlipAndSlide) {
  for (const Case& c : cases()) {
    for (const std::uint64_t seed : {1001, 1002, 1003}) {  // seeds that were not used in development
      RollingTruth truth = truth_of(c.velocity, c.contact);
      add_errors(seed, truth);
      const Result r = filtered(truth, c.contact, {.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
      std::printf("%-18s seed %d: end %.4f m, sigma %.4f, recall %.2f, precision %.2f, delay %.3f s\n", c.name,
                  static_cast<int>(seed), r.end_error_m, r.end_sigma_m, r.recall, r.precision, r.delay_s);
      EXPECT_LT(r.end_error_m, 0.02) << c.name << " " << seed;  // 1 % of the path; measured up to 0.5 %
      EXPECT_LT(r.end_error_m, 4.0 * r.end_sigma_m) << c.name << " " << seed;
      EXPECT_GT(r.recall, 0.9) << c.name << " " << seed;
      // live: the end of an event is detected late; measured 0.85 to 1
      EXPECT_GT(r.precision, 0.8) << c.name << " " << seed;
      EXPECT_LE(r.delay_s, 0.03) << c.name << " " << seed;
    }
  }
}

/// A slide over two seconds with constant spin: its contact velocity is on a plateau, which looks like grip at another
/// speed until the floor grips again.
TEST(RollingFilter, AConstrainedSpinIsNotTakenForGrip) {
  const auto along = [](double speed) { return Eigen::Vector3d(speed, 0.0, 0.0); };
  const auto rise = [](double s) {
    const double x = std::clamp(s, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
  };
  const Contact velocity = [=](double t) { return along(0.45 * rise((t - 2.0) / 0.5) * rise((8.0 - t) / 0.5)); };
  for (const std::uint64_t seed : {1011, 1012, 1013, 1014, 1015, 1016}) {
    const double position_constrained =
        0.02 * static_cast<double>(seed - 1008);  // contact velocities of 0.06 to 0.16 m/s
    const Contact contact = [=](double t) {
      return along(position_constrained * rise((t - 4.0) / 0.1) * rise((6.0 - t) / 0.1));
    };
    RollingTruth truth = truth_of(velocity, contact);
    add_errors(seed, truth);
    const Result r = filtered(truth, contact, {.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
    std::printf("held spin %.2f m/s: end %.4f m, sigma %.4f, recall %.2f\n", position_constrained, r.end_error_m,
                r.end_sigma_m, r.recall);
    EXPECT_LT(r.end_error_m, 0.03) << position_constrained;  // path of 2.5 m
    EXPECT_LT(r.end_error_m, 4.0 * r.end_sigma_m) << position_constrained;
  }
}

TEST(RollingFilter, KnowsThatALongSpinIsLessCertain) {
  double sigma[2] = {0.0, 0.0};
  for (const int k : {0, 1}) {
    const Contact contact = event(2.8, k == 0 ? 0.3 : 2.0, {-0.6, 0.1, 0.0});
    RollingTruth truth = truth_of(l_shape, contact);
    add_errors(1006, truth);
    const Result r = filtered(truth, contact, {.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
    EXPECT_LT(r.end_error_m, 4.0 * r.end_sigma_m) << k;
    sigma[k] = r.end_sigma_m;
  }
  EXPECT_GT(sigma[1], 2.0 * sigma[0]);
}

TEST(RollingFilter, LateAccelerometerIsFoundOut) {
  const Case slip = cases()[1];
  RollingTruth truth = truth_of(slip.velocity, slip.contact);
  for (std::size_t k = truth.samples.size() - 1; k > 1; --k) {  // 8 ms
    truth.samples[k].specific_force_m_s2 = truth.samples[k - 2].specific_force_m_s2;
  }
  const double with =
      filtered(truth, slip.contact, {.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm}).end_error_m;
  const double without =
      filtered(
          truth, slip.contact,
          {.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm, .expert = {.prior = {.accel_delay_sigma_s = 0.0}}})
          .end_error_m;
  EXPECT_LT(with, 0.02);
  EXPECT_GT(without, 2.0 * with);
}

TEST(RollingFilter, StandsStill) {
  RollingTruth truth = truth_of(no_slip, no_slip, 30.0);
  add_errors(1004, truth);
  const RollingFilter filter({.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
  const auto state = std::make_unique<RollingFilter::State>();
  Eigen::Vector3d early = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    ASSERT_TRUE(filter.step(truth.samples[k], *state).ok());
    if (k == 500) early = state->sphere_centre_W_m;
  }
  EXPECT_TRUE(state->at_rest);
  EXPECT_LT((state->sphere_centre_W_m - early).norm(), 1e-3);
  EXPECT_EQ(state->hypothesis_count, 1) << "hypotheses about a past that no longer matters";
}

TEST(RollingFilter, SplitRunsEqual) {
  const Case slip = cases()[1];
  RollingTruth truth = truth_of(slip.velocity, slip.contact, 4.0);
  add_errors(1005, truth);
  const RollingFilter filter({.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
  const auto feed = [&](std::size_t from, std::size_t to, RollingFilter::State& state) {
    for (std::size_t k = from; k < to; ++k) ASSERT_TRUE(filter.step(truth.samples[k], state).ok());
  };
  const std::size_t count = truth.samples.size();
  const auto whole = std::make_unique<RollingFilter::State>();
  feed(0, count, *whole);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{503}, std::size_t{760}, count - 1}) {
    const auto first = std::make_unique<RollingFilter::State>();
    feed(0, cut, *first);
    EXPECT_FALSE(*first == *whole);
    const auto second = std::make_unique<RollingFilter::State>(*first);
    feed(cut, count, *second);
    EXPECT_TRUE(*second == *whole) << cut;
  }
}

TEST(RollingFilter, RefusesBadInputAndKeepsItsState) {
  const RollingTruth truth = truth_of(l_shape, no_slip, 3.0);
  const RollingFilter filter({.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
  const auto state = std::make_unique<RollingFilter::State>();
  ImuSample falling = truth.samples[0];
  falling.specific_force_m_s2.setZero();
  EXPECT_EQ(filter.step(falling, *state).error_code, ErrorCode::degenerate);
  EXPECT_FALSE(state->started);
  for (std::size_t k = 0; k < 600; ++k) ASSERT_TRUE(filter.step(truth.samples[k], *state).ok());
  const auto before = std::make_unique<RollingFilter::State>(*state);
  ImuSample bad = truth.samples[600];
  bad.angular_velocity_rad_s.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter.step(bad, *state).error_code, ErrorCode::non_finite);
  EXPECT_EQ(filter.step(truth.samples[599], *state).error_code, ErrorCode::time_order);
  ImuSample late = truth.samples[640];
  late.time_ns = truth.samples[599].time_ns + 1'000'000'001;  // the longest gap is 1 s
  EXPECT_EQ(filter.step(late, *state).error_code, ErrorCode::gap);
  EXPECT_TRUE(*state == *before);
  EXPECT_TRUE(filter.step(truth.samples[600], *state).ok());
}

TEST(RollingFilter, RefusesBadParams) {
  constexpr double r = testing::kRadius_m;
  EXPECT_NO_THROW(RollingFilter({.radius_m = r}));
  EXPECT_THROW(RollingFilter({}), InvalidParams) << "the radius has no default";
  EXPECT_THROW(RollingFilter({.radius_m = r, .lever_arm_m = {0, 0, 11}}), InvalidParams);
  EXPECT_THROW(RollingFilter({.radius_m = r, .expert = {.noise = {.rate_error_sqrts = -1.0}}}), InvalidParams);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RollingFilter({.radius_m = r, .expert = {.modes = {.slip_begins_per_s = kNan}}}), InvalidParams);
}

}  // namespace
}  // namespace tumble
