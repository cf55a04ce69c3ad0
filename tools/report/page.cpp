// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "report/embedded.hpp"
#include "tools/html/html.hpp"
#include "tools/report/cost_html.hpp"
#include "tools/report/score_html.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/sensitivity_html.hpp"

namespace tumble::tools {

namespace {

using html::escaped;
using scenarios::Section;
using scenarios::Summary;

struct Part {
  const char* id;
  const char* title;
  std::string html;
};

std::string draws_html(const Summary& summary) {
  std::string out = html::table_head({"scenario", "simulated runs scored", "runs rejected by the simulation"}, 1);
  for (const std::string& scenario : summary.scenarios) {
    const auto rejected = summary.rejected.find(scenario);
    out += "<tr>" + html::cell(scenario) + html::cell(std::to_string(summary.draws.at(scenario)), "number") +
           html::cell(std::to_string(rejected == summary.rejected.end() ? 0 : rejected->second), "number") + "</tr>";
  }
  return out + "</tbody></table></div>\n";
}

std::string rejected_html(const std::vector<scenarios::RejectedDraw>& rejected) {
  std::map<std::pair<std::string, std::string>, std::vector<std::uint64_t>> reasons;
  for (const scenarios::RejectedDraw& draw : rejected) {
    const std::size_t instant = draw.message.rfind(" at ");
    reasons[{draw.scenario, draw.message.substr(0, instant)}].push_back(draw.seed);
  }
  std::string out;
  for (const auto& [key, seeds] : reasons) {
    out += fmt::format("<li>{}: {} of <code>{}</code>, first seed {}</li>", escaped(key.second), seeds.size(),
                       escaped(key.first), seeds.front());
  }
  return out.empty() ? "" : "<p>The simulation rejected runs for these reasons:</p><ul>" + out + "</ul>\n";
}

std::string motions_html(const PageContent& content, std::vector<Figure>& figures) {
  std::string out;
  Figure map = motion_figure(content.motion_map);
  if (!map.empty()) {
    out += plot_html(map, true);
    figures.push_back(std::move(map));
  }
  out += examples_html(content.examples, content.palette, figures);
  const std::vector<Figure> spreads = distribution_figures(content.motions);
  out += distributions_html(content.motions, spreads);
  figures.insert(figures.end(), spreads.begin(), spreads.end());
  if (!content.summary.scenarios.empty())
    out += "<details><summary>Simulated runs</summary>\n" + draws_html(content.summary) +
           rejected_html(content.rejected) + "</details>\n";
  return out;
}

std::string scores_html(const Summary& summary) {
  if (summary.sections.empty()) return "";
  std::string out =
      "<h3>Scores</h3>\n<p>Each cell contains the median over the simulated runs (for verdicts the share). Brackets "
      "contain the 95 % interval from order statistics. A failed estimate ranks as the worst of all; “–” means that at "
      "least half of the estimates failed. The first row shows the share of failed estimates with its Clopper–Pearson "
      "interval. “Better in” is the number of simulated runs on which a method was better than the baseline on the "
      "same recording. The best method that needs no truth is highlighted. Hover over a metric for its "
      "definition.</p>\n";
  for (const Section& section : summary.sections) {
    out += "<details><summary>" + escaped(section.scenario) + " · " + escaped(to_string(section.kind)) +
           "</summary>\n" + score_table_html(section) + "</details>\n";
  }
  return out;
}

std::string errors_html(const PageContent& content, std::vector<Figure>& figures) {
  std::string out;
  if (!content.errors.empty())
    out += "<p>Each point shows one simulated run. Each box shows the quartiles of one method.</p>\n";
  for (const Figure& figure : content.errors) out += plot_html(figure);
  figures.insert(figures.end(), content.errors.begin(), content.errors.end());
  return out + scores_html(content.summary) + curves_html(content.curves, figures, content.palette);
}

std::string cost_html(const PageContent& content, std::vector<Figure>& figures) {
  if (content.cost.empty()) return "";
  figures.push_back(content.cost);
  return plot_html(content.cost) + costs_html(content.costs);
}

std::string facts_html(const std::vector<Fact>& facts) {
  if (facts.empty()) return "";
  std::string out = "<dl class=\"facts\">";
  for (const auto& [name, value] : facts) out += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>";
  return out + "</dl>\n";
}

std::string commands_html(const std::vector<Fact>& commands) {
  std::string out;
  for (const auto& [what, command] : commands)
    out += "<p>" + escaped(what) + "</p><pre>" + escaped(command) + "</pre>\n";
  return out;
}

std::vector<Part> parts_of(const PageContent& content, std::vector<Figure>& figures) {
  std::vector<Part> parts;
  const auto add = [&](const char* id, const char* title, std::string html) {
    if (!html.empty()) parts.push_back({id, title, std::move(html)});
  };
  const bool scored = !content.summary.sections.empty();
  add("motions", "Motions", motions_html(content, figures));
  add("errors", "Errors", errors_html(content, figures));
  if (scored) add("differences", "Paired differences", differences_html(content.comparison.metrics));
  if (scored) add("failures", "Failures", failures_html(content));
  add("sensitivity", "Causes of failures", sensitivity_html(content.sensitivity, content.sensitivity_note));
  add("cost", "Cost", cost_html(content, figures));
  add("certificate", "Certificate", certificates_html(content.certificates));
  add("versions", "Versions", facts_html(content.versions));
  add("again", "How to reproduce", commands_html(content.commands));
  return parts;
}

std::string contents_html(const std::vector<Part>& parts) {
  std::string out = "<nav aria-label=\"Contents\">";
  for (const Part& part : parts) out += fmt::format("<a href=\"#{}\">{}</a>", part.id, part.title);
  return out + "</nav>\n";
}

std::string figures_json(const std::vector<Figure>& figures) {
  std::string all;
  for (const Figure& figure : figures) {
    const std::string id = nlohmann::json(figure.id).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    all += fmt::format("{}{{\"data\":{},\"id\":{},\"layout\":{}}}", all.empty() ? "" : ",", figure.traces, id,
                       figure.layout);
  }
  return html::script_json("[" + all + "]");
}

/// The policy allows only content that is embedded in the page: scripts, styles, and pictures as data.
constexpr const char* kPolicy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; style-src "
    "'unsafe-inline'; script-src 'unsafe-inline'\">";

}  // namespace

std::string page_html(const PageContent& content, const std::string& plotly_bundle) {
  std::vector<Figure> figures;
  const std::vector<Part> parts = parts_of(content, figures);
  std::string body = "<main>\n" + front_html(content) + contents_html(parts);
  for (const std::string& warning : content.warnings) body += "<p class=\"warning\">" + escaped(warning) + "</p>\n";
  for (const Part& part : parts)
    body += fmt::format("<section id=\"{}\"><h2>{}</h2>\n", part.id, part.title) + part.html + "</section>\n";
  body +=
      "<footer>Angles are in degrees on this page only; the database contains SI units and radians. Plotly.js (MIT "
      "licence) is embedded in this page.</footer>\n</main>\n";
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">" + std::string(kPolicy) +
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" + escaped(content.title) +
         "</title>\n<style>\n" + kPageCss + "</style></head>\n<body>\n" + body +
         "<script type=\"application/json\" id=\"figures\">" + figures_json(figures) +
         "</script>\n<script id=\"plotly\">" + plotly_bundle + "</script>\n<script>\n" + kPageJs +
         "</script>\n</body></html>\n";
}

}  // namespace tumble::tools
