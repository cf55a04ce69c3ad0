// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/run_again.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::string_view kDescription = "description ";
constexpr std::string_view kRecording = "recording ";

std::string note_or(const std::map<std::string, std::string>& notes, const std::string& key,
                    const std::string& otherwise) {
  const auto found = notes.find(key);
  return found == notes.end() || found->second.empty() ? otherwise : found->second;
}

std::string method_word(const RunKey& run, const std::map<std::string, std::string>& notes) {
  const std::string full = run.kind + "/" + run.method;
  const bool own = !notes.contains("method " + full);
  return own ? full : note_or(notes, description_note(run.kind, run.method), run.method + ".yaml");
}

}  // namespace

RunKey key_of(const Outcome& outcome) {
  return {outcome.scenario, outcome.seed, to_string(outcome.kind), outcome.method, outcome.setting};
}

std::string description_note(const std::string& kind, const std::string& method) {
  return std::string(kDescription) + kind + "/" + method;
}

std::string recording_note(const std::string& name) {
  return std::string(kRecording) + name;
}

bool is_place_note(const std::string& key) {
  return key.starts_with(kDescription) || key.starts_with(kRecording);
}

std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes) {
  const std::string method = run.method.empty() ? "" : " --method " + shell_word(method_word(run, notes));
  if (note_or(notes, "source", "") == kRecordingsSource) {
    const std::string file = note_or(notes, recording_note(run.scenario), "FOLDER/" + run.scenario + ".h5");
    return "tumble estimate " + shell_word(file) + method + " -o " + shell_word(run.scenario);
  }
  std::string words = "tumble run " + shell_word(run.scenario) + " --seed " + std::to_string(run.seed) + method;
  if (!run.setting.is_plain()) words += " --vary " + shell_word(to_text(run.setting));
  return words;
}

Setting setting_from(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  Setting setting;
  if (equals != std::string::npos) setting.key = text.substr(0, equals);
  std::erase(setting.key, ' ');
  const bool read =
      equals != std::string::npos && read_number(std::string_view(text).substr(equals + 1), setting.value);
  if (setting.key.empty() || !read || !std::isfinite(setting.value))
    throw BadInput(
        fmt::format("'{}' must have the form KEY=NUMBER, for example world.rock_count=10; keys that vary together are "
                    "joined with '+'",
                    text));
  return setting;
}

std::string to_text(const Setting& setting) {
  return setting.key + "=" + exact_text(setting.value);
}

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
