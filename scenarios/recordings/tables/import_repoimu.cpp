// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "scenarios/recordings/tables/repeated_readings.hpp"
#include "scenarios/recordings/tables/steady_stamps.hpp"
#include "scenarios/recordings/trajectories/align_reference.hpp"
#include "scenarios/recordings/trajectories/reference_check.hpp"
#include "scenarios/recordings/trajectories/reference_glitches.hpp"
#include "scenarios/recordings/trajectories/reference_rate.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kRepoimuAttribution =
    "RepoIMU: A. Szczesna, P. Skurowski, P. Pruszowski, D. Peszor, M. Paszkuta, K. Wojciechowski: Reference Data Set "
    "for Accuracy Evaluation of Orientation Estimation Algorithms for Inertial Motion Capture Systems, ICCVG 2016; ";

constexpr double kBadNormShareMax = 0.2;
constexpr double kRepoimuStampMax_s = 86400.0;
/// The kDigitsReach rows before and after a row determine the precision of its time stamp.
constexpr std::size_t kDigitsReach = 50;
constexpr double kCoarse = 0.02;  // fraction of a step above which coarse printing is noted

/// RepoimuColumns contains the positions of the columns, by group.
struct RepoimuColumns {
  std::size_t time = 0;
  std::array<std::size_t, 4> attitude{};  ///< w x y z
  std::array<std::size_t, 3> force{}, rate{};
  std::size_t count = 0;    ///< of the header
  bool open_ended = false;  ///< the header ends in a separator, rows may not
};

struct Log {
  LoggedReadings readings;
  std::vector<ReferencePose> poses;
  std::vector<StampBounds> rounding;  ///< of the printed stamps
  std::size_t decimal_commas = 0;
  std::vector<std::string> where;
  LeftOut left_out{"readings"};
};

/// Returns column names such as "Vicon Orientation/W"; the name of a group is above the first column of the group.
std::vector<std::string> column_names(const CsvLine& groups, const CsvLine& names) {
  if (groups.fields.size() != names.fields.size()) {
    fail(names, fmt::format("this line has {} columns, but the line above has {}; the numbers must be equal",
                            names.fields.size(), groups.fields.size()));
  }
  std::vector<std::string> full;
  std::string group;
  for (std::size_t i = 0; i < groups.fields.size(); ++i) {
    if (!groups.fields[i].empty()) group = std::string(groups.fields[i]);
    full.push_back(group.starts_with("Time") ? "Time" : group + "/" + std::string(names.fields[i]));
  }
  return full;
}

RepoimuColumns columns_of(const CsvLine& groups, const CsvLine& second) {
  std::vector<std::string> names = column_names(groups, second);
  RepoimuColumns columns;
  columns.count = names.size();
  columns.open_ended = groups.fields.back().empty() && second.fields.back().empty();
  if (columns.open_ended) names.pop_back();
  std::string missing;
  const auto take = [&](const std::string& name, std::size_t& place) {
    const auto count = std::count(names.begin(), names.end(), name);
    if (count > 1) fail(second, fmt::format("two columns have the name {}", name));
    if (count == 0) missing += " '" + name + "'";
    const auto found = std::find(names.begin(), names.end(), name);
    place = static_cast<std::size_t>(found - names.begin());
    if (found != names.end()) *found = "";  // used
  };
  take("Time", columns.time);
  for (std::size_t i = 0; i < 4; ++i) take(std::string("Vicon Orientation/") + "WXYZ"[i], columns.attitude[i]);
  for (std::size_t i = 0; i < 3; ++i) take(std::string("IMU Acceleration/") + "XYZ"[i], columns.force[i]);
  for (std::size_t i = 0; i < 3; ++i) take(std::string("IMU Gyroscope/") + "XYZ"[i], columns.rate[i]);
  if (!missing.empty()) fail(second, "missing columns:" + missing);
  for (const std::string& name : names) {
    const bool magnetic = name.starts_with("IMU Magnetometer/") && name.size() == 18 && name.back() >= 'X';
    if (!name.empty() && !magnetic) fail(second, "unknown column '" + name + "'");
  }
  return columns;
}

