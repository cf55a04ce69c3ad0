// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/tables/imu_columns.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "scenarios/recordings/tables/logger_columns.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "sim/sensors.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

/// ImuPosition is the position of a second IMU relative to the first IMU, in the axes of the first IMU.
struct ImuPosition {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< standard deviation of each component
  std::size_t samples = 0;                            ///< number of samples with sufficient rotation
  std::string problem;                                ///< explains why the position is unknown; empty: known
};

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Rows = Eigen::Matrix<double, 3, 6>;

constexpr double kRateMin_rad_s = 2.5;      // slower rotation causes forces below the noise
constexpr double kUnsaturatedRatio = 0.98;  // of the largest reading of an axis
constexpr std::size_t kSamplesMin = 200;
constexpr double kSigmaMax_m = 2e-3;         // the estimators assume this accuracy of a position
constexpr double kRateDifferenceMax = 0.1;   // median difference of both gyros / rate; more: other axes
constexpr double kCorrelatedSamples = 10.0;  // vibration is correlated over about this number of samples
constexpr double kOutlierSigmas = 3.0;
constexpr int kRounds = 4;

struct Pair {
  Rows rows;            // derivative of the force difference with respect to position and bias
  Vector3d difference;  // specific force of the second IMU minus that of the first IMU
};

Vector3d largest_readings(const sim::ImuRecord& imu) {
  Vector3d out = Vector3d::Zero();
  for (const Vector3d& rate : imu.gyro_rad_s) out = out.cwiseMax(rate.cwiseAbs());
  return out;
}

/// Returns the equations of the position estimate for all samples with fast rotation and an unsaturated gyro.
/// `rate_difference` is an output: the median difference between the rates of both gyros, as a fraction of the rate.
std::vector<Pair> fast_pairs(const sim::ImuRecord& first, const sim::ImuRecord& second, double& rate_difference) {
  const Vector3d largest = kUnsaturatedRatio * largest_readings(first);
  std::vector<Pair> pairs;
  std::vector<double> differences;
  std::size_t after = 0;
  for (std::size_t k = 1; k + 1 < first.time_ns.size(); ++k) {
    const std::int64_t now = first.time_ns[k];
    while (after < second.time_ns.size() && second.time_ns[after] < now) ++after;
    if (after == second.time_ns.size()) break;
    const bool exact = second.time_ns[after] == now;
    const std::int64_t step_ns = first.time_ns[k + 1] - first.time_ns[k - 1];
    if (step_ns > 3 * first.period_ns || (!exact && after == 0)) continue;
    const std::size_t before = exact ? after : after - 1;
    const std::int64_t apart_ns = second.time_ns[after] - second.time_ns[before];
    if (apart_ns > 2 * second.period_ns) continue;
    const double share =
        exact ? 0.0 : static_cast<double>(now - second.time_ns[before]) / static_cast<double>(apart_ns);
    const auto at_time = [&](const std::vector<Vector3d>& values) -> Vector3d {
      return (1.0 - share) * values[before] + share * values[after];
    };
    const bool saturated = (first.gyro_rad_s[k - 1].cwiseAbs().array() > largest.array()).any() ||
                           (first.gyro_rad_s[k + 1].cwiseAbs().array() > largest.array()).any();
    const Vector3d& w = first.gyro_rad_s[k];
    if (saturated || w.norm() < kRateMin_rad_s) continue;
    const Vector3d a = (first.gyro_rad_s[k + 1] - first.gyro_rad_s[k - 1]) / (1e-9 * static_cast<double>(step_ns));
    Pair pair;
    pair.rows << so3::hat(a) + so3::hat(w) * so3::hat(w), Matrix3d::Identity();
    pair.difference = at_time(second.accel_m_s2) - first.accel_m_s2[k];
    pairs.push_back(pair);
    differences.push_back((at_time(second.gyro_rad_s) - w).norm() / w.norm());
  }
  rate_difference = differences.empty() ? 0.0 : upper_median(std::move(differences));
  return pairs;
}

