// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <span>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

/// The LZF compression stores at most 264 bytes of data in 3 bytes.
constexpr std::uint64_t kLzfMost = 88;
constexpr std::size_t kCloudHeaderMax = 65536;

class HeaderLines {
 public:
  explicit HeaderLines(const std::filesystem::path& path) : path_(path), stream_(open_regular_file(path)) {
    bytes_in_file_ = std::filesystem::file_size(path);
  }

  std::vector<std::string> next() {
    if (!std::getline(stream_, line_) || stream_.eof()) fail("the file ends within its header; it may be truncated");
    ++number_;
    bytes_ += line_.size() + 1;
    if (bytes_ > kCloudHeaderMax)
      fail(fmt::format("the header of the point file is longer than the maximum of {} bytes", kCloudHeaderMax));
    if (line_.find_first_of("\v\f") != std::string::npos)
      fail("the header contains a form feed or a vertical tab, which is not allowed");
    std::istringstream words(line_);
    std::vector<std::string> out;
    for (std::string word; words >> word;) out.push_back(word);
    return out;
  }

  bool line_is_empty() const { return line_.empty(); }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput(path_.string() + ":" + std::to_string(number_) + ": " + what);
  }

  std::uint64_t whole(const std::string& what, const std::string& text) const {
    std::uint64_t value = 0;
    if (!read_number(text, value))
      fail(fmt::format("the header states {} as '{}'; it must be a whole number", what, text));
    return value;
  }

  std::uint64_t bytes() const { return bytes_; }

  /// Throws if the file is too short for the stated number of points. `made_of_a_byte` is the largest possible
  /// compression factor of point data (1: uncompressed).
  void require_room(const CloudHeader& header, std::uint64_t made_of_a_byte = 1) const {
    if (header.points > kCloudPointsMax) {
      fail(fmt::format("the file states {} points; at most {} can be read", header.points, kCloudPointsMax));
    }
    const std::uint64_t point_bytes = header.point_bytes > 0 ? header.point_bytes : 2 * header.fields;
    const std::uint64_t slack = header.point_bytes > 0 ? 0 : 1;
    const std::uint64_t rest = bytes_in_file_ - std::min(bytes_, bytes_in_file_) + slack;
    if (header.points * point_bytes > rest * made_of_a_byte) {
      fail(fmt::format(
          "the header states {} points of at least {} bytes, but only {} bytes follow; the file may be truncated",
          header.points, point_bytes, rest));
    }
  }

  /// Compressed points start with two sizes, the number of compressed bytes and the number of uncompressed bytes, which
  /// PCL does not check.
  void require_sizes(const CloudHeader& header) {
    std::array<std::uint32_t, 2> sizes{};
    if (!stream_.read(reinterpret_cast<char*>(sizes.data()), sizeof(sizes)))
      fail("the file ends before its compressed points; it may be truncated");
    const std::uint64_t rest = bytes_in_file_ - std::min(bytes_ + sizeof(sizes), bytes_in_file_);
    if (sizes[0] == 0 || sizes[0] > rest) {
      fail(fmt::format("the file states {} bytes of compressed points, but only {} bytes follow; it may be truncated",
                       sizes[0], rest));
    }
    if (sizes[1] != header.points * header.point_bytes) {
      fail(fmt::format("the file states {} bytes of uncompressed points, but its header requires {} bytes", sizes[1],
                       header.points * header.point_bytes));
    }
  }

  /// PCL would interpret a line of point data that looks like a header line as part of the header.
  void require_end_of_header(std::span<const char* const> words) {
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(bytes_));
    for (std::string line; std::getline(stream_, line);) {
      std::string first;
      std::istringstream(line) >> first;
      if (line.empty() || first.starts_with("#")) continue;
      const auto begins = [&](const char* word) { return first.starts_with(word); };
      if (std::any_of(words.begin(), words.end(), begins))
        fail("the first line of point data looks like a header line, so PCL would misread the file");
      return;
    }
  }

 private:
  std::filesystem::path path_;
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
  std::uint64_t bytes_ = 0, bytes_in_file_ = 0;
};

