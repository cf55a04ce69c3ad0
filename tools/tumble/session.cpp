// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/session.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"

namespace tumble::tools {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> candidate_roots() {
  std::vector<fs::path> roots;
  if (const char* given = std::getenv("TUMBLE_DATA"); given != nullptr && *given != '\0') roots.emplace_back(given);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) roots.push_back(program.parent_path().parent_path() / "share" / "tumble");
  roots.emplace_back(TUMBLE_SOURCE_TREE);
  return roots;
}

std::string written(const Table& table, TableFormat format) {
  switch (format) {
    case TableFormat::markdown:
      return table.markdown();
    case TableFormat::csv:
      return table.csv();
    case TableFormat::tex:
      return table.tex();
    case TableFormat::text:
      break;
  }
  return table.text();
}

}  // namespace

scenarios::DataRoot Session::data() const {
  std::error_code error;
  const char* given = std::getenv("TUMBLE_DATA");
  for (const fs::path& root : candidate_roots()) {
    const scenarios::DataRoot data{root};
    if (fs::is_directory(data.models(), error)) return data;
    if (given != nullptr && *given != '\0')
      throw scenarios::BadInput(fmt::format(
          "TUMBLE_DATA must name the folder that contains models/ and scenarios/, but this folder does not exist: {}",
          data.models().string()));
  }
  throw scenarios::BadInput(
      "the program cannot find its models; set TUMBLE_DATA to the folder that contains models/ and scenarios/");
}

fs::path Session::plotly() const {
  std::error_code error;
  for (const fs::path& root : candidate_roots()) {
    const fs::path bundle = root / "plotly.min.js";
    if (fs::is_regular_file(bundle, error)) return bundle;
  }
  throw scenarios::BadInput(
      "the report needs plotly.min.js, but the program cannot find this file; run tools/setup, then configure and "
      "build again");
}

fs::path Session::program() const {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) throw scenarios::BadInput("/proc/self/exe: " + error.message());
  return program;
}

fs::path Session::cache() const {
  const auto given = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value != nullptr ? value : "");
  };
  if (const fs::path own = given("TUMBLE_CACHE"); !own.empty()) return own;
  if (const fs::path common = given("XDG_CACHE_HOME"); !common.empty()) return common / "tumble";
  const fs::path home = given("HOME");
  return home.empty() ? fs::path() : home / ".cache" / "tumble";
}

void Session::note(std::string_view line) const {
  if (quiet) return;
  std::fprintf(stderr, "%s\n", terminal_text(line).c_str());
}

void Session::print(const std::vector<Table>& tables, const nlohmann::json& document) const {
  std::string text;
  if (json) {
    text = document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  } else {
    for (const Table& table : tables) {
      if (!text.empty()) text += "\n";
      text += written(table, format);
    }
    text = terminal_text(text);
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written) throw scenarios::BadInput(std::string("standard output: ") + std::strerror(errno));
}

std::string program_version() {
  return TUMBLE_VERSION;
}

namespace {

std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  return length;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return (first < 0x20 && first != '\n') || first == 0x7f;
  return first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;  // C1
}

}  // namespace

std::string terminal_text(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0 || is_control(text.substr(0, length)))
      out += '?';
    else
      out.append(text.substr(0, length));
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

}  // namespace tumble::tools
