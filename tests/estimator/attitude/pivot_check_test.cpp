// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/pivot_check.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

const std::string kEvidence = "evidence from rotation about a pivot for other axes, signs or scale of the gyro";
const std::string kScale = "scale of the gyro estimated from rotation about a pivot";

struct PivotMotion {
  Eigen::Vector3d arm_m = {0.05, -0.1, 0.08};  // from the pivot to the sensor
  double shaken_m_s2 = 0.0;
  int samples = 2000;
};

Eigen::Vector3d rate_rad_s(double t_s) {
  return {3.0 * std::sin(2.0 * t_s), 2.0 * std::cos(3.1 * t_s), 1.5 * std::sin(1.3 * t_s + 1.0)};
}

Eigen::Vector3d change_rad_s2(double t_s) {
  return {6.0 * std::cos(2.0 * t_s), -6.2 * std::sin(3.1 * t_s), 1.95 * std::cos(1.3 * t_s + 1.0)};
}

using PivotReadings = std::vector<ImuSample>;

// The body turns about a fixed point, so the readings are known in closed form except for the attitude.
PivotReadings about_a_pivot(const PivotMotion& motion, const std::function<void(ImuSample&)>& harm = {}) {
  constexpr double kStep_s = 0.01;
  constexpr int kFine = 20;
  PivotReadings run;
  oracles::Gaussian noise(5);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int k = 0; k < motion.samples; ++k) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
    for (int j = 0; j < kFine; ++j) {  // a reading is a mean over its window
      const double t_s = kStep_s * (k - 1 + (j + 0.5) / kFine);
      const Eigen::Vector3d w = rate_rad_s(t_s);
      const Eigen::Quaterniond half = so3::exp(0.5 * kStep_s / kFine * w);
      q = q * half;
      force += (change_rad_s2(t_s).cross(motion.arm_m) + w.cross(w.cross(motion.arm_m)) +
                q.conjugate() * Eigen::Vector3d(0, 0, 9.80665)) /
               kFine;
      rate += w / kFine;
      q = (q * half).normalized();
    }
    for (int axis = 0; axis < 3; ++axis) force[axis] += (0.05 + motion.shaken_m_s2) * noise();
    ImuSample sample;
    sample.time_ns = TimeNs{k} * 10'000'000;
    sample.angular_velocity_rad_s = rate;
    sample.specific_force_m_s2 = force;
    if (harm) harm(sample);
    run.push_back(sample);
  }
  return run;
}

PivotMotionCheck evidence_in(const PivotReadings& run) {
  return PivotMotionCheck::of(run, 9.80665, 0.0, 0.0);
}

std::string says(const PivotReadings& run) {
  const Status verdict = evidence_in(run).verdict();
  return verdict.ok() ? "" : verdict.field;
}

TEST(PivotMotionCheck, RatesExplainATurningAboutAPoint) {
  const PivotReadings run = about_a_pivot({});
  const PivotMotionCheck found = evidence_in(run);
  EXPECT_TRUE(found.verdict().ok()) << found.verdict().message();
  EXPECT_EQ(found.comparable_segments, 20u) << "two series of segments of 2 s over 20 s, half a segment apart";
  EXPECT_EQ(found.better_explained_segments, 0u);
  EXPECT_LT(found.log_evidence, 0.0);
  EXPECT_NEAR(found.scale, 1.0, 0.002);
}

TEST(PivotMotionCheck, AGyroNamedOrScaledOtherwiseIsReported) {
  const auto told = [](const std::function<void(Eigen::Vector3d&)>& harm) {
    return says(about_a_pivot({}, [&](ImuSample& sample) { harm(sample.angular_velocity_rad_s); }));
  };
  EXPECT_EQ(told([](Eigen::Vector3d& w) { w = -w; }), kEvidence);
  EXPECT_EQ(told([](Eigen::Vector3d& w) { w.z() = -w.z(); }), kEvidence);
  EXPECT_EQ(told([](Eigen::Vector3d& w) { std::swap(w.x(), w.y()); }), kEvidence);
  EXPECT_EQ(told([](Eigen::Vector3d& w) { w *= 0.5; }), kEvidence);
  EXPECT_EQ(told([](Eigen::Vector3d& w) { w *= 2.0; }), kEvidence);
}

TEST(PivotMotionCheck, ANearPivotDeterminesTheScale) {
  const auto scaled = [](const PivotMotion& motion) {
    return about_a_pivot(motion, [](ImuSample& sample) { sample.angular_velocity_rad_s *= 1.05; });
  };
  const PivotReadings run = scaled({});
  EXPECT_EQ(says(run), kScale);
  EXPECT_NEAR(evidence_in(run).scale, 1.0 / 1.05, 0.01);
  const PivotReadings far = scaled({.arm_m = {0.1, 0.2, 0.6}});
  EXPECT_EQ(evidence_in(far).gyro_scale_segments, 0u) << "a rod is no point: what it gives is larger";
}

TEST(PivotMotionCheck, ClippedReadingsDoNotCount) {
  const PivotReadings run = about_a_pivot({}, [](ImuSample& sample) {
    sample.angular_velocity_rad_s.z() *= -1.0;
    if (sample.time_ns % 900'000'000 == 0) sample.device_clip_flags = kClipGyroX;
  });
  EXPECT_EQ(evidence_in(run).comparable_segments, 0u) << "no segment of a second is left";
  EXPECT_EQ(says(run), "");
}

TEST(PivotMotionCheck, ABodyThatIsThrownAboutIsExplainedByNothing) {
  const PivotReadings run =
      about_a_pivot({.shaken_m_s2 = 40.0}, [](ImuSample& sample) { sample.angular_velocity_rad_s.z() *= -1.0; });
  EXPECT_EQ(evidence_in(run).comparable_segments, 0u);
  EXPECT_EQ(says(run), "");
}

TEST(PivotMotionCheck, AFewSegmentsAreNoEvidence) {
  EXPECT_EQ(says(about_a_pivot({.samples = 500}, [](ImuSample& sample) { sample.angular_velocity_rad_s.z() *= -1.0; })),
            "");
}

}  // namespace
}  // namespace tumble
