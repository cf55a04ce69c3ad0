// SPDX-License-Identifier: BSD-3-Clause
#include "sim/simulate.hpp"

#include "sim/engine/model.hpp"
#include "sim/motion/motion_type.hpp"
#include "sim/sensor_type.hpp"
#include "sim/truth/above_ground.hpp"
#include "sim/truth/record_truth.hpp"

namespace tumble::sim {

namespace {

Eigen::Isometry3d site_pose(const engine::World& world, const SensorSpec& sensor) {
  const mjModel& model = *world.model;
  const int site = mj_name2id(&model, mjOBJ_SITE, sensor.site.c_str());
  if (site < 0) {
    std::vector<std::string> names;
    for (int i = 0; i < model.nsite; ++i) names.emplace_back(mj_id2name(&model, mjOBJ_SITE, i));
    const std::string near = did_you_mean(sensor.site, names);
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : " ") + name;
    throw InvalidSituation("sensors." + sensor.name + ": the robot has no site '" + sensor.site + "'" +
                           (near.empty() ? " (known: " + known + ")" : "; " + near));
  }
  if (model.site_bodyid[site] != world.robot_body) {
    throw InvalidSituation("sensors." + sensor.name + ": site '" + sensor.site +
                           "' is not on the body that carries the sensors; choose a site of that body");
  }
  const mjtNum* p = model.site_pos + 3 * site;
  const mjtNum* q = model.site_quat + 4 * site;
  Eigen::Isometry3d T_BX = Eigen::Isometry3d::Identity();
  T_BX.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  T_BX.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return T_BX;
}

/// Returns the sensor pose that an estimator receives: the pose in the design frame plus the calibration error. The
/// origin of the design frame is the nominal centre of mass or, for a sphere, the geometric centre.
Eigen::Isometry3d given_pose(const engine::World& world, const SensorSpec& sensor, const Eigen::Isometry3d& T_BX) {
  const Values& error = sensor.mount_error;
  Eigen::Isometry3d given = T_BX;
  given.translation() += world.com_offset_m + Eigen::Vector3d(error.at("x_m"), error.at("y_m"), error.at("z_m"));
  const Eigen::Vector3d angles(error.at("roll_rad"), error.at("pitch_rad"), error.at("yaw_rad"));
  const double angle = angles.norm();
  if (angle > 0.0) given.rotate(Eigen::AngleAxisd(angle, angles / angle));
  return given;
}

}  // namespace

Recording simulate(const BuiltSituation& built, int threads) {
  const Situation& situation = built.situation();
  // The simulation changes the floor's friction in the world model when the robot moves, so the simulation needs a copy
  // of the world.
  engine::World world = engine::copy_of(built.world());
  const auto motion = find_motion_type(situation.motion.type).make(situation.motion.values, world);
  std::vector<Eigen::Isometry3d> mountings;
  for (const SensorSpec& sensor : situation.sensors) mountings.push_back(site_pose(world, sensor));

  Recording recording;
  recording.sensors.robot = situation.robot.type;
  recording.sensors.sphere_radius_m = world.sphere_radius_m;
  recording.sensors.gravity_m_s2 = -world.model->opt.gravity[2];
  recording.truth = record_truth(world, *motion, situation.duration_s);
  for (std::size_t i = 0; i < mountings.size(); ++i)
    require_above_ground(world, recording.truth, situation.sensors[i].name, mountings[i].translation());
  for (std::size_t i = 0; i < situation.sensors.size(); ++i) {
    const SensorSpec& sensor = situation.sensors[i];
    const Eigen::Isometry3d given_T_BX = given_pose(world, sensor, mountings[i]);
    const SensorContext context{
        world,  sensor, mountings[i], given_T_BX, recording.sensors.gravity_m_s2, situation.seed_of(sensor.name),
        threads};
    find_sensor_type(sensor.kind).simulate(context, recording);
  }
  return recording;
}

Eigen::Isometry3d start_pose(const BuiltSituation& built) {
  const Component& motion = built.situation()->motion;
  const BodyState start = find_motion_type(motion.type).make(motion.values, built.world())->start();
  Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();
  T_WB.translation() = start.p_WB_m;
  T_WB.linear() = start.q_WB.toRotationMatrix();
  return T_WB;
}

}  // namespace tumble::sim
