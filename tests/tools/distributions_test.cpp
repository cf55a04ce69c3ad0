// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/distributions.hpp"

#include <nlohmann/json.hpp>

#include "tests/testing.hpp"
#include "tools/report/cost_html.hpp"

namespace tumble::tools {
namespace {

using scenarios::motion_spreads;

std::vector<scenarios::DrawValues> draws() {
  std::vector<scenarios::DrawValues> out;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto number = static_cast<double>(seed);
    out.push_back({"hill",
                   seed,
                   {{"motion_peak_rate_rad_s", 10.0 + number},
                    {"motion_clips", seed > 1 ? 1.0 : 0.0},
                    {"motion_clipped_samples", 10.0 * (number - 1.0)},
                    {"motion_several_axes_share", seed > 1 ? 0.1 * number : std::nan("")}}});
  }
  out.push_back({"roll", 1, {{"motion_peak_rate_rad_s", 4.0}, {"motion_clips", 0.0}}});
  return out;
}

const Spread* find(const std::vector<Spread>& spreads, const std::string& metric, const std::string& scenario) {
  for (const Spread& spread : spreads) {
    if (spread.metric == metric && spread.scenario == scenario) return &spread;
  }
  return nullptr;
}

TEST(MotionSpreads, HoldQuantilesPerScenarioAndLeaveOutWhatHasNoValue) {
  const std::vector<Spread> spreads = motion_spreads(draws());
  const Spread* rate = find(spreads, "motion_peak_rate_rad_s", "hill");
  ASSERT_NE(rate, nullptr);
  EXPECT_EQ(rate->values.size(), 5u);
  EXPECT_DOUBLE_EQ(rate->median, 13.0);
  EXPECT_DOUBLE_EQ(rate->quantile_05, 11.2);
  EXPECT_EQ(find(spreads, "motion_several_axes_share", "hill")->values.size(), 4u);
  EXPECT_EQ(find(spreads, "motion_several_axes_share", "roll"), nullptr);
  EXPECT_DOUBLE_EQ(find(spreads, "motion_clips", "hill")->median, 0.8) << "the share of the draws";
  EXPECT_TRUE(motion_spreads({}).empty());
}

TEST(MotionSpreads, PoolsTheClippedSamplesOfAllDraws) {
  const std::vector<Spread> spreads = motion_spreads(draws());
  const auto pooled = std::find_if(spreads.begin(), spreads.end(), [](const Spread& spread) {
    return spread.scenario == "hill" &&
           spread.quantity == "share of the clipped samples with at least two clipped axes, over all simulated runs";
  });
  ASSERT_NE(pooled, spreads.end());
  // there are 10, 20, 30 and 40 samples with shares of 0.2, 0.3, 0.4 and 0.5
  EXPECT_NEAR(pooled->median, 0.4, 1e-12);
  // the residuals are -2, -2, 0 and 4: 1.96 sqrt(24 x 4 / 3) / 100
  EXPECT_NEAR(pooled->quantile_95, 0.4 + 1.96 * std::sqrt(32.0) / 100.0, 1e-12);
  EXPECT_NEAR(pooled->quantile_05, 0.4 - 1.96 * std::sqrt(32.0) / 100.0, 1e-12);
}

TEST(DistributionFigures, AreHistogramsBesideThePublishedRange) {
  const std::vector<Figure> figures = distribution_figures(motion_spreads(draws()));
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(nlohmann::json::parse(figures[0].traces).size(), 2u) << "hill and roll";
  EXPECT_EQ(nlohmann::json::parse(figures[0].traces)[0]["type"], "histogram");
  EXPECT_EQ(nlohmann::json::parse(figures[0].traces)[0]["x"], nlohmann::json({11.0, 12.0, 13.0, 14.0, 15.0}));
  EXPECT_EQ(nlohmann::json::parse(figures[0].layout)["shapes"][0]["x1"], 25.0);
  EXPECT_EQ(nlohmann::json::parse(figures[1].traces)[0]["x"], nlohmann::json({20.0, 30.0, 40.0, 50.0}))
      << "shares in per cent";
}

TEST(DistributionFigures, SayWhereTheyAreThinned) {
  std::vector<scenarios::DrawValues> many;
  for (std::uint64_t seed = 1; seed <= kBoxPoints; ++seed)
    many.push_back({"hill", seed, {{"motion_peak_rate_rad_s", 10.0}}});
  EXPECT_THAT(distribution_figures(motion_spreads(many)).at(0).caption, Not(HasSubstr("The plot shows at most")));
  many.push_back({"hill", kBoxPoints + 1, {{"motion_peak_rate_rad_s", 10.0}}});
  EXPECT_THAT(distribution_figures(motion_spreads(many)).at(0).caption,
              HasSubstr("The plot shows at most 1000 simulated runs per scenario"));
}

TEST(DistributionsHtml, ShowsThePublishedFiguresAndIsEmptyWithoutDraws) {
  const std::vector<Spread> spreads = motion_spreads(draws());
  const std::string html = distributions_html(spreads, distribution_figures(spreads));
  EXPECT_THAT(html, HasSubstr("up to 18.6"));
  EXPECT_THAT(html, HasSubstr("id=\"distribution-motion_peak_rate_rad_s\""));
  EXPECT_EQ(distributions_html({}, {}), "");
}

TEST(CertificatesHtml, ShowsValueBoundAndVerdictAndEscapes) {
  scenarios::Certificate certificate{"build <1>",
                                     {{"free_flight_energy", "rig", "law", "1", 1e-3, 0.0, 1e-8, ""},
                                      {"digest_restart", "slip", "law", "1", 0.0, 0.0, 0.0, ""}}};
  const std::string html = certificates_html({&certificate, 1});
  EXPECT_THAT(html, HasSubstr("fail"));
  EXPECT_THAT(html, HasSubstr("&lt;= 1e-08"));
  EXPECT_THAT(html, Not(HasSubstr("build <1>")));
  EXPECT_EQ(certificate_summary(certificate), "1 of 2 values are within their bounds");
  EXPECT_EQ(certificate_summary({}), "none");
  EXPECT_THAT(certificates_html({}), HasSubstr("no certificate"));
}

}  // namespace
}  // namespace tumble::tools
