// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "scenarios/provenance/build_id.hpp"
#include "scenarios/summary/comparison.hpp"
#include "scenarios/summary/example_choice.hpp"
#include "scenarios/summary/motion_map.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "tools/html/html.hpp"
#include "tools/report/cost_html.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;
using scenarios::Summary;

std::vector<Fact> versions(const scenarios::Results& results, const Summary& summary, const ReportOptions& options) {
  std::int64_t draws = 0;
  for (const auto& [scenario, count] : summary.draws) draws += count;
  std::vector<Fact> out;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) out.emplace_back(name, value);
  };
  std::string names;
  for (const std::string& scenario : summary.scenarios) names += (names.empty() ? "" : ", ") + scenario;
  add("suite", results.note("suite"));
  add("scenarios", names);
  add("draws", std::to_string(draws));
  add("results of build", results.note("build"));
  add("models and scenarios", results.note("data"));
  for (const auto& [key, value] : results.notes()) {
    if (scenarios::is_method_note(key)) add(key, value);
  }
  add("page by tumble", options.version + ", build " + scenarios::build_id());
  add("made at", options.made_at);
  return out;
}

std::vector<Fact> listed_methods(const Summary& summary) {
  std::vector<Fact> out;
  for (const scenarios::Section& section : summary.sections) {
    for (const scenarios::MethodSummary& method : section.methods) {
      Fact fact(full_name(section.kind, method.method) + (method.method == section.baseline ? " (baseline)" : ""),
                method.what.empty() ? "A file (--method FILE) describes this external method." : method.what);
      if (std::ranges::find(out, fact) == out.end()) out.push_back(std::move(fact));
    }
  }
  std::ranges::stable_sort(out, {}, &Fact::first);
  return out;
}

/// Returns true if a sweep by this build, with the data on this machine, would continue these results.
bool are_of_here(const scenarios::Results& results, const ReportOptions& options) {
  const std::string made_by = results.note("build"), made_of = results.note("data");
  return (made_by.empty() || made_by == scenarios::build_id()) &&
         (made_of.empty() || options.data.empty() || made_of == options.data);
}

std::vector<Fact> commands(const scenarios::Results& results, const ReportOptions& options,
                           const PageContent& content) {
  const std::string database = scenarios::shell_word(options.database.string());
  std::vector<Fact> out;
  if (are_of_here(results, options)) {
    const char* what = "This command computes the results";
    for (const std::string& sweep : scenarios::commands_of(results.note(scenarios::kCommandNote))) {
      out.emplace_back(what, "tumble sweep " + sweep + " --db " + database);
      what = "This command adds results to the database";
    }
  }
  if (!options.page.empty())
    out.emplace_back("This command writes this report page",
                     "tumble report " + database + " -o " + scenarios::shell_word(options.page.string()));
  if (!content.comparison.failures.empty())
    out.emplace_back("This command prints the paired differences as tables; add --metric NAME for other metrics",
                     "tumble compare " + database);
  if (!content.sensitivity.empty())
    out.emplace_back("This command prints the influence of every random parameter on each method",
                     "tumble sensitivity " + database + " --all");
  return out;
}

std::vector<Figure> errors_of_all_draws(const Summary& summary, const Palette& palette) {
  std::vector<Figure> figures;
  for (const Kind kind : scenarios::kKinds) {
    for (const std::string& name : scenarios::headline_metrics(kind)) {
      const scenarios::MetricInfo& info = scenarios::metric_info(name);
      if (info.unit != scenarios::Unit::verdict)
        figures.push_back(box_figure(summary, kind, name, fmt::format("{}: {}.", name, info.doc), palette));
    }
  }
  std::erase_if(figures, [](const Figure& figure) { return figure.empty(); });
  return figures;
}

/// Sweeps omit lidars that no method needs, so the digest may be that of the recording without lidars.
bool is_of(const scenarios::Results& results, const Example& example) {
  if (example.made_of != scenarios::digest_of_rows(results, {example.scenario, example.seed})) return false;
  const std::vector<scenarios::Outcome> rows = results.outcomes_of(example.scenario, example.seed);
  return std::any_of(rows.begin(), rows.end(), [&](const scenarios::Outcome& row) {
    return row.setting.is_plain() && !row.recording_digest.empty() &&
           (row.recording_digest == example.recording_digest || row.recording_digest == example.digest_without_lidars);
  });
}

