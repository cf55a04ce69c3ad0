// SPDX-License-Identifier: BSD-3-Clause
// Tests the tracking states: all transitions as a table, and what determines the verdict.

#include "estimator/src/mapping/relocalizer.hpp"
#include "tests/estimator/mapping/room_tumble.hpp"
#include "tests/testing.hpp"

namespace tumble::mapping {
namespace {

using enum SweepVerdict;
using enum RegistrationOutcome;

std::string text(const TrackingState& state) {
  struct Name {
    std::string operator()(const WaitingForStart&) const { return "waiting"; }
    std::string operator()(const Tracking& s) const { return "tracking " + std::to_string(s.failed_searches); }
    std::string operator()(const TrackingLost& s) const {
      return "lost " + std::to_string(s.sweeps) + " " + std::to_string(s.failed_searches);
    }
    std::string operator()(const Relocalised& s) const {
      return "found after " + std::to_string(s.rejected_sweeps_before) + " " + std::to_string(s.failed_searches) +
             ", agree " + std::to_string(s.agreeing_sweep_count);
    }
  };
  return std::visit(Name{}, state);
}

TEST(Tracking, GoesFromStateToStateAsTheTableSays) {
  struct Row {
    TrackingState before;
    RegistrationOutcome placement;
    SweepVerdict verdict;
    const char* after;
  };
  const Row rows[] = {
      {WaitingForStart{}, not_attempted, first, "tracking 0"},
      {WaitingForStart{}, not_attempted, rejected, "lost 1 0"},  // too few points to start a map
      {Tracking{}, alignment_found, registered, "tracking 0"},
      {Tracking{}, alignment_found, degenerate, "tracking 0"},
      {Tracking{2}, alignment_found, registered, "tracking 0"},
      {Tracking{}, failed, degenerate, "tracking 1"},  // with a certain prior
      {Tracking{1}, failed, rejected, "lost 1 2"},
      {Tracking{1}, not_attempted, rejected, "lost 1 1"},  // without points, there is no search
      {TrackingLost{1, 1}, failed, rejected, "lost 2 2"},
      {TrackingLost{1, 1}, not_attempted, rejected, "lost 2 1"},
      {TrackingLost{5, 29}, failed, degenerate, "tracking 30"},  // the state is given up
      {TrackingLost{2, 0}, not_attempted, first, "tracking 0"},
      {TrackingLost{3, 2}, alignment_found, registered, "tracking 0"},
      {TrackingLost{3, 2}, relocalisation_unconfirmed, registered, "found after 3 2, agree 0"},
      {TrackingLost{3, 2}, relocalisation_unconfirmed, degenerate, "found after 3 2, agree 0"},
      {Tracking{1}, relocalisation_unconfirmed, registered, "tracking 0"},
      {Relocalised{3, 2, 0}, alignment_found, degenerate, "found after 3 2, agree 1"},
      {Relocalised{3, 2, 1}, alignment_found, registered, "tracking 0"},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(text(tracking_state_after_sweep(row.before, row.placement, row.verdict)), row.after)
        << "from " << text(row.before);
  }
}

TEST(Tracking, APlaceFoundAgainIsContradictedByAllButOneThatFits) {
  for (const RegistrationOutcome placement : {not_attempted, failed, relocalisation_unconfirmed}) {
    EXPECT_TRUE(contradicts_tracking(Relocalised{3, 2, 1}, placement));
    EXPECT_FALSE(contradicts_tracking(Tracking{}, placement));
    EXPECT_FALSE(contradicts_tracking(TrackingLost{}, placement));
  }
  EXPECT_FALSE(contradicts_tracking(Relocalised{3, 2, 1}, alignment_found));
  EXPECT_EQ(text(after_reverted_relocalisation(Relocalised{3, 2, 1})), "lost 5 3");
}

TEST(Tracking, AnswersOfItsStates) {
  EXPECT_FALSE(has_started(WaitingForStart{}));
  EXPECT_TRUE(has_started(TrackingLost{}));
  EXPECT_TRUE(is_lost(TrackingLost{}));
  EXPECT_FALSE(is_lost(Relocalised{4}));
  EXPECT_TRUE(is_unconfirmed_relocalisation(Relocalised{4}));
  EXPECT_FALSE(is_unconfirmed_relocalisation(TrackingLost{4}));
  EXPECT_EQ(consecutive_rejected_sweeps(TrackingLost{4, 2}), 4);
  EXPECT_EQ(consecutive_rejected_sweeps(Relocalised{4}), 0);
  EXPECT_EQ(failed_searches(TrackingLost{4, 2}), 2);
  EXPECT_EQ(failed_searches(Relocalised{4}), 0);
}

struct DelayGrid {
  RegistrationAttempt attempt;
  SweepRegistration placed;
};

DelayGrid aligned(double least_constrained_sigma_m) {
  DelayGrid out;
  out.placed.alignment.emplace().least_constrained_sigma_m = least_constrained_sigma_m;
  return out;
}

DelayGrid failed_with(bool too_few) {
  DelayGrid out;
  out.attempt.too_few_matches = too_few;
  return out;
}

SweepRegistration judged(const TrackingState& before, std::size_t points, bool trusted, DelayGrid tried) {
  judge_registration(before, points, trusted, tried.attempt, tried.placed);
  return tried.placed;
}

TEST(Tracking, VerdictsAreWhatTheAttemptAndThePriorAllow) {
  const auto verdict = [&](const TrackingState& before, std::size_t points, bool trusted, DelayGrid tried) {
    return judged(before, points, trusted, std::move(tried)).verdict;
  };
  EXPECT_EQ(verdict(Tracking{}, 500, false, aligned(0.15)), registered);
  EXPECT_EQ(verdict(Tracking{}, 500, false, aligned(0.16)), degenerate);
  EXPECT_EQ(verdict(Tracking{}, 500, true, failed_with(true)), degenerate);
  EXPECT_EQ(verdict(Tracking{}, 500, false, failed_with(true)), rejected);
  EXPECT_EQ(verdict(Tracking{}, 99, true, failed_with(true)), rejected);
  EXPECT_EQ(verdict(Tracking{}, 500, true, failed_with(false)), rejected);
  EXPECT_EQ(verdict(TrackingLost{28, 28}, 500, false, failed_with(false)), rejected);
  EXPECT_EQ(verdict(TrackingLost{29, 29}, 500, false, failed_with(false)), degenerate);
  EXPECT_EQ(verdict(TrackingLost{29, 29}, 99, false, failed_with(false)), rejected);
  EXPECT_TRUE(judged(Tracking{}, 500, false, failed_with(true)).map_too_sparse);
  EXPECT_FALSE(judged(Tracking{}, 500, false, failed_with(false)).map_too_sparse);
  EXPECT_FALSE(judged(Tracking{}, 99, false, failed_with(true)).map_too_sparse);
  EXPECT_EQ(judged(Tracking{}, 500, false, aligned(0.1)).outcome, alignment_found);
  EXPECT_EQ(judged(Tracking{}, 500, true, failed_with(true)).outcome, failed);
}

/// Returns a relocalisation with `inliers` inliers among a hundred matches.
DelayGrid aligned_of(std::size_t inliers, bool expected) {
  DelayGrid out = aligned(0.1);
  out.placed.alignment->matches = 100;
  out.placed.alignment->inliers = inliers;
  out.placed.agrees_with_prediction = expected;
  return out;
}

TEST(Tracking, ARelocalisationIsUnconfirmedWhereInertiaOrSurfacesContradictIt) {
  const LidarInertialOdometry::Params params;
  const auto placement = [&](const TrackingState& before, std::size_t inliers, bool expected) {
    return judged(before, 500, false, aligned_of(inliers, expected)).outcome;
  };
  EXPECT_EQ(placement(TrackingLost{}, 90, true), alignment_found);
  EXPECT_EQ(placement(TrackingLost{}, 89, true), relocalisation_unconfirmed);
  EXPECT_EQ(placement(TrackingLost{}, 100, false), relocalisation_unconfirmed);
  EXPECT_EQ(placement(Relocalised{}, 90, false),
            alignment_found);  // the effect of a velocity error lasts for some sweeps
  EXPECT_EQ(placement(Relocalised{}, 89, true), relocalisation_unconfirmed);
  EXPECT_EQ(placement(Tracking{}, 50, false), alignment_found);
}

/// Returns the tilt error [rad] of a pose at rest.
double tilt_error_rad(const PoseState& pose, const Eigen::Quaterniond& q_true) {
  const Eigen::Vector3d up = pose.orientation_W * q_true.conjugate() * Eigen::Vector3d::UnitZ();
  return std::acos(std::min(up.z(), 1.0));
}

// rates that are 20 % too small tilt the pose by 0.2 rad, and no surface corrects the tilt
TEST(LidarInertialOdometry, ALongRestLevelsAPoseWithoutSurfaces) {
  const LidarInertialOdometry::Params params = test::rig_params();
  LidarInertialOdometry odometry(params);
  const test::Motion still{.rest_s = 100.0};
  Eigen::Quaterniond q_true = Eigen::Quaterniond::Identity();
  std::vector<LidarInertialOdometry::SweepResult> reports(50);
  for (int k = 0; k < 50; ++k) {
    for (int j = 1; j <= 10; ++j) {
      const double rate_rad_s = k >= 5 && k < 15 ? 1.0 : 0.0;
      q_true = q_true * so3::exp({0.01 * rate_rad_s, 0.0, 0.0});
      ImuSample sample;
      sample.time_ns = k * test::kSweep_ns + j * 10'000'000;
      sample.angular_velocity_rad_s = {0.8 * rate_rad_s, 0.0, 0.0};
      sample.specific_force_m_s2 = q_true.conjugate() * Eigen::Vector3d(0.0, 0.0, test::kRoomGravity_m_s2);
      ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    const bool sees = k < 5;
    const auto points = sees ? test::make_sweep(test::Room::box(), still, params.T_IL, k) : std::vector<LidarPoint>();
    EXPECT_EQ(odometry.add_sweep(k * test::kSweep_ns, (k + 1) * test::kSweep_ns, points, reports[k]).ok(), sees);
  }
  EXPECT_NEAR(tilt_error_rad(reports[20].pose, q_true), 0.2, 0.01) << "control: a short rest does not change the tilt";
  EXPECT_LT(tilt_error_rad(reports[49].pose, q_true), 1e-3);
  EXPECT_LT((reports[49].pose.position_W_m - reports[30].pose.position_W_m).norm(), 0.01);
  EXPECT_GT(reports[30].pose.covariance(3, 3), 0.02 * 0.02);
}

}  // namespace
}  // namespace tumble::mapping
