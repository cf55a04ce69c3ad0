// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/question.hpp"

#include "tests/scenarios/summary/rate_error.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

Question sound_question() {
  Question question;
  question.method = "rate/tumble";
  question.against = "rate/raw";
  question.metric = kError;
  question.scenarios = {"hill"};
  return question;
}

class QuestionTest : public test::TemporaryFolder {
 protected:
  using Value = std::function<std::optional<double>(std::uint64_t)>;

  /// Adds the seeds first to last of a scenario; a missing value means that the run failed.
  void add(const std::string& scenario, std::uint64_t first, std::uint64_t last, const Value& tumble,
           const Value& raw) {
    Results results(path(), Results::Mode::create_or_append);
    results.in_one_transaction([&] {
      for (std::uint64_t seed = first; seed <= last; ++seed) {
        for (const auto& [name, value] : {std::pair("tumble", &tumble), std::pair("raw", &raw)}) {
          Outcome row{scenario, seed, Kind::rate, name, OutcomeStatus::failed, "", {}, "", ""};
          if (const std::optional<double> own = (*value)(seed)) {
            row.status = OutcomeStatus::ok;
            row.scores = {{kError, *own}};
          }
          results.store(row);
        }
      }
    });
  }

  std::vector<Answer> ask(const Question& question, std::uint64_t last_seed) const {
    return answers(Results(path(), Results::Mode::read_only), question, last_seed);
  }

  fs::path path() const { return folder_ / "a.db"; }
};

// eight better runs without a worse one: 9 / 2^8 < 0.05
TEST_F(QuestionTest, StopsAtTheRunThatAnswers) {
  add(
      "hill", 1, 100, [](auto) { return 1.0; }, [](auto) { return 2.0; });
  EXPECT_EQ(ask(sound_question(), 7).front().finding, Finding::undecided);
  const std::vector<Answer> at_end = ask(sound_question(), 100);
  EXPECT_EQ(at_end.front().finding, Finding::better);
  EXPECT_EQ(at_end.front().seeds, 8u);
  EXPECT_EQ(at_end.front().better, 8) << "later pairs change nothing";
  EXPECT_GT(at_end.front().better_share.low, 0.5);
  EXPECT_TRUE(all_answered(at_end));
}

TEST_F(QuestionTest, TheOtherWayRoundIsWorse) {
  add(
      "hill", 1, 100, [](auto) { return 1.0; }, [](auto) { return 2.0; });
  Question question = sound_question();
  std::swap(question.method, question.against);
  EXPECT_EQ(ask(question, 100).front().finding, Finding::worse);
}

// a method that is better by 0.1 on every draw is not better by 10 % of 2, nor by 0.15, but by 0.05
TEST_F(QuestionTest, AMarginAsksForMore) {
  add(
      "hill", 1, 60, [](auto) { return 1.9; }, [](auto) { return 2.0; });
  Question question = sound_question();
  question.margin = {0.1, true};
  EXPECT_EQ(ask(question, 60).front().finding, Finding::worse);
  question.margin = {0.15, false};
  EXPECT_EQ(ask(question, 60).front().finding, Finding::worse);
  EXPECT_STREQ(finding_text(ask(question, 60).front(), question), "not better by more than the margin")
      << "it is better on every draw";
  question.margin = {0.05, false};
  EXPECT_EQ(ask(question, 60).front().finding, Finding::better);
}

// a failed run is the worst value, with a margin too; where both methods fail neither is better
TEST_F(QuestionTest, FailuresRankAsTheWorst) {
  const auto odd = [](std::uint64_t seed) { return seed % 2 == 1; };
  add(
      "hill", 1, 80, [&](auto seed) { return odd(seed) ? std::optional<double>() : std::optional<double>(5.0); },
      [](auto) { return std::optional<double>(); });
  Question question = sound_question();
  question.margin = {0.1, true};
  const Answer answer = ask(question, 80).front();
  EXPECT_EQ(answer.finding, Finding::better);
  EXPECT_EQ(answer.worse, 0);
  EXPECT_EQ(answer.better, static_cast<std::int64_t>(answer.seeds) / 2);
}

// each of two scenarios has half of the risk; the question stays open while one of them is undecided
TEST_F(QuestionTest, EveryScenarioIsAsked) {
  add(
      "hill", 1, 100, [](auto) { return 1.0; }, [](auto) { return 2.0; });
  add(
      "cliff", 1, 100, [](auto seed) { return seed % 2 == 0 ? 1.0 : 3.0; }, [](auto) { return 2.0; });
  Question question = sound_question();
  question.scenarios = {"hill", "cliff"};
  const std::vector<Answer> both = ask(question, 100);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].finding, Finding::better);
  EXPECT_EQ(both[1].finding, Finding::undecided);
  EXPECT_EQ(both[1].seeds, 100u);
  EXPECT_FALSE(all_answered(both));
  EXPECT_GE(both[0].seeds, ask(sound_question(), 100).front().seeds);
}

TEST_F(QuestionTest, IsClaimedBeforeTheDraws) {
  {
    Results results(path(), Results::Mode::create_or_append);
    claim(results, sound_question(), path());
  }
  add(
      "hill", 1, 1, [](auto) { return 1.0; }, [](auto) { return 2.0; });
  Results results(path(), Results::Mode::create_or_append);
  EXPECT_NO_THROW(claim(results, sound_question(), path())) << "resumed";
  const auto refused = [&](const Question& question, const std::string& what) {
    try {
      claim(results, question, path());
      ADD_FAILURE() << what;
    } catch (const BadInput& error) {
      EXPECT_THAT(error.what(), HasSubstr(what));
    }
  };
  Question other = sound_question();
  other.risk = 0.01;
  refused(other, "with the --until question");
  results.set_note(kQuestionNote, "");
  refused(sound_question(), "of a sweep without --until");
}

TEST_F(QuestionTest, OfNothingIsOpen) {
  { const Results made(path(), Results::Mode::create_or_append); }
  const Answer answer = ask(sound_question(), 100).front();
  EXPECT_EQ(answer.finding, Finding::undecided);
  EXPECT_EQ(answer.better + answer.worse, 0);
}

TEST(Question, RefusesWhatCannotBeAsked) {
  const auto refused = [](const std::function<void(Question&)>& spoil, const std::string& what) {
    Question question = sound_question();
    spoil(question);
    try {
      require_sound(question);
      ADD_FAILURE() << what;
    } catch (const BadInput& error) {
      EXPECT_THAT(error.what(), HasSubstr(what));
    }
  };
  EXPECT_NO_THROW(require_sound(sound_question()));
  refused([](Question& q) { q.method = "tumble"; }, "must be written with its kind");
  refused([](Question& q) { q.against = "slam/icp"; }, "have different kinds");
  refused([](Question& q) { q.against = q.method; }, "is compared with itself");
  refused([](Question& q) { q.metric = "rate_error"; }, "is unknown");
  refused([](Question& q) { q.metric = "estimate_cpu_s"; }, "cannot rank methods");
  refused([](Question& q) { q.metric = "translation_error_end_m"; }, "is of kind");
  refused([](Question& q) { q.margin.value = -0.1; }, "margin of the question (--until) is -0.1");
  refused([](Question& q) { q.margin.value = std::numeric_limits<double>::quiet_NaN(); },
          "margin of the question (--until) is nan");
  refused([](Question& q) { q.risk = 1.0; }, "risk of a wrong answer to the question (--until) is 1");
}

}  // namespace
}  // namespace tumble::scenarios