/// Estimates the position p of a second IMU relative to the first IMU by least squares. The axes of the two IMUs must
/// have the same directions. At angular rate w and angular acceleration a, the specific forces of both IMUs differ by a
/// x p + w x (w x p) plus a bias. Samples near the largest gyro reading are omitted, because the gyro may be saturated.
/// Cost: O(N) for N samples.
ImuPosition estimate_imu_position(const sim::ImuRecord& first, const sim::ImuRecord& second) {
  ImuPosition out;
  double rate_difference = 0.0;
  const std::vector<Pair> pairs = fast_pairs(first, second, rate_difference);
  out.samples = pairs.size();
  if (pairs.size() < kSamplesMin) {
    out.problem = fmt::format(
        "only {} samples have a rate above {} rad/s without saturation; an estimate of the IMU's position needs {} "
        "such samples",
        pairs.size(), rounded(kRateMin_rad_s), kSamplesMin);
    return out;
  }
  if (rate_difference > kRateDifferenceMax) {
    out.problem = fmt::format(
        "the rates of both gyros differ by {} % (median); the maximum is {} %. The IMUs may have different axes",
        rounded(100.0 * rate_difference), rounded(100.0 * kRateDifferenceMax));
    return out;
  }
  Vector6d solution = Vector6d::Zero();
  Matrix6d inverse = Matrix6d::Identity();
  double variance = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    Matrix6d normal = Matrix6d::Zero();
    Vector6d right = Vector6d::Zero();
    double sum = 0.0, used = 0.0;
    for (const Pair& pair : pairs) {
      const Vector3d residual = pair.difference - pair.rows * solution;
      if (residual.squaredNorm() > 3.0 * kOutlierSigmas * kOutlierSigmas * variance) continue;
      normal += pair.rows.transpose() * pair.rows;
      right += pair.rows.transpose() * pair.difference;
      used += 1.0;
    }
    inverse = normal.ldlt().solve(Matrix6d::Identity());
    solution = inverse * right;
    for (const Pair& pair : pairs) {
      const double squared = (pair.difference - pair.rows * solution).squaredNorm();
      if (squared <= 3.0 * kOutlierSigmas * kOutlierSigmas * variance) sum += squared;
    }
    variance = sum / (3.0 * std::max(1.0, used));
  }
  out.position_m = solution.head<3>();
  out.sigma_m = (kCorrelatedSamples * variance * inverse.diagonal().head<3>()).cwiseMax(0.0).cwiseSqrt();
  if (!(out.sigma_m.maxCoeff() <= kSigmaMax_m))
    out.problem = fmt::format("the estimated position of this IMU has the standard deviation {} m; the maximum is {} m",
                              rounded(out.sigma_m.maxCoeff()), rounded(kSigmaMax_m));
  return out;
}

template <class Unit>
Unit chosen(std::optional<Unit> stated, Unit asked, Unit usual, const CsvLine& header) {
  if (!stated || *stated == asked) return asked;
  if (asked == usual) return *stated;
  throw BadInput(
      fmt::format("{}: the column names state rad/s and m/s^2, but an option states another unit; remove the option",
                  header.where));
}

Eigen::Vector3d vector(const CsvLine& line, const std::array<std::size_t, 3>& columns) {
  const auto number = [&](std::size_t column) { return csv_number(line, column, std::to_string(column)); };
  return {number(columns[0]), number(columns[1]), number(columns[2])};
}

std::string unit_of_stamps(int decimals) {
  return decimals == 9 ? "s" : decimals == 6 ? "ms" : decimals == 3 ? "us" : "ns";
}

