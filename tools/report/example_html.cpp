// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sections.hpp"

#include <fmt/format.h>

#include "tools/html/html.hpp"

namespace tumble::tools {

namespace {

using html::escaped;

std::string swatch(const std::string& name, Colour colour) {
  return " <span class=\"entry\"><span class=\"swatch\" style=\"background:" + std::string(colour.hex) + "\"></span>" +
         escaped(name) + "</span>";
}

std::string legend_html(const ExamplePicture& picture) {
  std::string out;
  for (const auto& [name, colour] : picture.legend) out += swatch(name, colour_of(colour));
  return out;
}

std::string picture_html(const ExamplePicture& picture) {
  return "<figure><img alt=\"" + escaped(picture.alternative) + "\" src=\"" + html::png_address(picture.png) +
         "\"><figcaption>" + escaped(picture.caption) + legend_html(picture) + "</figcaption></figure>\n";
}

std::string play_html(const ShownExample& shown) {
  if (shown.replay_address.empty()) return "";
  return "<a href=\"" + escaped(shown.replay_address) +
         "\">Open the replay</a>, which shows the robot, its paths, its lidar points and the gyro over time.";
}

std::string plots_html(const Example& example, const Palette& palette, std::vector<Figure>& figures) {
  std::string out;
  bool in_pair = false;
  for (const Plot& plot : example.plots) {
    if (plot.wide == in_pair) out += in_pair ? "</div>\n" : "<div class=\"pair\">";
    in_pair = !plot.wide;
    figures.push_back(figure_of(plot, fmt::format("{}-{}-{}", plot.name, example.scenario, example.seed), palette));
    out += plot_html(figures.back(), plot.wide && plot.equal_scales);
  }
  return out + (in_pair ? "</div>\n" : "");
}

std::string example_html(const ShownExample& shown, const Palette& palette, std::vector<Figure>& figures) {
  const Example& example = shown.example;
  std::string out = fmt::format("<p>{}. The program repeated this simulated run to create the pictures of this page",
                                escaped(example.choice));
  out += shown.of_these_results ? "; the recording has the same digest as in the results.</p>\n"
                                : ". The pictures do not match these results, because another build or an earlier run "
                                  "created the pictures.</p>\n";
  if (!shown.replay_address.empty()) out += "<p>" + play_html(shown) + "</p>\n";
  for (const ExamplePicture& picture : example.pictures) out += picture_html(picture);
  return out + plots_html(example, palette, figures);
}

}  // namespace

std::string example_id(const std::string& scenario, std::uint64_t seed) {
  return fmt::format("draw-{}-{}", scenario, seed);
}

std::string plot_html(const Figure& figure, bool tall) {
  return "<figure><div class=\"plot" + std::string(tall ? " tall" : "") + "\" id=\"" + escaped(figure.id) +
         "\"></div><figcaption>" + escaped(figure.caption) + "</figcaption></figure>\n";
}

std::string moving_html(const ShownExample& shown) {
  const Example& example = shown.example;
  const bool has_picture = !example.pictures.empty();
  const std::string still = has_picture ? html::png_address(example.pictures.front().png) : "";
  std::string out = "<figure class=\"moving\"><picture>";
  if (!example.moving.empty() && has_picture) {
    out += fmt::format("<source media=\"print, (prefers-reduced-motion: reduce)\" srcset=\"{}\">", still);
  }
  out += "<img alt=\"" + escaped(has_picture ? example.pictures.front().alternative : example.motion) + "\" src=\"" +
         (example.moving.empty() ? still : html::webp_address(example.moving)) + "\"></picture><figcaption>" +
         fmt::format("One {} of <code>{}</code>, seed {}", escaped(example.motion), escaped(example.scenario),
                     example.seed);
  if (!example.moving.empty()) out += ", " + escaped(example.moving_caption);
  out += shown.of_these_results ? ". " : ". The picture does not match these results. ";
  if (has_picture) out += legend_html(example.pictures.front());
  if (!shown.replay_address.empty()) out += "<br>" + play_html(shown);
  return out + "</figcaption></figure>\n";
}

std::string failure_html(const ShownExample& shown) {
  const Example& example = shown.example;
  std::string out = fmt::format("<details id=\"{}\"><summary>picture</summary>\n",
                                escaped(example_id(example.scenario, example.seed)));
  if (!shown.of_these_results) out += "<p>The picture does not match these results.</p>\n";
  for (const ExamplePicture& picture : example.pictures) out += picture_html(picture);
  return out + "</details>\n";
}

std::string examples_html(const std::vector<ShownExample>& examples, const Palette& palette,
                          std::vector<Figure>& figures) {
  std::string out;
  for (const ShownExample& shown : examples) {
    const Example& example = shown.example;
    if (example.of_failure) continue;
    out += fmt::format("<details id=\"{}\"{}><summary>One {} of <code>{}</code>, seed {}</summary>\n",
                       escaped(example_id(example.scenario, example.seed)), out.empty() ? " open" : "",
                       escaped(example.motion), escaped(example.scenario), example.seed) +
           example_html(shown, palette, figures) + "</details>\n";
  }
  return out;
}

}  // namespace tumble::tools
