// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

/// node_params.hpp defines the parameters of the nodes. The C++ nodes and the Python node declare their parameters from
/// these descriptions, so no parameter is described twice.
namespace tumble::ros {

/// AdapterParams contains the parameters of both adapters.
struct AdapterParams {
  double diagnostics_period_s = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.diagnostics_period_s, {"diagnostics_period_s", "s", 0.1, 1e6,
                                   "time between two publications of the diagnostics, by the stamps of the IMU",
                                   ParameterAudience::common_use});
  }
};

/// Parameters of TumblingAdapter.
struct TumblingAdapterParams {
  TumblingParams odometry;                                     ///< T_IL is set from T_BI and T_BL
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();      ///< pose of the IMU in the base frame
  Eigen::Isometry3d T_BL = Eigen::Isometry3d::Identity();      ///< pose of the lidar in the base frame
  Eigen::Vector3d position_arm_B_m = Eigen::Vector3d::Zero();  ///< position of the antenna, in the base frame
  std::string time_field;                                      ///< see PointCloudReader
  double map_period_s = 5.0;
  bool prior_map_extend = true;  ///< see PriorMap::extend
  AdapterParams adapter;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.odometry);
    visit(p.map_period_s,
          {"map_period_s", "s", 0.1, 1e6, "time between two publications of the map, by the stamps of the IMU",
           ParameterAudience::common_use});
    visit(p.prior_map_extend,
          {"prior_map_extend", "1", 0, 1, "true: sweeps extend the prior map; false: the prior map stays unchanged",
           ParameterAudience::common_use});
    visit.group("", p.adapter);
  }
  static std::span<const char* const> computed_parameter_names() {
    return TumblingParams::Expert::computed_parameter_names();
  }
};

/// RollingAdapterParams contains the parameters of RollingAdapter. The base frame is the frame of the sphere, with its
/// origin in the sphere's centre.
struct RollingAdapterParams {
  RollingOdometry::Params odometry;
  AdapterParams adapter;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.odometry);
    visit.group("", p.adapter);
  }
  static std::span<const char* const> computed_parameter_names() {
    return RollingOdometry::Params::computed_parameter_names();
  }
};

/// Calls `each(name, value, field)` for each number that a node declares as a parameter.
template <class Params, class Each>
void visit_parameters(Params& params, Each each) {
  const auto derived = std::remove_cv_t<Params>::computed_parameter_names();
  for_each_parameter(params, [&](const std::string& name, auto& value, const ParameterInfo& field) {
    if (!matches_any_pattern(std::string_view(name), derived)) each(name, value, field);
  });
}

/// TextParameter describes a parameter of a node that is a text or, if `count` is above 0, a list of numbers.
struct TextParameter {
  const char* name;
  const char* value;  ///< default of a text
  int count;          ///< length of the list; the default list is empty
  const char* meaning;
  bool at_start = true;  ///< false: the node reads the parameter at each call of a service
};

/// Returns the text and list parameters of both nodes.
std::span<const TextParameter> text_parameters();

/// Converts x, y, z in metres and the quaternion qx, qy, qz, qw to a pose. The seven numbers must be finite, and the
/// quaternion must have length 1 within 1e-3. Otherwise, throws InvalidParams with the name of the parameter.
Eigen::Isometry3d pose_of(const std::string& parameter, std::span<const double> numbers);

/// Converts the smallest and the largest corner to a box; no numbers give an empty box. Throws InvalidParams with the
/// name of the parameter if the count of numbers is wrong.
Eigen::AlignedBox3d box_of(const std::string& parameter, std::span<const double> numbers);

/// Converts three numbers to a position; no numbers give zero. Throws InvalidParams with the name of the parameter if
/// the count of numbers is wrong.
Eigen::Vector3d position_of(const std::string& parameter, std::span<const double> numbers);

/// Returns the data sheet with this name, or the default sheet for an empty name. Throws InvalidParams for an unknown
/// name, with a list of all known names.
ImuDataSheet imu_sheet(const std::string& name);
LidarDataSheet lidar_sheet(const std::string& name);

}  // namespace tumble::ros
