// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/failure_goal.hpp"

#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kWorstScore = std::numeric_limits<double>::infinity();

std::string complaint(const std::string& text) {
  return test::complaint([&] { parse_goal(text, Kind::slam); });
}

TEST(FailureGoal, IsReadAndWritten) {
  const FailureGoal error = parse_goal("translation_error_end_m > 0.5", Kind::slam);
  EXPECT_EQ(error, (FailureGoal{"translation_error_end_m", 0.5}));
  EXPECT_EQ(parse_goal("translation_error_end_m>0.5", Kind::slam), error);
  EXPECT_EQ(error.text(), "translation_error_end_m > 0.5");
  EXPECT_EQ(parse_goal("map_overlap < 0.8", Kind::slam).text(), "map_overlap < 0.8");
}

TEST(FailureGoal, IsAStatusAMapOrAMetricBeyondItsLimit) {
  Outcome outcome;
  outcome.status = OutcomeStatus::ok;
  outcome.scores = {{"map_failed", 0.0}, {"map_overlap", 0.7}, {"translation_error_end_m", 2.0}};
  EXPECT_FALSE(FailureGoal{}.holds(outcome));
  EXPECT_TRUE((FailureGoal{"translation_error_end_m", 1.0}.holds(outcome)));
  EXPECT_FALSE((FailureGoal{"translation_error_end_m", 3.0}.holds(outcome)));
  EXPECT_TRUE((FailureGoal{"map_overlap", 0.8}.holds(outcome))) << "of an overlap more is better";
  EXPECT_FALSE((FailureGoal{"map_overlap", 0.6}.holds(outcome)));
  EXPECT_TRUE((FailureGoal{"ate_m", 1.0}.holds(outcome))) << "a run without the number has not shown it";
  outcome.scores[0].value = 1.0;
  EXPECT_TRUE(FailureGoal{}.holds(outcome));
  outcome.scores.clear();
  outcome.status = OutcomeStatus::diverged;
  EXPECT_TRUE(FailureGoal{}.holds(outcome));
}

TEST(FailureGoal, ScoresRiseWithBadness) {
  const FailureGoal error{"translation_error_end_m", 0.5}, overlap{"map_overlap", 0.8};
  EXPECT_GT(error.score(OutcomeStatus::ok, 0.6), error.bound());
  EXPECT_LE(error.score(OutcomeStatus::ok, 0.5), error.bound()) << "a failure exceeds the limit";
  EXPECT_GT(overlap.score(OutcomeStatus::ok, 0.7), overlap.bound());
  EXPECT_LT(overlap.score(OutcomeStatus::ok, 0.9), overlap.bound());
  EXPECT_EQ(overlap.value_at(overlap.score(OutcomeStatus::ok, 0.7)), 0.7);
  for (const FailureGoal& goal : {error, overlap}) {
    EXPECT_GT(goal.score(OutcomeStatus::diverged, 0.0), goal.bound());
    EXPECT_GT(goal.score(OutcomeStatus::crashed, std::nan("")), goal.bound());
    EXPECT_EQ(goal.score(OutcomeStatus::rejected, std::nan("")), -kWorstScore);
    EXPECT_EQ(goal.score(OutcomeStatus::ok, std::nan("")), -kWorstScore);
  }
}

TEST(FailureGoal, AReportedRunIsNotSilentlyWrong) {
  const FailureGoal silent = parse_goal("health_unreported_error > 1", Kind::slam);
  Outcome outcome;
  outcome.scores = {{"health_unreported_error", 0.0}};
  outcome.status = OutcomeStatus::diverged;
  EXPECT_FALSE(silent.holds(outcome));
  EXPECT_LT(silent.score(OutcomeStatus::diverged, 0.0), silent.bound());
  outcome.status = OutcomeStatus::ok;
  outcome.scores[0].value = 1.1;
  EXPECT_TRUE(silent.holds(outcome));
  EXPECT_GT(silent.score(OutcomeStatus::ok, 1.1), silent.bound());
  EXPECT_GT(silent.score(OutcomeStatus::crashed, std::nan("")), silent.bound());
}

TEST(FailureGoal, AnInfiniteLimitMeansLostRuns) {
  const FailureGoal lost = parse_goal("translation_error_end_m > inf", Kind::slam);
  EXPECT_TRUE(std::isfinite(lost.bound()));
  EXPECT_GT(lost.score(OutcomeStatus::diverged, 1.0), lost.bound());
  EXPECT_LT(lost.score(OutcomeStatus::ok, 1e300), lost.bound());
}

TEST(FailureGoal, ComplaintsNameWhatIsAllowed) {
  EXPECT_THAT(complaint("translation_error_end_m 0.5"), HasSubstr("write 'METRIC > VALUE'"));
  EXPECT_THAT(complaint("translation_error_end_m > half"), HasSubstr("write 'METRIC > VALUE'"));
  EXPECT_THAT(complaint("translation_error_end_m > nan"), HasSubstr("write 'METRIC > VALUE'"));
  EXPECT_THAT(complaint("translation_error_end > 1"), HasSubstr("did you mean 'translation_error_end_m'"));
  EXPECT_THAT(complaint("translation_error_end_m < 1"), HasSubstr("higher values of this metric are worse"));
  EXPECT_THAT(complaint("map_overlap > 1"), HasSubstr("lower values of this metric are worse"));
  EXPECT_EQ(complaint("ate_m > 1"), "") << "or everything is refused";
}

}  // namespace
}  // namespace tumble::scenarios
