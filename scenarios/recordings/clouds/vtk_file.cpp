// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/vtk_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

class VtkWords {
 public:
  explicit VtkWords(const std::filesystem::path& path) : name_(path.string()) {
    std::ifstream stream = open_regular_file(path);
    text_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput(name_ + ":" + std::to_string(line_) + ": " + what);
  }

  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view out = std::string_view(text_).substr(at_, end - at_);
    if (out.ends_with('\r')) out.remove_suffix(1);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return out;
  }

  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }

  std::string_view need(const char* what) {
    const std::string_view word = next();
    if (word.empty()) fail(fmt::format("the VTK file ends before {}; it may be truncated", what));
    return word;
  }

  std::uint64_t whole(const char* what) {
    const std::string_view word = need(what);
    std::uint64_t value = 0;
    if (!read_number(word, value))
      fail(fmt::format("the VTK file states {} as '{}'; it must be a whole number", what, shortened(word)));
    return value;
  }

  double number() {
    std::string_view word = need("its numbers");
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    if (!read_number(word, value))
      fail(fmt::format("word '{}' is not a number that fits a double (use a decimal point)", shortened(word)));
    return value;
  }

  /// Returns an upper bound of the remaining numbers: each number needs at least two bytes, a digit and a separator.
  std::uint64_t left() const { return text_.size() - at_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  std::string name_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

void require_room(const VtkWords& words, std::uint64_t count, std::uint64_t each) {
  if (count > kCloudPointsMax) {
    words.fail(fmt::format("the file states {} points; at most {} can be read", count, kCloudPointsMax));
  }
  if (count * each * 2 > words.left() + 1) {
    words.fail(
        fmt::format("the VTK file states {} rows of {} numbers, but only {} bytes follow; the file may be truncated",
                    count, each, words.left()));
  }
}

void read_points(VtkWords& words, Cloud& cloud) {
  if (!cloud.names.empty()) words.fail("POINTS occurs twice");
  cloud.points = words.whole("the number of points");
  words.need("the points' type");
  require_room(words, cloud.points, 3);
  cloud.names = {"x", "y", "z"};
  cloud.columns.assign(3, std::vector<double>(cloud.points));
  for (std::size_t i = 0; i < cloud.points; ++i) {
    for (std::vector<double>& column : cloud.columns) column[i] = words.number();
  }
}

void pass_over(VtkWords& words, std::uint64_t count, std::uint64_t each) {
  require_room(words, count, each);
  for (std::uint64_t i = 0; i < count * each; ++i) words.number();
}

void pass_vertices(VtkWords& words) {
  words.whole("the number of vertices");
  pass_over(words, words.whole("the vertices' numbers"), 1);
}

/// Reads the numbers after the lines "SCALARS name type [numbers per point]" and "LOOKUP_TABLE name".
void read_scalars(VtkWords& words, Cloud& cloud) {
  const std::string name(words.need("the name of scalars"));
  words.need("the scalars' type");
  std::uint64_t each = 1;
  std::string_view word = words.need("LOOKUP_TABLE");
  if (word != "LOOKUP_TABLE") {
    if (!read_number(word, each) || each < 1 || each > 4)
      words.fail(fmt::format("the scalars '{}' have '{}' numbers per point; they must have 1 to 4", shortened(name),
                             shortened(word)));
    word = words.need("LOOKUP_TABLE");
  }
  if (word != "LOOKUP_TABLE") words.fail("'" + shortened(word) + "' instead of LOOKUP_TABLE");
  words.need("the lookup table");
  if (each != 1) return pass_over(words, cloud.points, each);
  if (cloud.find(name) != nullptr)
    words.fail(fmt::format("the name of the scalars '{}' occurs twice; each name may occur once", shortened(name)));
  require_room(words, cloud.points, 1);
  std::vector<double> column(cloud.points);
  for (double& value : column) value = words.number();
  cloud.names.push_back(name);
  cloud.columns.push_back(std::move(column));
}

void pass_data(VtkWords& words, const Cloud& cloud, std::string_view section) {
  words.need("a name");
  if (section == "COLOR_SCALARS") {
    const std::uint64_t each = words.whole("a colour's size");
    if (each < 1 || each > 4)
      words.fail(fmt::format("the colours of the VTK file have {} numbers each; they must have 1 to 4", each));
    return pass_over(words, cloud.points, each);
  }
  words.need("a type");
  pass_over(words, cloud.points, section == "TENSORS" ? 9 : 3);
}

void read_header(VtkWords& words) {
  if (!words.line().starts_with("# vtk DataFile Version"))
    words.fail("the file does not begin with '# vtk DataFile Version', so it is not a VTK file");
  words.line();  // title
  const std::string_view encoding = words.need("ASCII");
  if (encoding == "BINARY") words.fail("the file is a binary VTK file; only text (ASCII) VTK files are supported");
  if (encoding != "ASCII") words.fail("'" + shortened(encoding) + "' instead of ASCII");
  if (words.need("DATASET") != "DATASET" || words.need("POLYDATA") != "POLYDATA")
    words.fail("the file has no POLYDATA dataset, which a point cloud needs");
}

}  // namespace

Cloud read_vtk(const std::filesystem::path& path) {
  VtkWords words(path);
  read_header(words);
  Cloud cloud;
  bool of_points = false;
  for (std::string_view section = words.next(); !section.empty(); section = words.next()) {
    if (section == "POINTS") {
      read_points(words, cloud);
    } else if (section == "VERTICES") {
      pass_vertices(words);
    } else if (section == "POINT_DATA") {
      const std::uint64_t points = words.whole("the point data");
      if (points != cloud.points)
        words.fail(fmt::format("the section POINT_DATA states {} points, but POINTS states {}; both must be equal",
                               points, cloud.points));
      of_points = true;
    } else if (of_points && section == "SCALARS") {
      read_scalars(words, cloud);
    } else if (of_points &&
               (section == "NORMALS" || section == "VECTORS" || section == "TENSORS" || section == "COLOR_SCALARS")) {
      pass_data(words, cloud, section);
    } else {
      words.fail(fmt::format("the section '{}' is not supported at this position of a VTK file", shortened(section)));
    }
  }
  if (cloud.names.empty()) words.fail("has no POINTS section");
  return cloud;
}

}  // namespace tumble::scenarios
