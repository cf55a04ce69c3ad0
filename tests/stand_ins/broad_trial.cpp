// SPDX-License-Identifier: BSD-3-Clause
#include "stand_ins/broad_trial.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "stand_ins/stand_ins.hpp"
#include "tests/tree.hpp"
#include "tumble/common/types.hpp"

namespace tumble::testing {

namespace {

constexpr TimeNs kPeriod_ns = 3'500'000;  // 1 / 285.714 Hz

/// A Table is the row-major table of a data set, as doubles.
struct Table {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
  double operator()(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

Table read_table(hid_t file, const char* name) {
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0) throw std::runtime_error(std::string("no data set ") + name);
  const hid_t space = H5Dget_space(set);
  hsize_t shape[2] = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank == 1 || rank == 2) H5Sget_simple_extent_dims(space, shape, nullptr);
  Table table{shape[0], shape[1], std::vector<double>(shape[0] * shape[1])};
  const herr_t read = H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.values.data());
  H5Sclose(space);
  H5Dclose(set);
  if (read < 0 || table.rows == 0) throw std::runtime_error(std::string("cannot read ") + name);
  return table;
}

BroadTrial assemble(const Table& gyr, const Table& acc, const Table& quat, const Table& movement) {
  const std::size_t count = gyr.rows;
  if (gyr.columns != 3 || acc.columns != 3 || quat.columns != 4 || acc.rows != count || quat.rows != count ||
      movement.values.size() != count) {
    throw std::runtime_error("unexpected shapes");
  }
  BroadTrial trial;
  for (std::size_t k = 0; k < count; ++k) {
    trial.samples.push_back(
        {static_cast<TimeNs>(k) * kPeriod_ns, {gyr(k, 0), gyr(k, 1), gyr(k, 2)}, {acc(k, 0), acc(k, 1), acc(k, 2)}, 0});
    trial.q_ref.emplace_back(quat(k, 0), quat(k, 1), quat(k, 2), quat(k, 3));
    trial.moving.push_back(movement.values[k] != 0.0);
  }
  return trial;
}

/// Returns the angle about the vertical nearest to the rotation e, in (-pi, pi].
double heading(const Eigen::Quaterniond& e) {
  return 2.0 * std::atan(e.z() / e.w());
}

double inclination(const Eigen::Quaterniond& e) {
  return 2.0 * std::asin(std::min(1.0, std::hypot(e.x(), e.y())));
}

struct MeanSquare {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double value) { sum += value * value, ++count; }
  double root_deg() const {
    if (count == 0) throw std::runtime_error("no sample to score");
    return std::sqrt(sum / static_cast<double>(count)) * 180.0 / std::numbers::pi;
  }
};

}  // namespace

std::vector<std::string> broad_trials() {
  std::vector<std::string> numbers = {test::kStandInTrial};
  if (!broad_folder().empty()) numbers.insert(numbers.end(), {"05", "07", "09", "11", "14", "16", "24", "27"});
  return numbers;
}

std::vector<std::string> few_broad_trials() {
  std::vector<std::string> numbers = {test::kStandInTrial};
  if (!broad_folder().empty()) numbers.insert(numbers.end(), {"05", "14"});
  return numbers;
}

std::string broad_folder() {
  const std::filesystem::path folder = test::shared_data() / "broad";
  return std::filesystem::is_directory(folder) ? folder.string() : std::string();
}

BroadTrial read_broad_trial(const std::string& folder, const std::string& number) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.path().filename().string().starts_with(number + "_")) continue;
    const hid_t file = H5Fopen(entry.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) throw std::runtime_error("cannot open " + entry.path().string());
    const BroadTrial trial = assemble(read_table(file, "imu_gyr"), read_table(file, "imu_acc"),
                                      read_table(file, "opt_quat"), read_table(file, "movement"));
    H5Fclose(file);
    return trial;
  }
  throw std::runtime_error("no trial " + number + " in " + folder);
}

BroadTrial read_broad_trial(const std::string& number) {
  if (number != test::kStandInTrial) return read_broad_trial(broad_folder(), number);
  return read_broad_trial(test::written(test::data_folders("broad").front()).string(), number);
}

BroadError score(const BroadTrial& trial, const std::vector<Eigen::Quaterniond>& q_WI) {
  if (q_WI.size() != trial.q_ref.size()) throw std::runtime_error("one attitude per sample is needed");
  MeanSquare inclination_motion, heading_motion, inclination_rest;
  Eigen::Quaterniond align = Eigen::Quaterniond::Identity();
  bool aligned = false;
  for (std::size_t k = 0; k < q_WI.size(); ++k) {
    if (!trial.q_ref[k].coeffs().allFinite()) continue;
    Eigen::Quaterniond e = align * q_WI[k] * trial.q_ref[k].conjugate();
    if (!aligned) {
      align = so3::exp({0.0, 0.0, -heading(e)});
      e = align * e;
      aligned = true;
    }
    if (trial.moving[k]) {
      inclination_motion.add(inclination(e));
      heading_motion.add(heading(e));
    } else {
      inclination_rest.add(inclination(e));
    }
  }
  return {inclination_motion.root_deg(), heading_motion.root_deg(), inclination_rest.root_deg()};
}

}  // namespace tumble::testing