std::string how_to_get_pictures(const scenarios::Results& results, const ReportOptions& options) {
  const std::string none =
      fmt::format("There are no pictures of single simulated runs in {}", examples_folder(options.database).string());
  const std::string made_by = results.note("build"), made_of = results.note("data");
  if (made_by == scenarios::kMixedBuilds)
    return fmt::format(
        "{}. Pictures can only be created if one build computed all results, but these results come from several "
        "builds.",
        none);
  if (!made_by.empty() && made_by != scenarios::build_id())
    return fmt::format(
        "{}. Pictures can only be created by the build that computed these results ({}); this build is {}.", none,
        made_by, scenarios::build_id());
  if (!made_of.empty() && !options.data.empty() && made_of != options.data)
    return fmt::format(
        "{}. Only a sweep with the models and scenarios of these results (digest {}) can create pictures. The models "
        "and scenarios on this machine have digest {}.",
        none, made_of, options.data);
  const std::vector<std::string> commands = scenarios::commands_of(results.note(scenarios::kCommandNote));
  const std::string suite = results.note("suite");
  return fmt::format(
      "{}. This command creates pictures and repeats no stored run: tumble sweep {} --db {} --examples 3", none,
      !commands.empty() ? commands.front()
      : suite.empty()   ? "SUITE"
                        : suite,
      scenarios::shell_word(options.database.string()));
}

std::string replay_address(const ReportOptions& options, const Example& example) {
  if (example.replay.empty()) return "";
  const std::filesystem::path replay = examples_folder(options.database) / example.replay;
  std::error_code error;
  const std::filesystem::path from = std::filesystem::absolute(options.page, error).parent_path();
  const std::filesystem::path relative = std::filesystem::proximate(replay, from, error);
  return html::file_address((error ? replay : relative).generic_string());
}

void add_examples(const scenarios::Results& results, const ReportOptions& options, PageContent& content) {
  FoundExamples found = read_examples(examples_folder(options.database), Pictures::read);
  for (Example& example : found.examples) {
    const bool of_these = is_of(results, example);
    std::string replay = replay_address(options, example);
    content.examples.push_back({std::move(example), of_these, std::move(replay)});
  }
  for (const std::string& what : found.unreadable)
    content.warnings.push_back(fmt::format("The page cannot show some pictures of single simulated runs: {}", what));
  if (!found.unreadable.empty()) return;
  if (content.examples.empty()) content.warnings.push_back(how_to_get_pictures(results, options));
}

Palette palette_of(const PageContent& content) {
  Palette palette;
  for (const ShownExample& shown : content.examples) {
    if (shown.example.of_failure || shown.example.pictures.empty()) continue;
    for (const auto& [name, colour] : shown.example.pictures.front().legend)
      if (colour != kTruthColour) palette.add(name, static_cast<std::size_t>(colour));
  }
  for (const scenarios::Section& section : content.summary.sections)
    for (const scenarios::MethodSummary& method : section.methods) palette.add(method.method);
  for (const Curve& curve : content.curves)
    for (const CurveLine& line : curve.lines) palette.add(line.method);
  return palette;
}

}  // namespace

PageContent report_content(ReportInput input, const ReportOptions& options) {
  const scenarios::Results& results = *input.results;
  const Summary& summary = *input.summary;
  PageContent content;
  const std::string suite = results.note("suite");
  content.recorded = results.note("source") == scenarios::kRecordingsSource;
  content.title = suite.empty() ? "tumble: report" : "tumble: suite " + suite;
  content.summary = summary;
  content.comparison = scenarios::compare(summary, {});
  content.motion_map = scenarios::motion_map(input.draws);
  content.motions = std::move(input.motions);
  content.curves = std::move(input.curves);
  if (!content.recorded && !summary.sections.empty()) add_examples(results, options, content);
  content.palette = palette_of(content);
  content.errors = errors_of_all_draws(summary, content.palette);
  content.cost = cost_figure(summary, content.palette);
  content.costs = cost_rows(summary, input.draws);
  content.failed = failed_draws(results, summary, options.database);
  content.rejected = results.rejected();
  content.sensitivity = std::move(input.sensitivity);
  content.sensitivity_note = std::move(input.sensitivity_note);
  content.methods = listed_methods(summary);
  content.versions = versions(results, summary, options);
  content.commands = commands(results, options, content);
  content.certificates = results.certificates();
  if (content.certificates.empty() && !content.recorded)
    content.warnings.push_back(
        "These results contain no certificate, so the agreement of the simulation with physics is unknown.");
  for (const scenarios::Certificate& certificate : content.certificates) {
    content.versions.emplace_back("certificate", certificate_summary(certificate));
    if (!certificate.passes()) content.warnings.push_back("The certificate of build " + certificate.build + " fails.");
  }
  return content;
}

}  // namespace tumble::tools
