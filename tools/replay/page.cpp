// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/page.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "replay/embedded.hpp"
#include "tools/html/html.hpp"

namespace tumble::tools {

namespace {

std::string filled(std::string_view page, const std::array<std::pair<std::string_view, std::string>, 5>& texts) {
  std::string out;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = page.find("{{", at);
    const std::size_t close = open == std::string_view::npos ? open : page.find("}}", open);
    if (close == std::string_view::npos) return out += page.substr(at);
    out += page.substr(at, open - at);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    for (const auto& [key, text] : texts) {
      if (key == name) out += text;
    }
    at = close + 2;
  }
  return out;
}

}  // namespace

std::string replay_page(const Replay& replay) {
  const PackedReplay data = packed(replay);
  return filled(kReplayHtml, {{{"title", html::escaped(replay.title)},
                               {"style", kReplayCss},
                               {"head", html::script_json(data.head)},
                               {"bytes", html::base64(data.bytes)},
                               {"script", kReplayJs}}});
}

}  // namespace tumble::tools
