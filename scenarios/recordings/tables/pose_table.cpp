// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"

namespace tumble::scenarios {

namespace {

std::string plain(std::string_view field) {
  std::string out;
  for (const char c : field.substr(0, field.find_first_of("[(")))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_position(const std::string& name, char axis) {
  for (const char* stem : {"", "t", "p", "pos", "prsr"})
    if (name == std::string(stem) + axis) return true;
  return name == std::string(1, axis) + "wm" || name.ends_with(std::string("position") + axis) ||
         name.ends_with(std::string("translation") + axis);
}

bool is_quaternion(const std::string& name, char axis) {
  for (const char* stem : {"q", "qrs"})
    if (name == std::string(stem) + axis) return true;
  for (const char* stem : {"orientation", "rotation", "quaternion"})
    if (name.ends_with(std::string(stem) + axis)) return true;
  return false;
}

struct PoseColumns {
  std::size_t time = 0;
  std::optional<std::size_t> nanoseconds;  ///< for seconds and nanoseconds
  bool time_in_ns = false;                 ///< the column name states ns
  std::array<std::size_t, 3> position{};
  std::array<std::size_t, 4> quaternion{};  ///< x y z w
};

class PoseHeader {
 public:
  explicit PoseHeader(const CsvLine& header) : header_(header) {
    for (const std::string_view field : header.fields) names_.push_back(plain(field));
  }

  template <class Fits>
  std::optional<std::size_t> find(const Fits& fits) const {
    const auto found = std::find_if(names_.begin(), names_.end(), fits);
    if (found == names_.end()) return std::nullopt;
    const auto again = std::find_if(found + 1, names_.end(), fits);
    const auto at = static_cast<std::size_t>(found - names_.begin());
    if (again != names_.end())
      fail(header_,
           fmt::format("two columns of the pose table have the same meaning, '{}' and '{}'; remove one of them",
                       header_.fields[at], header_.fields[static_cast<std::size_t>(again - names_.begin())]));
    return at;
  }

  template <class Fits>
  void take(const Fits& fits, const std::string& called, std::size_t& column) {
    if (const auto found = find(fits))
      column = *found;
    else
      missing_ += " " + called;
  }

  void take_time(PoseColumns& columns) {
    const auto ends = [](std::vector<std::string> endings) {
      return [endings = std::move(endings)](const std::string& name) {
        return std::any_of(endings.begin(), endings.end(), [&](const auto& each) { return name.ends_with(each); });
      };
    };
    const auto seconds = find(ends({"stampsec", "stampsecs"}));
    columns.nanoseconds = find(ends({"stampnsec", "stampnsecs", "stampnanosec"}));
    if (seconds && columns.nanoseconds) {
      columns.time = *seconds;
      return;
    }
    columns.nanoseconds = std::nullopt;
    auto time = find(ends({"headerstamp"}));
    if (!time)
      time = find([](const std::string& name) {
        return name == "t" || name == "ts" || name == "time" || name == "timestamp" || name == "stamp" ||
               name == "timens" || name == "timestampns" || name == "times" || name == "timestamps";
      });
    if (!time) {
      missing_ += " time";
      return;
    }
    columns.time = *time;
    const std::string_view field = header_.fields[*time];
    columns.time_in_ns =
        field.starts_with("field.") || field.find("[ns]") != std::string_view::npos || names_[*time].ends_with("ns");
  }

  const std::string& missing() const { return missing_; }

 private:
  const CsvLine& header_;
  std::vector<std::string> names_;
  std::string missing_;
};

PoseColumns columns_of(const CsvLine& header, std::string& missing) {
  PoseColumns columns;
  PoseHeader names(header);
  names.take_time(columns);
  for (std::size_t k = 0; k < 3; ++k) {
    const char axis = "xyz"[k];
    names.take([&](const std::string& name) { return is_position(name, axis); }, std::string("position ") + axis,
               columns.position[k]);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const char axis = "xyzw"[k];
    names.take([&](const std::string& name) { return is_quaternion(name, axis); }, std::string("quaternion ") + axis,
               columns.quaternion[k]);
  }
  missing = names.missing();
  return columns;
}

std::int64_t whole_of(const CsvLine& line, std::size_t column, std::int64_t most) {
  const auto value = parse_time_ns(line.fields[column], 0);
  if (!value || *value < 0 || *value > most)
    fail(line, fmt::format("column {} must contain a whole number from 0 to {}, but contains '{}'", column, most,
                           line.fields[column]));
  return *value;
}

std::int64_t time_of(const CsvLine& line, const PoseColumns& columns) {
  if (columns.nanoseconds)
    return whole_of(line, columns.time, kSecondsMax) * kSecond_ns +
           whole_of(line, *columns.nanoseconds, kSecond_ns - 1);
  const std::string_view text = line.fields[columns.time];
  const auto time_ns = columns.time_in_ns ? parse_time_ns(text, 0) : parse_stamp_ns(text);
  if (!time_ns) fail(line, fmt::format("column {} must contain a time, but contains '{}'", columns.time, text));
  return *time_ns;
}

double number_of(const CsvLine& line, std::size_t column) {
  double value = 0.0;
  if (!parse_number(line.fields[column], value))
    fail(line, fmt::format("column {} must contain a number, but contains '{}'", column, line.fields[column]));
  return value;
}

}  // namespace

bool is_pose_table(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  try {
    const LoggedTable table(file);
    std::string missing;
    if (table.has_header()) columns_of(table.header(), missing);
    return table.has_header() && missing.empty();
  } catch (const BadInput&) {
    return false;  // another reader reports the fault
  }
}

std::vector<ReferencePose> read_pose_table(const std::filesystem::path& file, bool sorted) {
  LoggedTable table(file);
  std::string missing;
  const PoseColumns columns = columns_of(table.header(), missing);
  if (!missing.empty()) fail(table.header(), "missing columns:" + missing);
  std::vector<ReferencePose> poses;
  CsvLine line;
  while (table.next(line)) {
    ReferencePose pose;
    pose.time_ns = time_of(line, columns);
    for (Eigen::Index i = 0; i < 3; ++i)
      pose.p_WA_m[i] = number_of(line, columns.position[static_cast<std::size_t>(i)]);
    for (Eigen::Index i = 0; i < 4; ++i)
      pose.q_WA.coeffs()[i] = number_of(line, columns.quaternion[static_cast<std::size_t>(i)]);
    if (is_unknown(pose)) continue;
    const std::string problem = problem_of(pose, sorted || poses.empty() ? nullptr : &poses.back());
    if (!problem.empty()) fail(line, problem);
    poses.push_back(pose);
  }
  finish_poses(file, sorted, poses);
  return poses;
}

}  // namespace tumble::scenarios