/// DecimalNumbers accepts a decimal comma, which one published file contains; with the separator ';', a decimal comma
/// is unambiguous.
class DecimalNumbers {
 public:
  DecimalNumbers(const CsvLine& line, std::size_t& commas) : line_(line), commas_(commas) {}
  double at(std::size_t column, const char* name) {
    const std::string_view text = line_.fields[column];
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return csv_number(line_, column, name);
    if (text.find('.') != std::string_view::npos || text.find(',', comma + 1) != std::string_view::npos)
      return csv_number(line_, column, name);  // throws
    std::string pointed(text);
    pointed[comma] = '.';
    ++commas_;
    return csv_number({line_.where, {pointed}}, 0, name);
  }
  Eigen::Vector3d at(const std::array<std::size_t, 3>& columns, const char* name) {
    return {at(columns[0], name), at(columns[1], name), at(columns[2], name)};
  }
  /// Returns the number in a column, or NaN for a missing value, which occurs where the cameras saw no markers.
  double or_unknown(std::size_t column, const char* name) {
    const std::string_view text = line_.fields[column];
    if (text.empty() || text == "NaN" || text == "nan") return kNaN;
    return at(column, name);
  }

 private:
  const CsvLine& line_;
  std::size_t& commas_;
};

/// Returns the number of decimals in the text of a number.
int decimals(std::string_view text) {
  const std::size_t point = text.find('.');
  return point == std::string_view::npos ? 0 : static_cast<int>(text.size() - point - 1);
}

