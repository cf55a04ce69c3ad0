// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep_notes.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

namespace tumble::scenarios {

std::vector<std::string> commands_of(const std::string& note) {
  std::vector<std::string> out;
  std::istringstream lines(note);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) out.push_back(line);
  }
  return out;
}

std::string with_commands(const std::string& note, const std::string& more) {
  std::vector<std::string> known = commands_of(note);
  std::string out = note;
  for (std::string& line : commands_of(more)) {
    if (std::find(known.begin(), known.end(), line) != known.end()) continue;
    out += (out.empty() ? "" : "\n") + line;
    known.push_back(std::move(line));
  }
  return out;
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "_-./:=,+@%";
  const auto plain = [&](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || kPlain.find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace tumble::scenarios