std::uint64_t ply_bytes(const std::string& type) {
  static const std::map<std::string, std::uint64_t> known = {
      {"char", 1},   {"int8", 1},    {"uchar", 1},  {"uint8", 1},  {"short", 2}, {"int16", 2},
      {"ushort", 2}, {"uint16", 2},  {"int", 4},    {"int32", 4},  {"uint", 4},  {"uint32", 4},
      {"float", 4},  {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = known.find(type);
  return found == known.end() ? 0 : found->second;
}

void take_property(const HeaderLines& lines, const std::vector<std::string>& words, CloudHeader& header) {
  if (words.size() == 5 && words[1] == "list")
    lines.fail("the points of the PLY file have a list property, which is not supported");
  if (words.size() != 3) lines.fail("a property line of a PLY header must be 'property TYPE NAME'");
  const std::uint64_t bytes = ply_bytes(words[1]);
  if (bytes == 0) lines.fail("unknown type '" + words[1] + "'");
  header.point_bytes += bytes;
  ++header.fields;
}

using Words = std::vector<std::string>;

constexpr std::array<const char*, 11> kPcdWords = {"VERSION", "FIELDS",    "SIZE",   "TYPE", "COUNT",  "WIDTH",
                                                   "HEIGHT",  "VIEWPOINT", "POINTS", "DATA", "COLUMNS"};

/// Each keyword of a PCD header must occur once and in the standard order, because PCL misreads other headers without
/// an error.
std::map<std::string, Words> pcd_lines(HeaderLines& lines) {
  const std::span order = std::span(kPcdWords).first<10>();
  std::map<std::string, Words> found;
  std::size_t next = 0;
  while (!found.contains("DATA")) {
    const Words words = lines.next();
    if (words.empty() && !lines.line_is_empty())
      lines.fail("a header line contains only blanks; it must be empty or contain a word");
    if (words.empty() || words.front().starts_with("#")) continue;
    const auto at = std::find(order.begin(), order.end(), words.front());
    if (at == order.end()) lines.fail("a header line does not begin with a keyword of the PCD format");
    const auto place = static_cast<std::size_t>(at - order.begin());
    if (place < next) lines.fail(fmt::format("the header line {} occurs twice or in the wrong order", words.front()));
    next = place + 1;
    found[words.front()] = Words(words.begin() + 1, words.end());
  }
  for (const char* needed : {"FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT"}) {
    if (!found.contains(needed))
      lines.fail(fmt::format("the header has no line {} before DATA; the file may not be a PCD file", needed));
  }
  return found;
}

std::uint64_t single(const HeaderLines& lines, const std::string& name, const Words& words) {
  if (words.size() != 1)
    lines.fail(fmt::format("the header line {} has {} numbers; it must have 1", name, words.size()));
  const std::uint64_t value = lines.whole(name, words.front());
  if (value > kCloudPointsMax) {
    lines.fail(fmt::format("the header line {} states {}; it must state at most {}", name, value, kCloudPointsMax));
  }
  return value;
}

std::string viewpoint_of(const HeaderLines& lines, const Words& words) {
  if (words.size() != 7)
    lines.fail(fmt::format("the header line VIEWPOINT has {} numbers; it must have 7", words.size()));
  constexpr std::array<double, 7> kOwn = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  std::string written;
  bool own = true;
  for (std::size_t i = 0; i < kOwn.size(); ++i) {
    double value = 0.0;
    if (!read_number(words[i], value) || !std::isfinite(value))
      lines.fail(fmt::format("VIEWPOINT's number {} is '{}'; it must be a finite number", i + 1, words[i]));
    own = own && value == kOwn[i];
    written += (i > 0 ? " " : "") + words[i];
  }
  return own ? "" : written;
}

}  // namespace

CloudHeader read_ply_header(const std::filesystem::path& path) {
  HeaderLines lines(path);
  CloudHeader header;
  if (lines.next() != Words{"ply"}) lines.fail("the file does not begin with 'ply', so it is not a PLY file");
  bool text = false, in_points = false, before_points = true;
  for (Words words = lines.next(); words != Words{"end_header"}; words = lines.next()) {
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      text = words.size() > 1 && words[1] == "ascii";
    } else if (words[0] == "element") {
      if (words.size() != 3) lines.fail("an element line of a PLY header must be 'element NAME COUNT'");
      in_points = words[1] == "vertex";
      const std::uint64_t count = lines.whole("count of " + words[1], words[2]);
      if (in_points) header.points = count, before_points = false;
      if (!in_points && before_points && count > 0) lines.fail("the points must be the first element of the file");
      if (!in_points && count > kCloudPointsMax) lines.fail("states " + words[2] + " of " + words[1]);
    } else if (words[0] == "property") {
      if (in_points) take_property(lines, words, header);
    } else {
      lines.fail("unknown header line '" + words[0] + "'");
    }
  }
  if (header.fields == 0)
    lines.fail("the PLY header has no 'element vertex' with properties, so the file has no points");
  if (text) header.point_bytes = 0;
  header.ascii = text;
  header.numbers = header.fields;
  header.header_bytes = lines.bytes();
  lines.require_room(header);
  return header;
}

