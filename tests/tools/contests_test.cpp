// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/contests.hpp"

#include "tests/testing.hpp"
#include "tools/report/badge.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::MethodSummary;
using scenarios::Section;
using scenarios::Summary;

constexpr const char* kRateError = "rate_error_clipped_median_rad_s";
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Returns a method with values by rising seed; an infinite value means that the run failed.
MethodSummary method(const std::string& name, const std::vector<double>& values, const char* metric = kRateError) {
  MethodSummary out;
  out.method = name;
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.seeds.push_back(i + 1);
    if (std::isinf(values[i])) {
      out.not_ok_seeds.push_back(i + 1);
      out.metrics[metric].failed.push_back(i + 1);
    } else {
      out.metrics[metric].seeds.push_back(i + 1);
      out.metrics[metric].values.push_back(values[i]);
    }
  }
  return out;
}

Summary summary_of(std::vector<MethodSummary> methods, Kind kind = Kind::rate, const char* metric = kRateError) {
  Section section;
  section.scenario = "hill";
  section.kind = kind;
  section.baseline = methods.front().method;
  section.methods = std::move(methods);
  section.metrics = {metric};
  Summary summary;
  summary.sections = {section};
  return summary;
}

std::vector<ContestResult> contests_of(const Summary& summary) {
  return contests(summary, scenarios::compare(summary, {}));
}

const std::vector<double> kTwo(9, 2.0), kHalf(9, 0.5);

TEST(Contests, NameTheBestAndByHowMuch) {
  const std::vector<ContestResult> all = contests_of(
      summary_of({method("raw", kTwo), method("saave", kHalf), method("tumble", std::vector<double>(9, 0.2))}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].row.contest.method, "tumble");
  EXPECT_NEAR(all[0].percent, -90.0, 1e-9) << "0.2 beside 2";
  EXPECT_NEAR(all[0].percent_low, -90.0, 1e-9);
  EXPECT_NEAR(all[0].percent_high, -90.0, 1e-9) << "all pairs differ alike";
  // nine equal signs have a chance of 2/512, and twice that for two comparisons
  EXPECT_EQ(all[0].certainty, Certainty::corrected);
  EXPECT_TRUE(all[0].won());
  EXPECT_NEAR(all[0].times, 10.0, 1e-9);
  EXPECT_EQ(tally_text(tally(all)), "tumble is better than the baseline in the one contest");
  EXPECT_THAT(certainty_text(all[0], 2), HasSubstr("significantly better, after correction for 2"));
}

TEST(Contests, AreLostWhereTheBaselineIsBetter) {
  const std::vector<ContestResult> all = contests_of(summary_of({method("raw", kHalf), method("saave", kTwo)}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].lost());
  EXPECT_NEAR(all[0].percent, 300.0, 1e-9);
  EXPECT_EQ(tally_text(tally(all)), "The baseline is better in all of 1 contest");
}

TEST(Contests, AreOpenWhereChanceExplainsThem) {
  const std::vector<ContestResult> all =
      contests_of(summary_of({method("raw", {1, 2, 1, 2, 1, 2, 1, 2}), method("saave", {2, 1, 2, 1.1, 2, 1, 2.1, 1})}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].certainty, Certainty::open);
  EXPECT_FALSE(all[0].won() || all[0].lost());
  EXPECT_THAT(tally_text(tally(all)), HasSubstr("No method is significantly better"));
  EXPECT_THAT(certainty_text(all[0], 1), HasSubstr("not significant"));
}

TEST(Contests, OfFewDrawsSayThatTheIntervalAloneSpeaks) {
  // six equal pairs have a chance of 2/64, which times two comparisons is more than 5 %
  const std::vector<double> two(6, 2.0), half(6, 0.5), third(6, 0.3);
  const std::vector<ContestResult> all =
      contests_of(summary_of({method("raw", two), method("saave", half), method("tumble", third)}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].certainty, Certainty::interval);
  EXPECT_FALSE(all[0].won() || all[0].lost()) << "the better of two, by an interval of its own";
  EXPECT_EQ(tally(all).open, 1u);
  EXPECT_EQ(tally_text(tally(all)),
            "tumble is ahead of the baseline in 1 of 1 contest, but there are too few simulated runs for certainty");
  EXPECT_THAT(certainty_text(all[0], 2), HasSubstr("not significant after correction"));
}

// there are too few draws for an interval: the page states what all of them show, and that they are few
TEST(Contests, OfThreeDrawsThatAllSayTheSameIsAheadAndUnsure) {
  const std::vector<ContestResult> all =
      contests_of(summary_of({method("raw", {2, 3, 4}), method("saave", {1, 1, 1})}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].certainty, Certainty::open);
  EXPECT_EQ(tally_text(tally(all)),
            "saave is ahead of the baseline in 1 of 1 contest, but there are too few simulated runs for certainty");
  const std::vector<ContestResult> worse =
      contests_of(summary_of({method("raw", {1, 1, 1}), method("saave", {2, 3, 4})}));
  EXPECT_THAT(tally_text(tally(worse)), HasSubstr("No method is significantly better"));
  const std::vector<ContestResult> mixed =
      contests_of(summary_of({method("raw", {2, 3, 4}), method("saave", {1, 1, 5})}));
  EXPECT_THAT(tally_text(tally(mixed)), HasSubstr("No method is significantly better"));
}

