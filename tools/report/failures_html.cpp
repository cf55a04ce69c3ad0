// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/html/html.hpp"
#include "tools/report/score_html.hpp"

namespace tumble::tools {

namespace {

using html::escaped;

constexpr std::size_t kOpenDraws = 8;

const ShownExample* example_of(const PageContent& content, const FailedDraw& draw) {
  const auto shown = std::find_if(content.examples.begin(), content.examples.end(), [&](const ShownExample& each) {
    return each.example.scenario == draw.scenario && each.example.seed == draw.seed;
  });
  return shown == content.examples.end() ? nullptr : &*shown;
}

std::string links_html(const ShownExample* shown) {
  if (shown == nullptr) return "";
  std::string out;
  if (!shown->example.of_failure)
    out += " · <a href=\"#" + escaped(html::file_address(example_id(shown->example.scenario, shown->example.seed))) +
           "\">pictures</a>";
  if (!shown->replay_address.empty()) out += " · <a href=\"" + escaped(shown->replay_address) + "\">replay</a>";
  return out;
}

std::string draw_html(const PageContent& content, const FailedDraw& draw) {
  const ShownExample* shown = example_of(content, draw);
  std::string out = fmt::format("<li><b>{}</b>, seed {}{}", escaped(draw.scenario), draw.seed, links_html(shown));
  if (shown != nullptr && shown->example.of_failure) out += failure_html(*shown);
  out += "<ul class=\"runs\">";
  for (const FailedRun& run : draw.runs) {
    out += "<li><code>" + escaped(run.method) + "</code> " + escaped(run.status) +
           (run.message.empty() ? "" : ": " + escaped(run.message)) + "<pre>" + escaped(run.command) + "</pre></li>";
  }
  if (!draw.replay_command.empty() && (shown == nullptr || shown->replay_address.empty()))
    out += "<li>The sweep kept the data of this simulated run. The following command writes its replay:<pre>" +
           escaped(draw.replay_command) + "</pre></li>";
  return out + "</ul></li>\n";
}

std::string draws_html(const PageContent& content) {
  const FailedDraws& failed = content.failed;
  if (failed.draws == 0) return "<p>No run failed.</p>\n";
  std::string open, folded;
  for (std::size_t i = 0; i < failed.shown.size(); ++i)
    (i < kOpenDraws ? open : folded) += draw_html(content, failed.shown[i]);
  std::string out = fmt::format(
      "<h3>Simulated runs with failures</h3>\n<p>On {} simulated run{}, at least one method run has a status other "
      "than <i>ok</i>. {}Simulated runs with the most failed methods come first. The command below a run repeats the "
      "run. With <code>-o FOLDER</code>, <code>tumble run</code> writes recording, estimates, pictures and a "
      "replay.</p>\n",
      failed.draws, failed.draws == 1 ? "" : "s",
      failed.shown.size() < failed.draws
          ? fmt::format("The page shows {} of the simulated runs on which methods failed. ", failed.shown.size())
          : "");
  out += "<ul class=\"failed\">" + open + "</ul>\n";
  if (!folded.empty())
    out += fmt::format("<details><summary>{} more</summary><ul class=\"failed\">{}</ul></details>\n",
                       failed.shown.size() - kOpenDraws, folded);
  return out;
}

}  // namespace

std::string failures_html(const PageContent& content) {
  return paired_failures_html(content.comparison.failures) + draws_html(content);
}

}  // namespace tumble::tools
