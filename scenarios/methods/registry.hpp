// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

/// A new method needs a source file that defines `Method KIND_NAME()`, a declaration in registry.hpp, a line in
/// registry.cpp, and a line in CMakeLists.txt.
namespace tumble::scenarios {

using RunCore = Estimate (*)(const sim::Sensors&, const sim::Values& parameters, const OracleInput& oracle);

Method make_method(MethodInfo info, RunCore run);

/// Returns a RunMethod function that checks the parameter values, adds the default values of `info.settings`, and calls
/// `run`. The RunMethod function throws BadInput if a parameter is invalid.
RunMethod with_settings(const MethodInfo& info, RunMethod run);

std::span<const Method> methods();

/// `name` is the name of methods of all kinds ("saave"), of one method ("rate/oracle"), or of an external method
/// (NAME.yaml or NAME.py).
std::vector<MethodPointer> find_methods(const std::string& name);
std::vector<MethodPointer> find_methods(std::span<const std::string> names);
bool is_method_file(const std::string& name);

std::vector<MethodPointer> find_methods_within(std::span<const std::string> names, double time_limit_s);

Method rate_raw();
Method rate_interpolate();
Method rate_saave();
Method rate_tumble();
Method rate_oracle();
Method attitude_integrate();
Method attitude_madgwick();
Method attitude_complementary();
Method attitude_autogain();
Method attitude_vqf();
Method attitude_tumble();
Method attitude_tumble_lag();
Method attitude_tumble_batch();
Method position_rolling();
Method position_autogain_fusion();
Method position_tumble();
Method position_tumble_lag();
Method position_tumble_live();
Method position_oracle();
Method slam_icp();
Method slam_icp_raw();
Method slam_tumble();
Method slam_oracle();
Method slam_poses_rolling();
Method slam_poses_autogain_fusion();
Method slam_poses_tumble();
Method slam_rolling_prior();
Method slam_published();
Method slam_tumble_lag();
Method slam_tumble_live();

/// Returns a copy of the method slam/tumble_lag or slam/tumble_live that localises in a prior map
/// (TumblingOdometry::set_prior_map). The result is empty for other methods. The health value `prior_map_sweep` is the
/// number of the first sweep in the frame of the prior map, or 0. After a localisation, all poses of an estimate are in
/// the frame of the prior map: slam/tumble_live leaves out the poses before the localisation, and slam/tumble_lag
/// transforms these poses.
std::optional<Method> localised_in(const Method& method, std::shared_ptr<const PriorMap> map);

/// Returns the settings and parameter values of a method that first runs a position method.
std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position);
sim::Values values_of(const Method& position, const sim::Values& parameters);

void count_sources(std::span<const AngularRateState> rates, std::map<std::string, double>& health);

/// Parses parameter values of methods such as "rate/tumble_lag.lag_s=0.5"; the prefix "rate/" is optional.
std::vector<Method> with_parameters(std::span<const MethodPointer> methods, std::span<const std::string> texts);

}  // namespace tumble::scenarios
