// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/external_description.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <utility>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "sim/situation.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTimeMax_s = 1e6;
constexpr double kMemoryMax_mib = 1e7;
constexpr std::size_t kWordMax = 4096;  // std::regex recurses once per character

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

std::string robot_named(const YamlNode& node) {
  const std::string name = node.identifier();
  std::vector<std::string> known;
  for (const sim::ComponentType& type : sim::robot_types()) known.push_back(type.name);
  if (std::find(known.begin(), known.end(), name) == known.end())
    node.fail("unknown robot '" + name + "'" + suggestion(name, known));
  return name;
}

std::vector<std::string> words_of(const YamlNode& node) {
  std::vector<std::string> words;
  for (const YamlNode& item : node.items()) {
    words.push_back(item.text());
    if (words.back().size() > kWordMax)
      item.fail(fmt::format("an argument of the command has {} characters; it may have at most {}", words.back().size(),
                            kWordMax));
    try {
      placeholders_in(words.back());
    } catch (const BadInput& error) {
      item.fail(error.what());
    }
  }
  if (words.empty()) node.fail("the command must have at least one word");
  return words;
}

double limit(const YamlNode& node, double most) {
  const double value = node.number();
  if (!(value > 0.0 && value <= most)) node.fail("must be within (0, " + std::to_string(most) + "]");
  return value;
}

