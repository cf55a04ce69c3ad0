// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/strict_yaml.hpp"

#include <fmt/format.h>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/text.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::uintmax_t kLargestFile = 4u << 20;
constexpr std::size_t kIdentifierMax = 100;

/// For some invalid texts, the YAML parser produces events without end. Counter reports an endless loop if the number
/// of events exceeds four per byte of text, plus 64.
class Counter : public YAML::EventHandler {
 public:
  Counter(const std::string& text, const std::string& file) : most_(4 * text.size() + 64), file_(file) {}

  void OnDocumentStart(const YAML::Mark& mark) override { count(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

 private:
  void count(const YAML::Mark& mark) {
    if (++found_ > most_) throw BadInput(file_ + ":" + std::to_string(mark.line + 1) + ": not valid YAML");
  }

  std::size_t most_, found_ = 0;
  const std::string& file_;
};

void require_one_document(const std::string& text, const std::string& file) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Counter counter(text, file);
  if (!parser.HandleNextDocument(counter)) throw BadInput(file + ": the file is empty");
  if (parser.HandleNextDocument(counter))
    throw BadInput(
        fmt::format("{}: the file must contain one YAML document, but contains more than one document", file));
}

std::string join(const std::string& place, const std::string& name) {
  return place.empty() ? name : place + "." + name;
}

const char* kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  return node.IsScalar() ? "text" : "nothing";
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
  std::ifstream stream = open_regular_file(path);
  std::error_code error;
  if (std::filesystem::file_size(path, error) > kLargestFile || error) {
    throw BadInput(fmt::format("{}: the file is larger than 4 MiB", path.string()));
  }
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) throw BadInput(path.string() + ": cannot be read");
  return text;
}

std::string suggestion(const std::string& name, std::span<const std::string> known) {
  const std::string near = sim::did_you_mean(name, known);
  if (!near.empty()) return "; " + near;
  if (known.empty()) return "; there are no valid names";
  std::string text = "; known names:";
  for (const std::string& each : known) text += " " + each;
  return text;
}

YamlNode::YamlNode(const YAML::Node& node, std::string file, std::string place)
    : node_(node), file_(std::move(file)), place_(std::move(place)), line_(node.Mark().line + 1) {}

YamlNode YamlNode::parse(const std::string& text, const std::string& file) {
  try {
    require_one_document(text, file);
    const YAML::Node document = YAML::Load(text);
    if (document.IsNull()) throw BadInput(file + ": the file is empty");
    return YamlNode(document, file, "");
  } catch (const YAML::Exception& error) {
    throw BadInput(file + ":" + std::to_string(error.mark.line + 1) + ": not valid YAML: " + error.msg);
  }
}

void YamlNode::fail(const std::string& what) const {
  throw BadInput(file_ + ":" + std::to_string(line_) + ": " + (place_.empty() ? "" : place_ + ": ") + what);
}

std::string YamlNode::any_text() const {
  if (!node_.IsScalar()) fail(fmt::format("the value of this key must be text; it is {}", kind_of(node_)));
  return node_.Scalar();
}

std::string YamlNode::text() const {
  if (any_text().empty()) fail("must not be empty");
  return node_.Scalar();
}

std::string YamlNode::identifier() const {
  const std::string name = text();
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto allowed = [&](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (!lower(name[0]) || !std::all_of(name.begin(), name.end(), allowed)) {
    fail(fmt::format(
        "the name '{}' must begin with a lower-case letter and contain only lower-case letters, digits and underscores",
        name));
  }
  if (name.size() > kIdentifierMax) {
    fail(fmt::format("the name has {} characters; it must have at most {}", name.size(), kIdentifierMax));
  }
  return name;
}

double YamlNode::number() const {
  return parse_number(false);
}
double YamlNode::number_or_infinity() const {
  return parse_number(true);
}

double YamlNode::parse_number(bool infinity_allowed) const {
  if (!node_.IsScalar()) fail(fmt::format("the value of this key must be a number; it is {}", kind_of(node_)));
  const std::string& written = node_.Scalar();
  if (node_.Tag() == "!") fail(fmt::format("the value of this key must be a number; it is the text \"{}\"", written));
  if (infinity_allowed && written == ".inf") return std::numeric_limits<double>::infinity();
  if (infinity_allowed && written == "-.inf") return -std::numeric_limits<double>::infinity();
  double value = 0.0;
  const char* const end = written.data() + written.size();
  const auto [stop, error] = std::from_chars(written.data(), end, value);
  if (error == std::errc::result_out_of_range)
    fail(fmt::format("the number '{}' is outside the range of a double", written));
  if (error != std::errc() || stop != end)
    fail(fmt::format("the value of this key must be a number; it is '{}'", written));
  if (!std::isfinite(value)) fail(fmt::format("the value of this key must be finite; it is '{}'", written));
  return value;
}

std::uint64_t YamlNode::unsigned_integer() const {
  const std::string written = text();
  std::uint64_t value = 0;
  if (!read_number(written, value))
    fail(fmt::format("the value of this key must be an integer from 0 to 2^64-1; it is '{}'", written));
  return value;
}

std::vector<YamlNode> YamlNode::items() const {
  if (!node_.IsSequence()) fail(fmt::format("the value of this key must be a list; it is {}", kind_of(node_)));
  std::vector<YamlNode> out;
  for (const YAML::Node& item : node_)
    out.push_back(YamlNode(item, file_, place_ + "[" + std::to_string(out.size()) + "]"));
  return out;
}

std::vector<std::pair<std::string, YamlNode>> YamlNode::entries() const {
  if (!node_.IsMap()) fail(fmt::format("the value must be a map of keys and values; it is {}", kind_of(node_)));
  std::vector<std::pair<std::string, YamlNode>> out;
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const YamlNode key(entry.first, file_, place_);
    const std::string name = key.text();
    if (!seen.insert(name).second) key.fail(fmt::format("the key '{}' is given twice; each key may occur once", name));
    YamlNode value(entry.second, file_, join(place_, name));
    value.line_ = key.line_;
    out.emplace_back(name, std::move(value));
  }
  return out;
}

std::map<std::string, YamlNode> YamlNode::fields(std::span<const std::string> required,
                                                 std::span<const std::string> optional) const {
  std::vector<std::string> known(required.begin(), required.end());
  known.insert(known.end(), optional.begin(), optional.end());
  if (!node_.IsMap() && !required.empty()) {
    std::string keys;
    for (const std::string& name : required) keys += (keys.empty() ? "" : ", ") + name;
    fail(fmt::format("the value must be a map with the keys {}; it is {}", keys, kind_of(node_)));
  }
  std::map<std::string, YamlNode> out;
  for (auto& [name, value] : entries()) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      value.fail("unknown key '" + name + "'" + suggestion(name, known));
    }
    out.emplace(name, value);
  }
  for (const std::string& name : required) {
    if (!out.contains(name)) fail(fmt::format("key '{}' is missing", name));
  }
  return out;
}

}  // namespace tumble::scenarios
