// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.hpp"

#include <fmt/format.h>

#include <map>

#include "report/embedded.hpp"
#include "tools/html/html.hpp"
#include "tools/report/certificate_html.hpp"
#include "tools/report/score_html.hpp"

namespace tumble::tools {

namespace {

using html::escaped;
using scenarios::Section;
using scenarios::Summary;

std::string header_html(const PageContent& content) {
  std::string out = "<header><h1>" + escaped(content.title) +
                    "</h1>\n<p class=\"lead\">Robots that tumble and roll, simulated with exact "
                    "truth; estimates made from their sensors alone.</p>\n<ul class=\"meta\">";
  for (const auto& [name, value] : content.facts) out += "<li>" + escaped(name) + " <b>" + escaped(value) + "</b></li>";
  return out + "</ul></header>\n";
}

std::string cards_html(const Summary& summary) {
  std::string out = "<div class=\"cards\">\n";
  for (const Headline& headline : headlines(summary)) {
    out += "<div class=\"card\"><div class=\"place\">" + escaped(headline.place) + "</div><div class=\"value" +
           (headline.worse ? " worse" : "") + "\">" + escaped(headline.value) + "</div><div class=\"detail\">" +
           escaped(headline.detail) + "</div></div>\n";
  }
  return out + "</div>\n";
}

std::string swatch(const std::string& name, Colour colour) {
  return "<span class=\"swatch\" style=\"background:" + std::string(colour.hex) + "\"></span>" + escaped(name);
}

std::string plot_html(const Figure& figure, bool tall = false) {
  return "<figure><div class=\"plot" + std::string(tall ? " tall" : "") + "\" id=\"" + escaped(figure.id) +
         "\"></div><figcaption>" + escaped(figure.caption) + "</figcaption></figure>\n";
}

std::string picture_html(const std::vector<std::uint8_t>& png, const std::string& alternative,
                         const std::string& caption_html) {
  return "<figure><img alt=\"" + escaped(alternative) + "\" src=\"" + html::png_address(png) + "\"><figcaption>" +
         caption_html + "</figcaption></figure>\n";
}

std::string legend_html(const ExamplePicture& picture) {
  std::string out;
  for (const auto& [name, colour] : picture.legend) out += swatch(name, colour_of(colour));
  return out;
}

/// Wide plots in a row of their own, the others two in a row.
std::string plots_html(const Example& example, std::vector<Figure>& figures) {
  std::string out;
  bool in_pair = false;
  for (const Plot& plot : example.plots) {
    if (plot.wide == in_pair) out += in_pair ? "</div>\n" : "<div class=\"pair\">";
    in_pair = !plot.wide;
    figures.push_back(figure_of(plot, plot.name + "-" + example.scenario));
    out += plot_html(figures.back(), plot.wide && plot.equal_scales);
  }
  return out + (in_pair ? "</div>\n" : "");
}

std::string example_html(const ShownExample& shown, std::vector<Figure>& figures) {
  const Example& example = shown.example;
  std::string out = fmt::format("<h2>One {} of <code>{}</code>, seed {}</h2>\n", escaped(example.motion),
                                escaped(example.scenario), example.seed);
  out += "<p>" + escaped(example.choice) + ", run again by the sweep for this page";
  out += shown.of_these_results
             ? "; its recording has the same digest as in the results.</p>\n"
             : ". It was made of other results than these: another build's, or run again since.</p>\n";
  if (!shown.replay_address.empty()) {
    out += "<p><a href=\"" + escaped(shown.replay_address) +
           "\">Play it</a>: the robot, its paths, the points of its lidar and the gyro over time.</p>\n";
  }
  for (const ExamplePicture& picture : example.pictures)
    out += picture_html(picture.png, picture.alternative, escaped(picture.caption) + legend_html(picture));
  return out + plots_html(example, figures);
}

std::string draws_html(const Summary& summary) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>scenario</th><th class=\"number\">draws scored</th>"
      "<th class=\"number\">draws rejected by the simulation</th></tr></thead><tbody>";
  for (const std::string& scenario : summary.scenarios) {
    const auto rejected = summary.rejected.find(scenario);
    out += "<tr>" + html::cell(scenario) + html::cell(std::to_string(summary.draws.at(scenario)), "number") +
           html::cell(std::to_string(rejected == summary.rejected.end() ? 0 : rejected->second), "number") + "</tr>";
  }
  return out + "</tbody></table></div>\n";
}

/// Why draws were rejected: the instant at the end of a reason is left out, so that equal reasons count together.
std::string rejected_html(const std::vector<scenarios::RejectedDraw>& rejected) {
  std::map<std::pair<std::string, std::string>, std::vector<std::uint64_t>> reasons;
  for (const scenarios::RejectedDraw& draw : rejected) {
    const std::size_t instant = draw.message.rfind(" at ");
    reasons[{draw.scenario, draw.message.substr(0, instant)}].push_back(draw.seed);
  }
  std::string out;
  for (const auto& [key, seeds] : reasons) {
    out += fmt::format("<li>{}: {} of <code>{}</code>, the first at seed {}</li>", escaped(key.second), seeds.size(),
                       escaped(key.first), seeds.front());
  }
  return out.empty() ? "" : "<p>Rejected, and why:</p><ul>" + out + "</ul>\n";
}

std::string scores_html(const Summary& summary) {
  std::string out =
      "<h2>Scores</h2>\n<p>Median over the draws (of a verdict the share) and, in brackets, its 95 % "
      "interval from order statistics; an estimate that did not end <i>ok</i> ranks as "
      "the worst of all (–: half or more of them), and is counted in the first row with its Clopper–Pearson interval. "
      "“Better in” counts the "
      "draws on which a method beat the baseline on the very same recording. The best method that needs no truth is "
      "marked. Hover over a metric for its definition.</p>\n";
  std::string scenario;
  for (const Section& section : summary.sections) {
    scenario = section.scenario;
    out += "<h3>" + escaped(section.scenario) + " · " + escaped(to_string(section.kind)) + "</h3>\n" +
           score_table_html(section) + "\n";
  }
  return out;
}

std::string figures_json(const std::vector<Figure>& figures) {
  nlohmann::json all = nlohmann::json::array();
  for (const Figure& figure : figures)
    all.push_back({{"id", figure.id}, {"data", figure.data}, {"layout", figure.layout}});
  return html::script_json(all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

std::string page_html(const PageContent& content, const std::string& plotly_bundle) {
  std::vector<Figure> figures = content.figures;
  std::string body = header_html(content) + "<main>\n";
  for (const std::string& warning : content.warnings) body += "<p class=\"warning\">" + escaped(warning) + "</p>\n";
  body += cards_html(content.summary);
  for (const ShownExample& example : content.examples) body += example_html(example, figures);
  body += "<h2>All draws</h2>\n<p>Each point is one draw, each box the quartiles of one method.</p>\n";
  for (const Figure& figure : content.figures) body += plot_html(figure);
  body += scores_html(content.summary);
  body += curves_html(content.curves, figures);
  body += "<h2>Draws</h2>\n" + draws_html(content.summary) + rejected_html(content.rejected);
  const std::vector<Figure> motions = distribution_figures(content.motions);
  body += distributions_html(content.motions, motions);
  figures.insert(figures.end(), motions.begin(), motions.end());
  body += certificates_html(content.certificates);
  body +=
      "<footer>Angles are in degrees on this page alone; the database holds SI units and radians. Plots by Plotly.js "
      "(MIT licence), "
      "carried inside this page.</footer>\n</main>\n";
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
         escaped(content.title) + "</title>\n<style>\n" + kPageCss + "</style></head>\n<body>\n" + body +
         "<script type=\"application/json\" id=\"figures\">" + figures_json(figures) +
         "</script>\n<script id=\"plotly\">" + plotly_bundle + "</script>\n<script>\n" + kPageJs +
         "</script>\n</body></html>\n";
}

}  // namespace tumble::tools
