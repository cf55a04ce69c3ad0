// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/motion/motion_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"rest_s", 1.75, 0.0, 30.0, "s", "rest before the push"},
    Parameter{"push_s", 0.2, 0.02, 2.0, "s", "length of the push; force and torque rise and fall as a raised cosine"},
    Parameter{"yaw_rad", 0.0, -3.2, 3.2, "rad", "heading of the robot at rest; 0: its x axis points down the slope"},
    Parameter{"direction_rad", 0.0, -3.2, 3.2, "rad", "direction of the push about z; 0: down the slope"},
    Parameter{"velocity_m_s", 2.0, 0.0, 10.0, "m/s", "impulse over mass, level"},
    Parameter{"lift_m_s", 1.0, 0.0, 10.0, "m/s", "impulse over mass, upwards"},
    Parameter{"spin_forward_rad_s", 4.0, -30.0, 30.0, "rad/s",
              "angular impulse over inertia about the axis of forward rolling"},
    Parameter{"spin_side_rad_s", 0.0, -30.0, 30.0, "rad/s", "the same about the direction of the push"},
    Parameter{"spin_up_rad_s", 0.0, -30.0, 30.0, "rad/s", "the same about the vertical"},
};

class Push : public Motion {
 public:
  Push(const Values& values, const engine::World& world) : rest_s_(values.at("rest_s")), push_s_(values.at("push_s")) {
    const mjModel& model = *world.model;
    start_.q_WB = Eigen::AngleAxisd(values.at("yaw_rad"), Eigen::Vector3d::UnitZ());
    start_.p_WB_m = world.start_W_m + Eigen::Vector3d(0, 0, clearance_m(model, world.robot_body));

    const double mass_kg = model.body_mass[world.robot_body];
    const double direction = values.at("direction_rad");
    const Eigen::Vector3d forward(std::cos(direction), std::sin(direction), 0.0);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    impulse_.force_W_n = mass_kg * (values.at("velocity_m_s") * forward + values.at("lift_m_s") * up);
    const Eigen::Vector3d spin_W_rad_s = values.at("spin_forward_rad_s") * up.cross(forward) +
                                         values.at("spin_side_rad_s") * forward + values.at("spin_up_rad_s") * up;
    impulse_.torque_W_nm = inertia_W(model, world.robot_body) * spin_W_rad_s;
  }

  BodyState start() const override { return start_; }

  Wrench wrench(const BodyState& state) override {
    const double u = (state.time_s - rest_s_) / push_s_;
    if (!(u > 0.0 && u < 1.0)) return {};
    const double rate = (1.0 - std::cos(2.0 * std::numbers::pi * u)) / push_s_;  // integral over the push: 1
    return {impulse_.force_W_n * rate, impulse_.torque_W_nm * rate};
  }

 private:
  /// Height of the centre of mass that puts every capsule and sphere of the upright robot just above a level ground.
  static double clearance_m(const mjModel& model, int body) {
    constexpr double kGap_m = 0.003;
    double lowest_m = 0.0;
    for (int geom = model.body_geomadr[body]; geom < model.body_geomadr[body] + model.body_geomnum[body]; ++geom) {
      const bool touches = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
      const bool capsule = model.geom_type[geom] == mjGEOM_CAPSULE;
      if (!touches || !(capsule || model.geom_type[geom] == mjGEOM_SPHERE)) continue;
      const mjtNum* q = model.geom_quat + 4 * geom;
      const double axis_z = 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]);
      const double half_m = capsule ? std::abs(axis_z) * model.geom_size[3 * geom + 1] : 0.0;
      lowest_m = std::min(lowest_m, model.geom_pos[3 * geom + 2] - half_m - model.geom_size[3 * geom]);
    }
    return kGap_m - lowest_m;
  }

  Eigen::Matrix3d inertia_W(const mjModel& model, int body) const {
    const mjtNum* q = model.body_iquat + 4 * body;
    const Eigen::Matrix3d R_Wi = (start_.q_WB * Eigen::Quaterniond(q[0], q[1], q[2], q[3])).toRotationMatrix();
    return R_Wi * Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * body).asDiagonal() * R_Wi.transpose();
  }

  double rest_s_, push_s_;
  BodyState start_;
  Wrench impulse_;
};

std::unique_ptr<Motion> make(const Values& values, const engine::World& world) {
  return std::make_unique<Push>(values, world);
}

}  // namespace

const MotionType& push_motion() {
  static const MotionType kType{{"push", "at rest, then pushed by force and torque, then free", kParameters}, make};
  return kType;
}

}  // namespace tumble::sim