/// Returns the largest rounding error of the time stamp in each row: half of its last decimal, from the rows around it.
std::vector<StampBounds> rounding_of(const std::vector<int>& decimals) {
  std::vector<StampBounds> bounds;
  for (std::size_t k = 0; k < decimals.size(); ++k) {
    const std::size_t first = k > kDigitsReach ? k - kDigitsReach : 0;
    const std::size_t last = std::min(k + kDigitsReach, decimals.size() - 1);
    const int most = *std::max_element(decimals.begin() + static_cast<std::ptrdiff_t>(first),
                                       decimals.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const auto half = std::llround(0.5e9 * std::pow(10.0, -most));
    bounds.push_back({half, half});
  }
  return bounds;
}

void add_row(const CsvLine& line, const RepoimuColumns& columns, Log& log, std::vector<int>& digits) {
  const std::size_t found = line.fields.size();
  const bool trailing = columns.open_ended && found == columns.count && line.fields.back().empty();
  if (found != columns.count - (columns.open_ended ? 1 : 0) && !trailing) {
    fail(line,
         fmt::format("this line has {} columns; it must have {}", found, columns.count - (columns.open_ended ? 1 : 0)));
  }
  DecimalNumbers numbers(line, log.decimal_commas);
  const double time_s = numbers.at(columns.time, "Time");
  if (!(time_s >= 0.0 && time_s <= kRepoimuStampMax_s))
    fail(line, fmt::format("Time is {} s; it must be within 0 and {}", time_s, kRepoimuStampMax_s));
  const std::int64_t time_ns = std::llround(time_s * 1e9);
  if (!log.readings.time_ns.empty() && time_ns < log.readings.time_ns.back()) {
    fail(line, fmt::format("Time decreases: {:.9g} s follows {:.9g} s; Time must increase", time_s,
                           1e-9 * static_cast<double>(log.readings.time_ns.back())));
  }
  const auto& a = columns.attitude;
  const char* attitude = "Vicon Orientation";
  const ReferencePose pose{time_ns,
                           Eigen::Vector3d::Constant(kNaN),
                           {numbers.or_unknown(a[0], attitude), numbers.or_unknown(a[1], attitude),
                            numbers.or_unknown(a[2], attitude), numbers.or_unknown(a[3], attitude)}};
  const Eigen::Vector3d force = numbers.at(columns.force, "IMU Acceleration"),
                        rate = numbers.at(columns.rate, "IMU Gyroscope");
  log.poses.push_back(pose);
  log.readings.time_ns.push_back(time_ns);
  log.readings.accel_m_s2.push_back(force);
  log.readings.gyro_rad_s.push_back(rate);
  log.where.push_back(line.where);
  digits.push_back(decimals(line.fields[columns.time]));
}

Log read_log(const std::filesystem::path& path) {
  CsvText text(path, ';');
  CsvLine groups, line;
  text.next(groups);
  if (!text.next(line)) throw BadInput(fmt::format("{}: the file ends within its header", path.string()));
  const RepoimuColumns columns = columns_of(groups, line);
  Log log;
  std::vector<int> digits;
  while (text.next(line)) log.left_out.guard([&] { add_row(line, columns, log, digits); });
  log.left_out.require_few(log.where.size());
  log.rounding = rounding_of(digits);
  return log;
}

/// Replaces the time stamps by regular times, with a note if the file contains too few decimals.
void steady(Log& log, std::vector<std::string>& notes) {
  const std::vector<std::int64_t> printed = log.readings.time_ns;
  log.readings.time_ns = steady_stamps(printed, log.rounding);
  const auto mean_step = (printed.back() - printed.front()) / static_cast<std::int64_t>(printed.size() - 1);
  std::int64_t most_ns = 0, equal = 0;
  for (std::size_t k = 0; k < printed.size(); ++k) {
    const std::int64_t time_ns = log.readings.time_ns[k];
    most_ns = std::max<std::int64_t>(most_ns, std::abs(time_ns - printed[k]));
    if (k == 0) continue;
    const bool same = printed[k] == printed[k - 1];
    equal += same ? 1 : 0;
    // Time stamps with enough decimals do not repeat because of rounding.
    const bool coarse = 2 * (log.rounding[k].before_ns + log.rounding[k].after_ns) >= mean_step;
    if (time_ns <= log.readings.time_ns[k - 1] || (same && !coarse)) {
      throw BadInput(fmt::format("{}: Time must increase, but {:.9g} s occurs more often than its rounding explains",
                                 log.where[k], 1e-9 * static_cast<double>(printed[k])));
    }
  }
  for (std::size_t k = 0; k < printed.size(); ++k) log.poses[k].time_ns = log.readings.time_ns[k];
  const auto span = static_cast<double>(printed.back() - printed.front());
  if (static_cast<double>(most_ns) > kCoarse * span / static_cast<double>(printed.size() - 1)) {
    notes.push_back(fmt::format(
        "the time stamps are rounded to {} ms; the import replaces them by equally spaced times, with shifts of up to "
        "{:.1f} ms ({} time stamps were equal to their predecessor)",
        2e-6 * static_cast<double>(log.rounding.back().before_ns), 1e-6 * static_cast<double>(most_ns), equal));
  }
}

void require_attitudes(const std::filesystem::path& path, const Log& log) {
  std::size_t bad = 0, first = 0;
  for (std::size_t k = 0; k < log.poses.size(); ++k) {
    if (!(std::abs(log.poses[k].q_WA.norm() - 1.0) > kReferenceNormTolerance)) continue;
    if (bad++ == 0) first = k;
  }
  if (static_cast<double>(bad) <= kBadNormShareMax * static_cast<double>(log.poses.size())) return;
  throw BadInput(
      fmt::format("{}: the quaternion's norm is {:.4f}; it must be 1 within 1 %. This error affects {} of {} in {}; at "
                  "most a fifth may have the error",
                  log.where[first], log.poses[first].q_WA.norm(), bad, log.poses.size(), path.filename().string()));
}

/// Describes the errors of the reference rates at samples where all gyro axes are far from their extreme readings.
std::string rate_error_text(const sim::ImuRecord& imu, const std::vector<Eigen::Vector3d>& rates) {
  Eigen::Vector3d extreme = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& w : imu.gyro_rad_s) extreme = extreme.cwiseMax(w.cwiseAbs());
  std::vector<double> errors;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const bool free = (imu.gyro_rad_s[k].cwiseAbs().array() < 0.9 * extreme.array()).all();
    if (free && rates[k].allFinite() && imu.gyro_rad_s[k].norm() > 0.5)
      errors.push_back((rates[k] - imu.gyro_rad_s[k]).norm());
  }
  if (errors.empty()) return "";
  std::sort(errors.begin(), errors.end());
  return fmt::format(
      "reference: in motion, the rates of the reference (from attitudes over +-{} ms) differ from the unclipped gyro "
      "by {:.3f} rad/s (median) and {:.3f} rad/s (90th percentile), over {} samples",
      kRateWindow_ns / 1'000'000, errors[errors.size() / 2], errors[errors.size() * 9 / 10], errors.size());
}

