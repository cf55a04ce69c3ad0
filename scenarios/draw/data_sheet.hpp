// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

struct DataSheet {
  struct Entry {
    std::string name;
    double value;
    std::string unit;
    std::string source;
  };
  std::string device;       ///< "mti30"
  std::string title;        ///< "Xsens MTi-30 AHRS"
  std::string sensor_kind;  ///< "imu", "spinning_lidar", "rosette_lidar"
  std::vector<Entry> entries;
  sim::Values values() const;
};

std::vector<std::string> device_names(const DataRoot& data);
DataSheet load_data_sheet(const DataRoot& data, const std::string& device);

}  // namespace tumble::scenarios