void say_columns(const ImuColumns& columns, bool stated, std::vector<std::string>& notes) {
  if (columns.stamp_form != StampForm::decimal) return;
  if (!stated)
    notes.push_back(fmt::format("the import reads time stamps in {}, because this unit gives a plausible time step",
                                unit_of_stamps(*columns.stamp_decimals)));
  if (columns.gyro_unit == GyroUnit::deg_s)
    notes.push_back("the import reads angular rates in deg/s, as stated in the column names");
  if (columns.accel_unit == AccelUnit::g)
    notes.push_back("the import reads the specific force in g, as stated in the column names");
  std::string others;
  for (const std::string& name : columns.left_out) others += (others.empty() ? "" : ", ") + name;
  if (!others.empty()) notes.push_back("ignored columns: " + others);
}

/// A column with more than eight different numbers is assumed to contain row numbers instead of IMU numbers.
std::vector<std::string> imus_in(LoggedTable& table, std::size_t id) {
  constexpr std::size_t kImusMax = 8;
  std::vector<std::string> found;
  CsvLine line;
  while (found.size() <= kImusMax && table.next_sound(line)) {
    const std::string number(line.fields[id]);
    if (std::find(found.begin(), found.end(), number) == found.end()) found.push_back(number);
  }
  table.restart();
  if (found.size() < 2 || found.size() > kImusMax) found.clear();
  return found;
}

sim::ImuRecord readings_of(LoggedTable& table, const ImuColumns& columns, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit, LeftOut& left_out, std::vector<std::string>& places) {
  sim::ImuRecord imu = without_readings(device);
  CsvLine line;
  for (bool more = true; more;) {
    left_out.guard([&] {
      more = table.next(line);
      if (!more) return;
      add_reading(line.where, stamp_ns(line, columns), scale_of(gyro_unit) * vector(line, columns.rate),
                  scale_of(unit) * vector(line, columns.force), imu);
      places.push_back(line.where);
    });
  }
  return imu;
}

struct Units {
  AccelUnit accel;
  GyroUnit gyro;
};

sim::ImuRecord checked_readings(LoggedTable& table, const ImuColumns& columns, const sim::ImuRecord& device,
                                const std::string& path, const Units& units, std::vector<std::string>& notes) {
  LeftOut left_out("readings");
  std::vector<std::string> places;
  sim::ImuRecord imu = readings_of(table, columns, device, units.accel, units.gyro, left_out, places);
  const auto where = [&](std::size_t k) { return places[k]; };
  const std::string bursts = leave_out_faulty(where, nullptr, left_out, imu);
  finish_readings(path, units.accel, imu);
  const std::string evened = even_out_stamps(imu);
  for (const std::string& remark :
       {left_out.note(imu.time_ns.size()), bursts, evened, gaps_text(imu), rates_text(path, imu, units.gyro)})
    notes.push_back(remark);
  std::erase(notes, "");
  return imu;
}