TEST(Contests, NameTheOneThatIsAheadAndNotOneOfSeveral) {
  const auto ahead = [](const std::string& name) {
    return contests_of(summary_of({method("raw", {2, 3, 4}), method(name, {1, 1, 1})})).front();
  };
  EXPECT_EQ(tally_text(tally({ahead("tumble"), ahead("tumble")})),
            "tumble is ahead of the baseline in 2 of 2 contests, but there are too few simulated runs for certainty");
  EXPECT_EQ(tally_text(tally({ahead("tumble"), ahead("saave"), ahead("tumble")})),
            "The best methods are ahead of the baseline in 3 of 3 contests, but there are too few simulated runs for "
            "certainty");
}

TEST(Contests, SayNoShareWhereHalfOfTheBaselineFailed) {
  std::vector<double> failing(9, kInfinite);
  failing[0] = 1.0;
  const std::vector<ContestResult> all = contests_of(summary_of({method("raw", failing), method("saave", kHalf)}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(std::isnan(all[0].percent));
  EXPECT_TRUE(all[0].won()) << "it ran where the other failed";
}

// three of nine runs of the baseline failed: the improvement has no upper bound, but a lower one
TEST(Contests, HaveAShareWhereAnIntervalIsInfiniteOnOneSide) {
  std::vector<double> failing(9, 2.0);
  for (std::size_t i : {0u, 4u, 8u}) failing[i] = kInfinite;
  const std::vector<ContestResult> all = contests_of(summary_of({method("raw", failing), method("saave", kHalf)}));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].percent, -75.0, 1e-9);
  EXPECT_EQ(all[0].percent_low, -kInfinite);
  EXPECT_NEAR(all[0].percent_high, -75.0, 1e-9);
}

TEST(Contests, KnowThatMoreOverlapIsBetter) {
  const char* overlap = "map_overlap";
  const std::vector<double> low(9, 0.4), high(9, 0.8);
  const Summary better =
      summary_of({method("icp_raw", low, overlap), method("icp", high, overlap)}, Kind::slam, overlap);
  const std::vector<ContestResult> all = contests(better, scenarios::compare(better, {{}, "", {overlap}, {}}));
  ASSERT_EQ(all.size(), 1u);
  for (const ContestResult& result : all) EXPECT_TRUE(result.won()) << result.row.metric;
}

TEST(Contests, AreNoneWithoutARival) {
  EXPECT_TRUE(contests_of(summary_of({method("raw", kTwo)})).empty());
  EXPECT_THAT(tally_text({}), HasSubstr("no method that can be compared"));
}

PageContent content_of(std::vector<MethodSummary> methods) {
  PageContent content;
  content.title = "tumble: suite <b>&";
  content.summary = summary_of(std::move(methods));
  content.comparison = scenarios::compare(content.summary, {});
  return content;
}

TEST(BadgeOfAReport, SaysHowManyContestsAreWon) {
  const Badge won = badge_of(content_of({method("raw", kTwo), method("saave", kHalf)}));
  EXPECT_EQ(won.message, "better than the baseline in 1 of 1");
  EXPECT_EQ(won.colour, Badge::Colour::good);
  const Badge lost = badge_of(content_of({method("raw", kHalf), method("saave", kTwo)}));
  EXPECT_THAT(lost.message, HasSubstr("1 worse"));
  EXPECT_EQ(lost.colour, Badge::Colour::bad);
  EXPECT_EQ(badge_of(content_of({method("raw", kTwo)})).colour, Badge::Colour::open);
}

TEST(BadgeOfAReport, IsBadWhereTheCertificateFails) {
  PageContent content = content_of({method("raw", kTwo), method("saave", kHalf)});
  scenarios::Certificate certificate;
  scenarios::CertificateEntry entry;
  entry.value = 2.0;
  entry.low = 0.0;
  entry.high = 1.0;
  certificate.entries = {entry};
  content.certificates = {certificate};
  EXPECT_EQ(badge_of(content).message, "certificate failed");
  EXPECT_EQ(badge_of(content).colour, Badge::Colour::bad);
}

TEST(BadgeOfAReport, EscapesItsTexts) {
  const std::string svg = badge_svg(badge_of(content_of({method("raw", kTwo)})));
  EXPECT_THAT(svg, HasSubstr("&lt;b&gt;&amp;"));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  EXPECT_THAT(svg, HasSubstr("role=\"img\""));
}

}  // namespace
}  // namespace tumble::tools