std::string digest_of(const std::string& text) {
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

std::set<std::filesystem::path> own_files(const std::vector<std::string>& command,
                                          const std::filesystem::path& folder) {
  static const std::regex pattern(R"(\{folder\}/([^\s{}"';|&<>()]{1,512}))");
  std::set<std::filesystem::path> out;
  for (const std::string& word : command) {
    for (std::sregex_iterator it(word.begin(), word.end(), pattern), end; it != end; ++it) {
      std::error_code no_file;
      const std::filesystem::path file = folder / (*it)[1].str();
      if (std::filesystem::is_regular_file(file, no_file)) out.insert(file);
    }
  }
  return out;
}

std::uint64_t digest_of_file(const std::filesystem::path& file) {
  constexpr std::size_t kPiece = 1 << 20;
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::ifstream in(file, std::ios::binary);
  std::string piece(kPiece, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    XXH3_64bits_update(state.get(), piece.data(), static_cast<std::size_t>(in.gcount()));
  return XXH3_64bits_digest(state.get());
}

/// The digest (hash) of an external method covers its description and the files that its command names. A recompiled
/// program has another digest, and counts as another version of the method.
std::string digest_of_command(const std::string& text, const ExternalDescription& description) {
  std::string all = text;
  for (const std::filesystem::path& file : own_files(description.command, description.file.parent_path()))
    all += fmt::format("\n{} {:016x}", file.filename().string(), digest_of_file(file));
  return digest_of(all);
}

constexpr std::array<const char*, 2> kOfCommands = {"version", "output"};
constexpr std::array<const char*, 2> kOfPython = {"function", "interpreter"};

bool names_output(const std::vector<std::string>& command) {
  return std::any_of(command.begin(), command.end(),
                     [](const std::string& word) { return word.find("{output}") != std::string::npos; });
}

void read_command(const std::map<std::string, YamlNode>& fields, ExternalDescription& out) {
  for (const char* key : kOfPython)
    if (fields.contains(key))
      fields.at(key).fail("this key of the description applies only to a Python function, but the method is a command");
  out.command = words_of(fields.at("command"));
  if (!names_output(out.command))
    fields.at("command").fail(
        "no argument contains the placeholder {output}; add this placeholder, which stands for the path of the result");
  out.output = out.kind == Kind::rate ? ExternalDescription::Output::rates : ExternalDescription::Output::tum;
  if (fields.contains("output")) out.output = output_named(fields.at("output"));
  if ((out.output == ExternalDescription::Output::rates) != (out.kind == Kind::rate) &&
      out.output != ExternalDescription::Output::estimate)
    fields.at("output").fail(
        "kind 'rate' needs the output 'rates' or 'estimate'; the other kinds need the output 'tum' or 'estimate'");
  if (fields.contains("version")) out.version = words_of(fields.at("version"));
}

void read_python(const std::map<std::string, YamlNode>& fields, ExternalDescription& out) {
  for (const char* key : kOfCommands)
    if (fields.contains(key))
      fields.at(key).fail("this key of the description applies only to a command, but the method is a Python function");
  out.python = out.file.parent_path() / fields.at("python").text();
  if (!std::filesystem::is_regular_file(out.python))
    fields.at("python").fail(fmt::format("the path of the Python function is not a file: {}", out.python.string()));
  out.function = fields.contains("function") ? fields.at("function").text() : to_string(out.kind);
  if (fields.contains("interpreter"))
    for (const YamlNode& item : fields.at("interpreter").items()) out.interpreter.push_back(item.text());
}

std::vector<Kind> kinds_found(const std::string& text, const std::regex& pattern) {
  std::vector<Kind> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    if (const auto kind = kind_named((*it)[2].str())) found.push_back(*kind);
  return found;
}

Kind kind_of_function(const std::string& text, const std::string& file) {
  static const std::regex defined(R"((^|\n)def[ \t]{1,8}(rate|attitude|position|slam)[ \t]{0,8}\()");
  static const std::regex assigned(R"((^|\n)(rate|attitude|position|slam)[ \t]{0,8}=(?!=))");
  std::vector<Kind> found = kinds_found(text, defined);
  if (found.empty()) found = kinds_found(text, assigned);
  if (found.size() != 1)
    throw BadInput(
        fmt::format("{}: the file defines {} functions named rate, attitude, position or slam; it must define exactly "
                    "one (to use another function name, write a file NAME.yaml)",
                    file, found.size()));
  return found.front();
}

ExternalDescription of_python_file(const std::filesystem::path& file) {
  const std::string text = read_text_file(file);
  ExternalDescription out;
  out.file = std::filesystem::absolute(file);
  out.digest = digest_of(text);
  out.kind = kind_of_function(text, file.string());
  const std::string stem = file.stem().string();
  out.name = YamlNode::parse("name: " + stem, file.string())
                 .fields(std::array<std::string, 1>{"name"})
                 .at("name")
                 .identifier();
  out.source = file.filename().string();
  out.python = out.file;
  out.function = to_string(out.kind);
  return out;
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
      throw BadInput("unknown placeholder '{" + name + "}'" +
                     (sim::did_you_mean(name, known).empty() ? suggestion(name, known)
                                                             : suggestion(name, known) + " (known placeholders: " +
                                                                   fmt::format("{}", fmt::join(known, " ")) + ")"));
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
  if (file.extension() == ".py") return of_python_file(file);
  const std::string text = read_text_file(file);
  const YamlNode root = YamlNode::parse(text, file.string());
  const std::array<std::string, 2> required = {"name", "kind"};
  const std::array<std::string, 13> optional = {
      "command", "python", "function",    "interpreter", "doc",          "source",          "robots",
      "version", "frame",  "environment", "output",      "time_limit_s", "memory_limit_mib"};
  const auto fields = root.fields(required, optional);
  const auto given = [&](const char* key) { return fields.contains(key); };
  if (given("command") == given("python"))
    root.fail("the description must have exactly one of the keys 'command' and 'python'");

  ExternalDescription out;
  out.file = std::filesystem::absolute(file);
  out.digest = digest_of(text);
  out.name = fields.at("name").identifier();
  out.kind = named(fields.at("kind"), Kind::slam);
  if (given("command")) {
    read_command(fields, out);
    out.digest = digest_of_command(text, out);
  } else {
    read_python(fields, out);
  }
  if (given("doc")) out.doc = fields.at("doc").text();
  out.source = given("source") ? fields.at("source").text() : file.filename().string();
  if (given("frame")) out.frame = named(fields.at("frame"), Frame::centre);
  if (given("robots"))
    for (const YamlNode& robot : fields.at("robots").items()) out.robots.push_back(robot_named(robot));
  if (given("environment"))
    for (const auto& [name, value] : fields.at("environment").entries()) out.environment[name] = value.any_text();
  if (given("time_limit_s")) out.time_limit_s = limit(fields.at("time_limit_s"), kTimeMax_s);
  if (given("memory_limit_mib")) out.memory_limit_mib = limit(fields.at("memory_limit_mib"), kMemoryMax_mib);
  return out;
}

}  // namespace tumble::scenarios
