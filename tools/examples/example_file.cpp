// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "tools/examples/example.hpp"

namespace tumble::tools {

namespace {

nlohmann::json numbers(const std::vector<double>& values) {
  nlohmann::json out = nlohmann::json::array();
  for (const double value : values) out.push_back(std::isfinite(value) ? nlohmann::json(value) : nlohmann::json());
  return out;
}

std::vector<double> read_numbers(const nlohmann::json& values) {
  std::vector<double> out;
  for (const nlohmann::json& value : values)
    out.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  return out;
}

}  // namespace

static void to_json(nlohmann::json& out, const PlotLine& line) {
  out = {{"name", line.name},     {"colour", line.colour}, {"width", line.width}, {"dotted", line.dotted},
         {"hidden", line.hidden}, {"x", numbers(line.x)},  {"y", numbers(line.y)}};
}

static void from_json(const nlohmann::json& from, PlotLine& line) {
  line.name = from.at("name");
  line.colour = from.at("colour");
  line.width = from.at("width");
  line.dotted = from.at("dotted");
  line.hidden = from.at("hidden");
  line.x = read_numbers(from.at("x"));
  line.y = read_numbers(from.at("y"));
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Plot, name, caption, x_title, y_title, equal_scales, from_zero, over_time, wide,
                                   shaded, lines)

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using scenarios::BadInput;

constexpr const char* kFormat = "tumble examples";
constexpr int kVersion = 1;

fs::path list_file(const fs::path& folder) {
  return folder / "examples.json";
}

std::string file_of(const Example& example, const std::string& ending) {
  std::string name = example.scenario + "-" + std::to_string(example.seed) + "-" + ending;
  for (char& c : name) {
    if (c == '/' || c == '\0') c = '_';
  }
  return name;
}

std::string picture_file(const Example& example, const ExamplePicture& picture) {
  return file_of(example, picture.name + ".png");
}

fs::path unfinished(const fs::path& folder) {
  return folder / ".unfinished";
}

std::vector<std::uint8_t> read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw BadInput(fmt::format("{}: the file cannot be read; give a regular file", path.string()));
  try {
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  } catch (const std::ios_base::failure& error) {  // opening a folder succeeds
    throw BadInput(fmt::format("{}: the file cannot be read: {}", path.string(), error.what()));
  }
}

/// The list of examples may be untrusted, so only files in its folder are read or removed.
std::string file_name(const std::string& name, const char* ending, const char* what) {
  if (name.empty() || fs::path(name).filename() != name || name.starts_with('.') || !name.ends_with(ending))
    throw BadInput(fmt::format("'{}' must be the name of a {} in the same folder", name, what));
  return name;
}

std::string file_name(const json& picture) {
  return file_name(picture.at("file"), ".png", "picture");
}

std::string replay_name(const json& example) {
  const std::string name = example.value("replay", "");
  return name.empty() ? name : file_name(name, ".html", "replay");
}

constexpr const char* kMovingEnding = "moving.webp";

std::string moving_name(const json& example) {
  if (!example.contains("moving")) return "";
  return file_name(example.at("moving").at("file"), ".webp", "moving picture");
}

ExamplePicture read_picture(const fs::path& folder, const json& from, Pictures pictures) {
  ExamplePicture picture;
  picture.name = from.at("name");
  picture.alternative = from.at("alternative");
  picture.caption = from.at("caption");
  from.at("legend").get_to(picture.legend);
  const std::string name = file_name(from);
  if (pictures == Pictures::read) picture.png = read_bytes(folder / name);
  return picture;
}

Example read_example(const fs::path& folder, const json& from, Pictures pictures) {
  Example example;
  example.scenario = from.at("scenario");
  example.seed = from.at("seed");
  example.motion = from.at("motion");
  example.choice = from.at("choice");
  example.of_failure = from.value("of_failure", false);  // missing in earlier versions
  example.recording_digest = from.at("recording_digest");
  example.digest_without_lidars = from.at("digest_without_lidars");
  example.made_of = from.at("made_of");
  for (const json& picture : from.at("pictures")) example.pictures.push_back(read_picture(folder, picture, pictures));
  for (const json& plot : from.at("plots")) example.plots.push_back(plot.get<Plot>());
  if (const std::string moving = moving_name(from); !moving.empty()) {
    example.moving_caption = from.at("moving").at("caption");
    if (pictures == Pictures::read) example.moving = read_bytes(folder / moving);
  }
  example.replay = replay_name(from);
  std::error_code error;
  if (pictures == Pictures::read && !example.replay.empty() && !fs::is_regular_file(folder / example.replay, error))
    throw BadInput(fmt::format("{}: the file cannot be read", (folder / example.replay).string()));
  return example;
}

json read_list(const fs::path& folder) {
  const fs::path path = list_file(folder);
  std::error_code error;
  if (fs::status(path, error).type() == fs::file_type::not_found) return json();
  json list = json::parse(read_bytes(path));
  if (list.at("format") != kFormat || list.at("version") != kVersion)
    throw BadInput(fmt::format("this file is not a list of examples of version {}", kVersion));
  return list;
}

