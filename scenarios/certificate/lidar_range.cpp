// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "sim/simulate.hpp"
#include "sim/trial/ray_trial.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kRoomHalf_m = 6.0;

sim::Situation moving_lidar(const CertificateInput& input, const std::string& robot, const std::string& device) {
  sim::Situation situation = bare_room(robot);
  situation.duration_s = 2.0;
  situation.world.values.set("room_half_m", kRoomHalf_m);
  situation.world.values.set("wall_height_m", 6.0);
  situation.motion.values.set("rest_s", 0.3);
  const DataSheet sheet = load_data_sheet(input.data, device);
  sim::SensorSpec lidar;
  lidar.name = "lidar";
  lidar.kind = sheet.sensor_kind;
  lidar.device = device;
  lidar.site = device;
  lidar.values = sheet.values();
  for (const char* off : {"range_noise_m", "range_quantum_m", "detection_range_m", "dropout_share"}) {
    lidar.values.set(off, 0.0);
  }
  situation.sensors = {lidar};
  return situation;
}

double off_plane_m(const std::string& surface, const Eigen::Vector3d& p_W_m) {
  if (surface == "floor") return std::abs(p_W_m.z());
  if (surface == "wall_front") return std::abs(p_W_m.x() - kRoomHalf_m);
  if (surface == "wall_back") return std::abs(p_W_m.x() + kRoomHalf_m);
  if (surface == "wall_left") return std::abs(p_W_m.y() - kRoomHalf_m);
  if (surface == "wall_right") return std::abs(p_W_m.y() + kRoomHalf_m);
  return -1.0;
}

struct RangeErrors {
  double largest_m = 0.0;
  std::int64_t points = 0;
};

RangeErrors against_planes(const sim::Recording& recording, double added_range_m) {
  const sim::LidarRecord& record = recording.sensors.lidars.at(0);
  const sim::LidarTruth& truth = recording.truth.lidars.at(0);
  const TruthTrack track(recording.truth, Frame::lidar);
  RangeErrors errors;
  for (std::size_t sweep = 0; sweep < record.sweep_start_ns.size(); ++sweep) {
    for (std::uint64_t i = record.sweep_first[sweep]; i < record.sweep_first[sweep + 1]; ++i) {
      const std::int64_t time_ns = record.sweep_start_ns[sweep] + record.offset_ns[i];
      if (truth.surface_id[i] < 0 || !track.covers(time_ns)) continue;
      const Eigen::Vector3d p_L_m = record.position_L_m[i].cast<double>();
      const Eigen::Vector3d longer_L_m = p_L_m * (1.0 + added_range_m / p_L_m.norm());
      const PoseState pose = track.pose(time_ns);
      const double off_m = off_plane_m(recording.truth.surfaces[static_cast<std::size_t>(truth.surface_id[i])],
                                       pose.orientation_W * longer_L_m + pose.position_W_m);
      if (off_m < 0.0) continue;
      ++errors.points;
      errors.largest_m = larger(errors.largest_m, off_m);
    }
  }
  return errors;
}

}  // namespace

std::vector<CertificateEntry> certify_lidar_range(const CertificateInput& input, const LidarRangeSetup& setup) {
  std::vector<CertificateEntry> entries;
  for (const auto& [robot, device] : {std::pair{"rig", "rs16"}, std::pair{"sphere", "mid100"}}) {
    const sim::Recording recording = sim::simulate(build(input, moving_lidar(input, robot, device)));
    const RangeErrors errors = against_planes(recording, setup.added_range_m);
    CertificateEntry entry{"lidar_range_analytic",
                           device,
                           "the points of a moving lidar without range noise are on the planes that the beams hit; the "
                           "value is the maximum distance of a point from its plane",
                           "m",
                           errors.largest_m,
                           0.0,
                           1e-3,
                           ""};
    if (errors.points < 10000) {
      entry.value = std::nan("");
      entry.note = "only " + std::to_string(errors.points) + " points";
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

namespace {

std::map<std::string, std::string> scenario_of_each_world(const DataRoot& data) {
  std::map<std::string, std::string> chosen;
  for (const std::string& name : scenario_names(data)) {
    const std::string type = load_scenario(data, name).world.type;
    const bool known = !chosen.emplace(type, name).second;
    if (known && name == type) chosen[type] = name;
  }
  return chosen;
}

}  // namespace

std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup) {
  // Accepted fraction of rays whose simulated range differs from the closed-form range, because a ray at an edge may
  // hit either adjacent surface.
  constexpr double kOtherSurface = 1e-3;
  std::vector<CertificateEntry> entries;
  for (const auto& [world, name] : scenario_of_each_world(input.data)) {
    const Scenario scenario = load_scenario(input.data, name);
    const sim::BuiltSituation built(draw(input.data, scenario, 1), input.data.models());
    const sim::RayDisagreement d = sim::compare_rays(built, {setup.rays, 1, setup.mirror_shift_m, setup.surface_shift});
    entries.push_back({"lidar_range_engine", name,
                       "lidar ranges equal the ranges of MuJoCo's mj_ray; the value is the maximum difference", "m",
                       d.largest_difference_m, 0.0, 1e-3,
                       d.hits > 0 ? "" : "this comparison has no value, because no ray hit a surface"});
    entries.push_back({"lidar_surface_engine", name,
                       "each lidar ray hits the same surface as MuJoCo's mj_ray; the value is the share of rays with "
                       "different surfaces",
                       "1", static_cast<double>(d.other_surface) / static_cast<double>(d.rays), 0.0, kOtherSurface,
                       ""});
  }
  return entries;
}

}  // namespace tumble::scenarios