template <class Read>
void add_further_imu(const Read& read, const std::vector<std::string>& imus, std::size_t i, Imported& out) {
  const std::vector<std::string> notes = out.notes;  // the notes on the first IMU hold for all IMUs
  std::string problem;
  try {
    sim::ImuRecord imu = read();
    const sim::ImuRecord& first = out.sensors.imus.front();
    const ImuPosition position = estimate_imu_position(first, imu);
    problem = position.problem;
    out.notes = notes;
    if (problem.empty()) {
      const Eigen::Vector3d& p = position.position_m;
      imu.T_BI.translation() += imu.T_BI.linear() * p;
      out.sensors.imus.push_back(std::move(imu));
      out.notes.push_back(
          fmt::format("the estimated position of IMU {} is {} {} {} m relative to IMU {} (standard deviation {} m, {} "
                      "samples). The import assumes that both IMUs have the same axes",
                      imus[i], rounded(p.x()), rounded(p.y()), rounded(p.z()), imus.front(),
                      rounded(position.sigma_m.maxCoeff()), position.samples));
    }
  } catch (const BadInput& error) {
    problem = error.what();
    out.notes = notes;
  }
  if (!problem.empty()) out.notes.push_back(fmt::format("caution: IMU {} is left out: {}", imus[i], problem));
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device, AccelUnit unit,
                        GyroUnit gyro_unit, const std::string& choice) {
  LoggedTable table(path);
  ImuColumns columns = choice.empty() ? imu_columns(table) : chosen_columns(table, choice);
  unit = chosen(columns.accel_unit, unit, AccelUnit::m_s2, table.header());
  gyro_unit = chosen(columns.gyro_unit, gyro_unit, GyroUnit::rad_s, table.header());
  Imported out;
  const std::vector<std::string> imus = columns.id ? imus_in(table, *columns.id) : std::vector<std::string>();
  if (!imus.empty()) table.keep(*columns.id, imus.front());
  if (columns.stamp_form == StampForm::decimal) {
    const bool stated = columns.stamp_decimals.has_value();
    if (!stated) columns.stamp_decimals = decimals_by_step(table, columns.stamp, path.string());
    say_columns(columns, stated, out.notes);
  }
  const auto read_imu = [&](const sim::ImuRecord& empty) {
    return checked_readings(table, columns, empty, path.string(), {unit, gyro_unit}, out.notes);
  };
  out.sensors.imus.push_back(read_imu(device));
  for (std::size_t i = 1; i < imus.size(); ++i) {
    table.restart();
    table.keep(*columns.id, imus[i]);
    sim::ImuRecord further = device;
    further.name = fmt::format("{}_{}", device.name, imus[i]);
    add_further_imu([&] { return read_imu(further); }, imus, i, out);
  }
  const std::int64_t first_ns = out.sensors.imus.front().time_ns.front();
  std::int64_t earliest_ns = first_ns;
  for (const sim::ImuRecord& imu : out.sensors.imus) earliest_ns = std::min(earliest_ns, imu.time_ns.front());
  for (sim::ImuRecord& imu : out.sensors.imus)
    for (std::int64_t& time : imu.time_ns) time -= earliest_ns;
  out.info.attribution =
      fmt::format("imported from {} (first time stamp: {} ns)", path.filename().string(), earliest_ns);
  out.info.origin_ns = earliest_ns;
  return out;
}

namespace {

std::vector<std::filesystem::path> tables_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string imu_problem(const std::filesystem::path& file) {
  try {
    imu_columns(LoggedTable(file));
    return "";
  } catch (const BadInput& error) {
    return error.what();
  }
}

}  // namespace

Imported import_csv_folder(const std::filesystem::path& folder, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit) {
  Imported out;
  std::vector<std::string> left_out;
  for (const std::filesystem::path& file : tables_in(folder)) {
    if (is_pose_table(file)) continue;  // a pose table is a reference
    if (const std::string problem = imu_problem(file); !problem.empty()) {
      left_out.push_back(fmt::format("the import leaves out a file that is not a table of IMU readings: {}", problem));
      continue;
    }
    Imported imu = import_imu_csv(file, device, unit, gyro_unit);
    imu.sensors.imus.front().name = file.stem().string();
    if (out.sensors.imus.empty())
      out = std::move(imu);
    else
      attach_imus(out, std::move(imu));
  }
  if (out.sensors.imus.empty())
    throw BadInput(fmt::format("{}: the folder must contain a table of IMU readings, but contains none{}",
                               folder.string(), (left_out.empty() ? "" : "; " + left_out.front())));
  if (out.sensors.imus.size() > 1)
    out.notes.push_back(
        fmt::format("IMU '{}' is the primary IMU, because its file comes first. Tables do not state the poses of the "
                    "IMUs on the body, so the import assumes that all IMUs have the same position and axes. To use one "
                    "IMU, import only the file of this IMU",
                    out.sensors.imus.front().name));
  out.notes.insert(out.notes.end(), left_out.begin(), left_out.end());
  return out;
}

}  // namespace tumble::scenarios
