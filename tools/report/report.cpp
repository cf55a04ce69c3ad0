// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scenarios/sweep/sweep.hpp"
#include "tools/report/certificate_html.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;

std::vector<std::pair<std::string, std::string>> facts(const scenarios::Results& results, const Summary& summary,
                                                       const ReportOptions& options) {
  std::int64_t draws = 0;
  for (const auto& [scenario, count] : summary.draws) draws += count;
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) out.emplace_back(name, value);
  };
  std::string names;
  for (const std::string& scenario : summary.scenarios) names += (names.empty() ? "" : ", ") + scenario;
  add("suite", results.note("suite"));
  add("scenarios", names);
  add("draws", std::to_string(draws));
  add("made at", options.made_at);
  add("tumble", options.version);
  add("build", results.note("build"));
  return out;
}

std::vector<Figure> figures_of_all_draws(const Summary& summary) {
  std::vector<Figure> figures = {
      box_figure(
          summary, Kind::rate, "rate_error_clipped_median_rad_s",
          "Error of the angular velocity at samples where at least one gyro axis is clipped, median of each draw."),
      box_figure(summary, Kind::slam, "translation_error_end_m",
                 "Error of the last registered pose against the sixth, as the published evaluation takes it."),
      box_figure(summary, Kind::slam, "map_overlap", "Share of map points within 0.25 m of the true surface."),
      box_figure(summary, Kind::position, "position_end_error_share",
                 "Position error at the end as a share of the path."),
      cost_figure(summary)};
  std::erase_if(figures, [](const Figure& figure) { return figure.empty(); });
  return figures;
}

/// Scenarios to show single draws of: the first of each kind of motion first. A rig's results have kind slam or rates
/// that clip, a sphere's have kind position.
std::vector<std::string> scenarios_to_show(const Summary& summary, int count) {
  std::vector<std::string> tumbles, rolls, out;
  for (const std::string& scenario : summary.scenarios) {
    const bool rolls_here = std::any_of(summary.sections.begin(), summary.sections.end(), [&](const Section& section) {
      return section.scenario == scenario && section.kind == Kind::position;
    });
    (rolls_here ? rolls : tumbles).push_back(scenario);
  }
  // the plain cases are the ones to begin with
  const auto first = [](std::vector<std::string>& names, const char* name) {
    std::stable_partition(names.begin(), names.end(), [&](const std::string& each) { return each == name; });
  };
  first(tumbles, "hill");
  first(rolls, "slip");
  first(rolls, "roll");
  if (!tumbles.empty()) out.push_back(tumbles.front());
  for (std::size_t i = 0; i < rolls.size() && i < 2; ++i) out.push_back(rolls[i]);
  if (static_cast<int>(out.size()) > count) out.resize(static_cast<std::size_t>(count));
  return out;
}

void add_sphere_rolls(const Summary& summary, const ReportOptions& options, PageContent& content) {
  for (const std::string& scenario : sphere_scenarios(summary)) {
    std::uint64_t seed = 0;
    if (!typical_seed(summary, scenario, seed)) continue;
    if (options.note) options.note(fmt::format("simulating {}, seed {}, again for its plots", scenario, seed));
    try {
      content.rolls.push_back(make_sphere_roll(options.data, summary, scenario, seed));
    } catch (const std::exception& error) {
      content.warnings.push_back(fmt::format("No plots of {}, seed {}: {}", scenario, seed, error.what()));
    }
  }
}

}  // namespace

PageContent report_content(const scenarios::Results& results, const Summary& summary, const ReportOptions& options) {
  PageContent content;
  const std::string suite = results.note("suite");
  content.title = suite.empty() ? "tumble: report" : "tumble: suite " + suite;
  content.facts = facts(results, summary, options);
  content.summary = summary;
  content.figures = figures_of_all_draws(summary);
  content.motions = motion_spreads(results.draws());
  content.curves = find_curves(results);
  content.rejected = results.rejected();
  content.certificates = results.certificates();
  const bool recorded = results.note("source") == scenarios::kRecordingsSource;
  if (content.certificates.empty() && !recorded)
    content.warnings.push_back("These results hold no certificate of their build.");
  for (const scenarios::Certificate& certificate : content.certificates) {
    content.facts.emplace_back("certificate", certificate_summary(certificate));
    if (!certificate.passes()) content.warnings.push_back("The certificate of build " + certificate.build + " fails.");
  }
  if (recorded) return content;  // nothing to simulate again
  for (const std::string& scenario : scenarios_to_show(summary, options.examples_max)) {
    std::uint64_t seed = 0;
    if (!typical_seed(summary, scenario, seed)) continue;
    if (options.note) options.note(fmt::format("simulating {}, seed {}, again for its pictures", scenario, seed));
    try {
      content.examples.push_back(make_example(options.data, results, summary, scenario, seed, options.threads));
    } catch (const std::exception& error) {
      // a scenario that this build no longer has must not cost the reader the scores
      content.warnings.push_back(fmt::format("No pictures of {}, seed {}: {}", scenario, seed, error.what()));
    }
  }
  if (options.examples_max > 0) add_sphere_rolls(summary, options, content);
  return content;
}

}  // namespace tumble::tools
