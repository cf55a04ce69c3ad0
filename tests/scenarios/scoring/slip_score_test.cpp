// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/perfect_estimate.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using sim::ContactLabel;
using testing::scores;

constexpr std::int64_t kPoses_ns = 5'000'000;

struct TrueSlip {
  double begin_s, end_s, speed_m_s;
  ContactLabel label = ContactLabel::slip;
};

/// Returns a recording of a sphere that rolls without slip for ten seconds except for the given periods.
sim::Recording slipping(const std::vector<TrueSlip>& spells) {
  sim::Recording recording;
  recording.sensors.robot = "sphere";
  recording.sensors.sphere_radius_m = 0.145;
  sim::Truth& truth = recording.truth;
  for (std::int64_t k = 0; k <= 20000; ++k) {
    const double time_s = 1e-9 * static_cast<double>(k * truth.period_ns);
    sim::ContactTruth contact;
    contact.time_ns = k * truth.period_ns;
    contact.point_W_m.setZero();
    contact.normal_W = Eigen::Vector3d::UnitZ();
    contact.slip_velocity_W_m_s.setZero();
    contact.normal_force_n = 40.0;
    ContactLabel label = ContactLabel::grip;
    for (const TrueSlip& spell : spells) {
      if (time_s < spell.begin_s || time_s >= spell.end_s) continue;
      label = spell.label;
      contact.slip_velocity_W_m_s.x() = spell.speed_m_s;
    }
    truth.p_WB_m.push_back({0.1 * time_s, 0, 0.145});
    truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    truth.v_WB_m_s.push_back({0.1, 0, 0});
    truth.w_WB_B_rad_s.push_back({0, 0.1 / 0.145, 0});
    truth.f_B_m_s2.push_back({0, 0, 9.80665});
    truth.label.push_back(label);
    truth.contacts.push_back(contact);
  }
  return recording;
}

const std::vector<TrueSlip> kTwo = {{2.0, 3.0, 0.5}, {5.0, 5.4, 0.3, ContactLabel::slide}};

Estimate claims(const sim::Recording& recording, const std::function<ContactLabel(double)>& label_at) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  const TruthTrack track(recording.truth, Frame::centre);
  for (std::int64_t time_ns = 0; time_ns <= track.last_ns(); time_ns += kPoses_ns) {
    estimate.poses.push_back(track.pose(time_ns));
    estimate.contacts.push_back(label_at(1e-9 * static_cast<double>(time_ns)));
  }
  return estimate;
}

/// Returns an estimate that reports slip within the given periods.
Estimate claims_within(const sim::Recording& recording, const std::vector<std::pair<double, double>>& spans) {
  return claims(recording, [&](double time_s) {
    for (const auto& [begin_s, end_s] : spans) {
      if (time_s >= begin_s - 1e-9 && time_s < end_s - 1e-9) return ContactLabel::slip;
    }
    return ContactLabel::grip;
  });
}

TEST(SlipScores, TheTruthIsPerfectWhicheverOfTheTwoLabelsItSays) {
  const sim::Recording recording = slipping(kTwo);
  const auto values = scores(Kind::position, claims_within(recording, {{2.0, 3.0}, {5.0, 5.4}}), recording);
  EXPECT_EQ(values.at("slip_precision"), 1.0);
  EXPECT_EQ(values.at("slip_recall"), 1.0);
}

TEST(SlipScores, NothingClaimedFindsNothing) {
  const sim::Recording recording = slipping(kTwo);
  const auto values = scores(Kind::position, claims_within(recording, {}), recording);
  EXPECT_EQ(values.at("slip_precision"), 1.0);
  EXPECT_EQ(values.at("slip_recall"), 0.0);
}

// 1.4 s of ten are slip: an estimate that always reports slip is wrong, and detects nothing
TEST(SlipScores, AlwaysClaimedIsWrong) {
  const sim::Recording recording = slipping(kTwo);
  const auto values = scores(Kind::position, claims_within(recording, {{0.0, 20.0}}), recording);
  EXPECT_EQ(values.at("slip_precision"), 0.0);
  EXPECT_EQ(values.at("slip_recall"), 0.0);
}

TEST(SlipScores, AFalseEventAndALostOneCount) {
  const sim::Recording recording = slipping(kTwo);
  const auto values =
      scores(Kind::position, claims_within(recording, {{2.0, 3.0}, {5.3, 5.4}, {7.0, 7.2}, {8.0, 8.2}}), recording);
  EXPECT_EQ(values.at("slip_precision"), 0.5);
  EXPECT_EQ(values.at("slip_recall"), 0.5);  // a quarter of the second event is less than half of it
}

TEST(SlipScores, WeakAndShortEventsAreNobodysLossAndNobodysFault) {
  const sim::Recording recording = slipping({{2.0, 3.0, 0.5}, {4.0, 5.0, 0.03}, {6.0, 6.04, 0.5}});
  const auto without = scores(Kind::position, claims_within(recording, {{2.0, 3.0}}), recording);
  EXPECT_EQ(without.at("slip_recall"), 1.0);
  const auto with = scores(Kind::position, claims_within(recording, {{2.0, 3.0}, {4.0, 5.0}, {6.0, 6.04}}), recording);
  EXPECT_EQ(with.at("slip_precision"), 1.0);
  EXPECT_EQ(with.at("slip_recall"), 1.0);
}

