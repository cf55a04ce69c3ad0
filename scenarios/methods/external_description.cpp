// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/external_description.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTimeMax_s = 1e6;
constexpr double kMemoryMax_mib = 1e7;

const std::regex& placeholder() {
  static const std::regex pattern(R"(\{([a-z0-9_]+)\})");
  return pattern;
}

template <typename Enum>
Enum named(const YamlNode& node, Enum last) {
  const std::string name = node.text();
  std::vector<std::string> known;
  for (int k = 0; k <= static_cast<int>(last); ++k) {
    known.emplace_back(to_string(static_cast<Enum>(k)));
    if (name == known.back()) return static_cast<Enum>(k);
  }
  node.fail("unknown name '" + name + "'" + suggestion(name, known));
}

ExternalDescription::Output output_named(const YamlNode& node) {
  const std::array<std::string, 3> known = {"rates", "tum", "estimate"};
  const std::string name = node.text();
  for (std::size_t k = 0; k < known.size(); ++k)
    if (name == known[k]) return static_cast<ExternalDescription::Output>(k);
  node.fail("unknown output '" + name + "'" + suggestion(name, known));
}

/// The words of a command, their placeholders known.
std::vector<std::string> words_of(const YamlNode& node) {
  std::vector<std::string> words;
  for (const YamlNode& item : node.items()) {
    words.push_back(item.text());
    try {
      placeholders_in(words.back());
    } catch (const BadInput& error) {
      item.fail(error.what());
    }
  }
  if (words.empty()) node.fail("no word");
  return words;
}

double limit(const YamlNode& node, double most) {
  const double value = node.number();
  if (!(value > 0.0 && value <= most)) node.fail("must be within (0, " + std::to_string(most) + "]");
  return value;
}

bool names_output(const std::vector<std::string>& command) {
  return std::any_of(command.begin(), command.end(),
                     [](const std::string& word) { return word.find("{output}") != std::string::npos; });
}

}  // namespace

std::vector<std::string> external_placeholders() {
  return {"recording", "csv", "ply", "pcd", "rosbag1", "rosbag2", "mcap", "sensors", "output", "map", "folder"};
}

std::vector<std::string> placeholders_in(const std::string& word) {
  const std::vector<std::string> known = external_placeholders();
  std::vector<std::string> out;
  for (std::sregex_iterator it(word.begin(), word.end(), placeholder()), end; it != end; ++it) {
    const std::string name = (*it)[1];
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw BadInput("unknown placeholder '{" + name + "}'" + suggestion(name, known));
    out.push_back(name);
  }
  return out;
}

std::string filled(const std::string& word, const std::map<std::string, std::string>& values) {
  std::string out;
  auto from = word.begin();
  for (std::sregex_iterator it(word.begin(), word.end(), placeholder()), end; it != end; ++it) {
    out.append(from, (*it)[0].first);
    out += values.at((*it)[1]);
    from = (*it)[0].second;
  }
  return out.append(from, word.end());
}

ExternalDescription read_external(const std::filesystem::path& file) {
  const std::string text = read_text_file(file);
  const YamlNode root = YamlNode::parse(text, file.string());
  const std::array<std::string, 3> required = {"name", "kind", "command"};
  const std::array<std::string, 9> optional = {"doc",         "source", "robots",       "version",         "frame",
                                               "environment", "output", "time_limit_s", "memory_limit_mib"};
  const auto fields = root.fields(required, optional);
  const auto given = [&](const char* key) { return fields.contains(key); };

  ExternalDescription out;
  out.file = std::filesystem::absolute(file);
  out.digest = fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
  out.name = fields.at("name").identifier();
  out.kind = named(fields.at("kind"), Kind::slam);
  out.command = words_of(fields.at("command"));
  if (!names_output(out.command)) fields.at("command").fail("no word names {output}, where the result is looked for");
  out.output = out.kind == Kind::rate ? ExternalDescription::Output::rates : ExternalDescription::Output::tum;
  if (given("output")) out.output = output_named(fields.at("output"));
  if ((out.output == ExternalDescription::Output::rates) != (out.kind == Kind::rate) &&
      out.output != ExternalDescription::Output::estimate)
    fields.at("output").fail("rates are the output of kind rate, and a TUM file is that of the others");
  if (given("doc")) out.doc = fields.at("doc").text();
  out.source = given("source") ? fields.at("source").text() : file.string();
  if (given("frame")) out.frame = named(fields.at("frame"), Frame::centre);
  if (given("robots"))
    for (const YamlNode& robot : fields.at("robots").items()) out.robots.push_back(robot.identifier());
  if (given("version")) out.version = words_of(fields.at("version"));
  if (given("environment"))
    for (const auto& [name, value] : fields.at("environment").entries()) out.environment[name] = value.any_text();
  if (given("time_limit_s")) out.time_limit_s = limit(fields.at("time_limit_s"), kTimeMax_s);
  if (given("memory_limit_mib")) out.memory_limit_mib = limit(fields.at("memory_limit_mib"), kMemoryMax_mib);
  return out;
}

}  // namespace tumble::scenarios
