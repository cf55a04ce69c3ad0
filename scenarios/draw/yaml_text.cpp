// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/yaml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <system_error>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

std::string yaml_number(double value, const std::string& place) {
  if (std::isnan(value))
    throw BadInput(fmt::format("{}: the value is NaN, which a scenario file cannot contain", place));
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  return exact_text(value);
}

std::string yaml_word(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (!text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
      std::all_of(text.begin(), text.end(), plain)) {
    return text;
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += std::string("\\") + c;
    } else if (byte < 0x20 || byte == 0x7f) {
      out += std::string("\\x") + kDigits[byte >> 4] + kDigits[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string streams_text(const std::map<std::string, std::uint64_t>& streams) {
  std::string out = streams.empty() ? "" : "streams:\n";
  for (const auto& [name, seed] : streams) out += "  " + yaml_word(name) + ": " + std::to_string(seed) + "\n";
  return out;
}

std::vector<std::string> yaml_stems(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  if (error) throw BadInput(folder.string() + ": " + error.message());
  std::vector<std::string> names;
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path find_yaml(const std::filesystem::path& folder, const std::string& what, const std::string& name) {
  const std::vector<std::string> names = yaml_stems(folder);
  if (!std::binary_search(names.begin(), names.end(), name)) {
    throw BadInput("unknown " + what + " '" + name + "'" + suggestion(name, names));
  }
  return folder / (name + ".yaml");
}

}  // namespace tumble::scenarios