/// Adds the optical reference as the truth of the recording.
void add_reference(const std::filesystem::path& path, Log& log, bool align, Imported& out) {
  const sim::ImuRecord& imu = out.sensors.imus.front();
  const std::size_t samples = log.poses.size();
  const GlitchReport glitches = leave_out_glitches(log.poses);
  out.notes.push_back(glitches.text(samples));
  if (log.poses.size() < 2) {
    out.notes.push_back("the reference has no valid samples and is left out");
    return;
  }
  const ReferenceAlignment alignment = align_reference(log.poses, imu);
  if (alignment.known && align) apply(alignment, log.poses);
  if (!alignment.known && align) throw BadInput(path.string() + ": --align-reference: " + alignment.text());
  out.notes.push_back(alignment.text() +
                      (align             ? "; the import removes this misalignment"
                       : alignment.known ? "; the import keeps this misalignment (set --align-reference to remove it)"
                                         : ""));
  out.notes.push_back(check_reference(log.poses, Eigen::Isometry3d::Identity(), out.sensors, path.string()));
  try {
    out.reference = reference_truth(log.poses, imu.time_ns.back());
  } catch (const BadInput& error) {
    throw BadInput(path.string() + ": " + error.what());
  }
  sim::ImuTruth truth;
  truth.name = imu.name;
  truth.rate_rad_s = reference_rates(log.poses, imu.time_ns);
  const std::string error = rate_error_text(imu, truth.rate_rad_s);
  if (!error.empty()) out.notes.push_back(error);
  out.reference->imus.push_back(std::move(truth));
}

}  // namespace

bool is_repoimu(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  return std::getline(stream, line) && line.starts_with("Time") &&
         line.find(";Vicon Orientation;") != std::string::npos;
}

Imported import_repoimu(const std::filesystem::path& path, bool align) {
  Log log = read_log(path);
  Imported out;
  sim::ImuRecord imu;
  imu.name = "imu";
  if (log.where.size() < 2)
    throw BadInput(fmt::format("{}: the file has {} samples; it needs at least 2", path.string(), log.where.size()));
  require_attitudes(path, log);
  if (log.left_out.count() > 0) out.notes.push_back(log.left_out.note(log.where.size()));
  out.info.origin_ns = log.readings.time_ns.front();
  for (std::int64_t& time : log.readings.time_ns) time -= out.info.origin_ns;
  steady(log, out.notes);
  // Time 0 is the first stamp in the file, instead of the corrected time of the first sample.
  const std::int64_t first_ns = log.readings.time_ns.front();
  for (std::int64_t& time : log.readings.time_ns) time -= first_ns;
  for (ReferencePose& pose : log.poses) pose.time_ns -= first_ns;
  out.info.origin_ns += first_ns;
  const RepeatReport hold = remove_repeats(log.readings, imu);
  if (!hold.text().empty()) out.notes.push_back(hold.text());
  finish_readings(path.string(), AccelUnit::m_s2, imu);
  for (const std::string& note :
       {require_plausible_rates(path.string(), imu, GyroUnit::rad_s), accel_rail_text(log.readings.accel_m_s2)}) {
    if (!note.empty()) out.notes.push_back(note);
  }
  if (log.decimal_commas > 0)
    out.notes.push_back(fmt::format("{} numbers have a decimal comma; the import reads the comma as a decimal point",
                                    log.decimal_commas));
  out.notes.push_back("the import leaves out the columns of the magnetometer, because they have no unit");
  out.info.attribution = kRepoimuAttribution + path.filename().string();
  out.sensors.imus.push_back(std::move(imu));
  add_reference(path, log, align, out);
  std::string problem = find_problem(out.sensors);
  if (problem.empty() && out.reference) problem = find_problem(*out.reference);
  if (!problem.empty()) throw BadInput(path.string() + ": " + problem);
  return out;
}

}  // namespace tumble::scenarios