TEST(SlipScores, AMomentOfGripDoesNotMakeTwoEvents) {
  const sim::Recording recording = slipping({{2.0, 2.5, 0.5}, {2.54, 3.0, 0.5}});
  const auto values =
      scores(Kind::position, claims_within(recording, {{2.0, 2.4}, {2.45, 2.6}, {8.0, 8.2}}), recording);
  EXPECT_EQ(values.at("slip_precision"), 0.5);
  EXPECT_EQ(values.at("slip_recall"), 1.0);
}

TEST(SlipScores, HopsBelongToTheEvent) {
  const auto both = [](ContactLabel between) {
    return slipping({{2.0, 2.5, 0.5}, {2.5, 2.6, 0.0, between}, {2.6, 3.0, 0.5}});
  };
  // the reported period covers half of both together, and less than half of either part
  const std::vector<std::pair<double, double>> claim = {{2.26, 2.79}};
  EXPECT_EQ(
      scores(Kind::position, claims_within(both(ContactLabel::air), claim), both(ContactLabel::air)).at("slip_recall"),
      1.0);
  EXPECT_EQ(scores(Kind::position, claims_within(both(ContactLabel::grip), claim), both(ContactLabel::grip))
                .at("slip_recall"),
            0.0);
}

TEST(SlipScores, OnACleanRollAFalseAlarmShows) {
  const sim::Recording recording = slipping({});
  const auto quiet = scores(Kind::position, claims_within(recording, {}), recording);
  EXPECT_EQ(quiet.at("slip_precision"), 1.0);
  EXPECT_FALSE(quiet.contains("slip_recall"));
  EXPECT_EQ(scores(Kind::position, claims_within(recording, {{2.0, 3.0}}), recording).at("slip_precision"), 0.0);
}

TEST(SlipScores, ABumpIsNoClaim) {
  const sim::Recording recording = slipping({});
  const Estimate estimate = claims(recording, [](double) { return ContactLabel::air; });
  EXPECT_EQ(scores(Kind::position, estimate, recording).at("slip_precision"), 1.0);
}

/// Returns an estimate of kTwo with an error of `lost_m` over the first event; its sigma is 1 mm, and 5 cm from
/// `sigma_from_s`.
Estimate astray(const sim::Recording& recording, double lost_m, double sigma_from_s) {
  Estimate estimate = claims_within(recording, {{2.0, 3.0}, {5.0, 5.4}});
  for (PoseState& pose : estimate.poses) {
    const double time_s = 1e-9 * static_cast<double>(pose.time_ns);
    pose.position_W_m.y() += lost_m * std::clamp(time_s - 2.0, 0.0, 1.0);
    const double sigma_m = time_s < sigma_from_s ? 1e-3 : 0.05;
    pose.covariance.topLeftCorner<3, 3>() = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  }
  return estimate;
}

TEST(SlipScores, AnEventThatLosesTheWayIsToBeFlagged) {
  const sim::Recording recording = slipping(kTwo);
  const auto right = scores(Kind::position, astray(recording, 0.2, 2.5), recording);
  EXPECT_EQ(right.at("slip_flag_recall"), 1.0);
  EXPECT_EQ(right.at("slip_flagged_share"), 0.5);
  // the estimate flags the other event, and not the one with the error
  const auto wrong = scores(Kind::position, astray(recording, 0.2, 5.1), recording);
  EXPECT_EQ(wrong.at("slip_flag_recall"), 0.0);
  EXPECT_EQ(wrong.at("slip_flagged_share"), 0.5);
  const auto kept = scores(Kind::position, astray(recording, 0.05, 9.0), recording);
  EXPECT_FALSE(kept.contains("slip_flag_recall")) << "nothing was lost";
  EXPECT_EQ(kept.at("slip_flagged_share"), 0.0);
}

TEST(SlipScores, FlagsAreLeftOutOfAnEstimateWithoutCovariance) {
  const sim::Recording recording = slipping(kTwo);
  const auto values = scores(Kind::position, claims_within(recording, {{2.0, 3.0}}), recording);
  EXPECT_EQ(values.at("slip_recall"), 0.5);
  EXPECT_FALSE(values.contains("slip_flag_recall"));
  EXPECT_FALSE(values.contains("slip_flagged_share"));
}

TEST(SlipScores, AreLeftOutOfAnEstimateThatSaysNothingAndRefuseOneThatIsTooShort) {
  const sim::Recording recording = slipping(kTwo);
  Estimate estimate = claims_within(recording, {});
  estimate.contacts.pop_back();
  EXPECT_THROW(scores(Kind::position, estimate, recording), BadInput);
  estimate.contacts.clear();
  EXPECT_FALSE(scores(Kind::position, estimate, recording).contains("slip_precision"));
}

}  // namespace
}  // namespace tumble::scenarios
