// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/import.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios::fixture {

/// A BagKind is a kind of bag; the tests are the same for all kinds.
struct BagKind {
  const char* name;
  void (*write)(const sim::Sensors&, const BagWriting&, const fs::path&);
  Imported (*read)(const fs::path&, const BagReading&);
  std::unique_ptr<BagReader> (*open)(const fs::path&) = nullptr;
  std::unique_ptr<BagWriter> (*writer)(const fs::path&) = nullptr;
  const char* livox_type = "livox_ros_driver2/CustomMsg";  ///< type name in ROS 1
};

inline constexpr BagKind kRos1 = {"Ros1",        export_ros1_bag,  import_ros1_bag,
                                  open_ros1_bag, make_ros1_writer, "livox_ros_driver/CustomMsg"};
inline constexpr BagKind kRos2 = {"Ros2", export_ros2_bag, import_ros2_bag, open_ros2_bag, make_ros2_writer};
inline constexpr BagKind kMcap = {"Mcap", export_mcap, import_mcap,
                                  [](const fs::path& file) { return open_mcap({file}); }, make_mcap_writer};

inline std::string name_of(const ::testing::TestParamInfo<BagKind>& kind) {
  return kind.param.name;
}

}  // namespace tumble::scenarios::fixture