json whole_examples(const fs::path& folder) {
  constexpr int kDepth = 2;  // nesting depth: list, array, example
  json whole = json::array();
  try {
    const auto keep = [&](int depth, json::parse_event_t event, json& parsed) {
      if (depth == kDepth && event == json::parse_event_t::object_end) whole.push_back(parsed);
      return true;
    };
    if (!json::parse(read_bytes(list_file(folder)), keep, false).is_discarded()) return json::array();
  } catch (const BadInput&) {  // the path is a folder
  }
  return whole;
}

std::set<std::string> files_of(const json& examples) {
  std::set<std::string> files;
  for (const json& example : examples) {
    for (const json& picture : example.at("pictures")) files.insert(file_name(picture));
    for (const std::string& name : {moving_name(example), replay_name(example)}) {
      if (!name.empty()) files.insert(name);
    }
  }
  return files;
}

std::set<std::string> files_before(const fs::path& folder) {
  try {
    const json list = read_list(folder);
    if (list.is_null()) return {};
    for (const json& example : list.at("examples")) read_example(folder, example, Pictures::read);
    return files_of(list.at("examples"));
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

fs::path examples_folder(const fs::path& database) {
  return fs::path(database.string() + ".files");
}

std::string replay_file(const Example& example) {
  return file_of(example, "replay.html");
}

std::string to_json(const Example& example) {
  json out = {{"scenario", example.scenario},
              {"seed", example.seed},
              {"motion", example.motion},
              {"choice", example.choice},
              {"of_failure", example.of_failure},
              {"recording_digest", example.recording_digest},
              {"digest_without_lidars", example.digest_without_lidars},
              {"made_of", example.made_of},
              {"pictures", json::array()},
              {"plots", json::array()}};
  for (const ExamplePicture& picture : example.pictures) {
    out["pictures"].push_back({{"name", picture.name},
                               {"file", picture_file(example, picture)},
                               {"alternative", picture.alternative},
                               {"caption", picture.caption},
                               {"legend", picture.legend}});
  }
  for (const Plot& plot : example.plots) out["plots"].push_back(plot);
  if (!example.moving.empty())
    out["moving"] = {{"file", file_of(example, kMovingEnding)}, {"caption", example.moving_caption}};
  if (!example.replay.empty()) out["replay"] = example.replay;
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

void write_pictures(const fs::path& folder, const Example& example) {
  std::error_code error;
  fs::create_directories(unfinished(folder), error);
  if (error) throw BadInput(unfinished(folder).string() + ": " + error.message());
  for (const ExamplePicture& picture : example.pictures)
    scenarios::replace_file(unfinished(folder) / picture_file(example, picture), std::as_bytes(std::span(picture.png)));
  if (!example.moving.empty())
    scenarios::replace_file(unfinished(folder) / file_of(example, kMovingEnding),
                            std::as_bytes(std::span(example.moving)));
  if (!example.replay.empty()) scenarios::replace_file(unfinished(folder) / example.replay, example.replay_page);
}

void discard_unfinished(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(unfinished(folder), ignored);
}

void write_examples(const fs::path& folder, const std::vector<std::string>& examples) {
  const std::set<std::string> before = files_before(folder);
  json list = {{"format", kFormat}, {"version", kVersion}, {"examples", json::array()}};
  for (const std::string& example : examples) list["examples"].push_back(json::parse(example));
  scenarios::replace_file(list_file(folder), list.dump() + "\n");
  const std::set<std::string> now = files_of(list.at("examples"));
  for (const std::string& name : now) {
    std::error_code error;
    if (!fs::exists(unfinished(folder) / name, error)) continue;  // the file was moved already
    fs::rename(unfinished(folder) / name, folder / name, error);
    if (error)
      throw BadInput(fmt::format("{}: the file cannot be written: {}", (folder / name).string(), error.message()));
  }
  discard_unfinished(folder);
  for (const std::string& name : before) {
    std::error_code ignored;
    if (!now.contains(name)) fs::remove(folder / name, ignored);
  }
}

FoundExamples read_examples(const fs::path& folder, Pictures pictures) {
  FoundExamples found;
  const auto note = [&](const std::string& what) { found.unreadable.push_back(list_file(folder).string() + what); };
  json examples;
  try {
    const json list = read_list(folder);
    if (list.is_null()) return found;
    examples = list.at("examples");
  } catch (const std::exception& error) {
    note(std::string(": ") + error.what());
    examples = whole_examples(folder);
  }
  for (std::size_t i = 0; i < examples.size(); ++i) {
    try {
      found.examples.push_back(read_example(folder, examples[i], pictures));
    } catch (const std::exception& error) {
      note(", example " + std::to_string(i + 1) + ": " + error.what());
    }
  }
  return found;
}

fs::path set_damaged_aside(const fs::path& folder) {
  const std::string name = list_file(folder).string() + ".damaged";
  fs::path aside = name;
  std::error_code error;
  for (int k = 2; fs::exists(aside, error); ++k) aside = name + "." + std::to_string(k);
  fs::copy_file(list_file(folder), aside, error);
  if (error) throw BadInput(fmt::format("{}: the file cannot be written: {}", aside.string(), error.message()));
  return aside;
}

}  // namespace tumble::tools