CloudHeader read_pcd_header(const std::filesystem::path& path) {
  HeaderLines lines(path);
  std::map<std::string, Words> found = pcd_lines(lines);
  CloudHeader header;
  header.fields = found["FIELDS"].size();
  if (header.fields == 0) lines.fail("FIELDS has no names");
  if (!found.contains("COUNT")) found["COUNT"] = Words(header.fields, "1");
  for (const char* name : {"SIZE", "TYPE", "COUNT"}) {
    if (found[name].size() != header.fields) {
      lines.fail(fmt::format("the header line {} has {} words, but FIELDS has {}; the numbers must be equal", name,
                             found[name].size(), header.fields));
    }
  }
  for (std::size_t i = 0; i < header.fields; ++i) {
    const std::uint64_t size = lines.whole("SIZE", found["SIZE"][i]), count = lines.whole("COUNT", found["COUNT"][i]);
    if (size == 0 || size > 8 || count == 0 || count > 4096) {
      lines.fail(fmt::format("the field {} has {} numbers of {} bytes; supported: 1 to 4096 numbers of 1 to 8 bytes",
                             found["FIELDS"][i], count, size));
    }
    const std::string& type = found["TYPE"][i];
    const bool whole = type == "I" || type == "U", real = type == "F";
    if (!(whole && (size == 1 || size == 2 || size == 4 || size == 8)) && !(real && (size == 4 || size == 8))) {
      lines.fail(fmt::format(
          "the type of field {} is not supported; supported: I and U with 1, 2, 4 or 8 bytes, F with 4 or 8 bytes",
          i + 1));
    }
    header.point_bytes += size * count;
    header.numbers += count;
  }
  const std::uint64_t width = single(lines, "WIDTH", found["WIDTH"]), height = single(lines, "HEIGHT", found["HEIGHT"]);
  header.points = width * height;
  if (found.contains("POINTS") && single(lines, "POINTS", found["POINTS"]) != header.points) {
    lines.fail(fmt::format("POINTS is {}, but WIDTH times HEIGHT is {}; both must be equal", found["POINTS"].front(),
                           header.points));
  }
  if (found.contains("VIEWPOINT")) header.viewpoint = viewpoint_of(lines, found["VIEWPOINT"]);
  const std::string encoding = found["DATA"].empty() ? "" : found["DATA"].front();
  header.header_bytes = lines.bytes();
  if (encoding == "ascii") {
    header.point_bytes = 0;
    header.ascii = true;
  } else if (encoding != "binary" && encoding != "binary_compressed") {
    lines.fail(fmt::format("DATA is '{}'; it must be ascii, binary or binary_compressed", encoding));
  }
  lines.require_room(header, encoding == "binary_compressed" ? kLzfMost : 1);
  if (encoding == "binary_compressed" && header.points > 0) lines.require_sizes(header);
  lines.require_end_of_header(kPcdWords);
  return header;
}

}  // namespace tumble::scenarios
