// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "results.hpp"
#include "streams.hpp"

namespace tumble::python {

namespace {

using Report = LidarInertialOdometry::SweepResult;

void bind_report(nb::module_& m) {
  nb::enum_<SweepVerdict>(
      m, "SweepVerdict", nb::is_arithmetic(),
      "Result of registering a sweep. `registered`: the lidar determines the pose. Otherwise, the pose also\n"
      "depends on the inertial prior.")
      .value("first", SweepVerdict::first, "started the map")
      .value("registered", SweepVerdict::registered, "aligned with the map in all six directions")
      .value("degenerate", SweepVerdict::degenerate,
             "aligned in the directions that the surfaces constrain; the prior determines the other directions")
      .value("rejected", SweepVerdict::rejected, "rejected: too few matches, or a correction beyond the bound");
  nb::class_<Report>(m, "SweepResult", "Result of a sweep. Poses are of the IMU, in W.")
      .def_ro("verdict", &Report::verdict)
      .def_ro("pose", &Report::pose, "pose and velocity at the end of the sweep, with covariance")
      .def_prop_ro(
          "trajectory", [](const Report& r) { return Poses{r.trajectory}; }, "poses at the IMU times within the sweep")
      .def_prop_ro(
          "final_poses_of_earlier_sweep", [](const Report& r) { return Poses{r.final_poses_of_earlier_sweep}; },
          "final (smoothed) poses of the sweep that leaves the window when this one enters; empty while the window\n"
          "fills")
      .def_ro("inlier_ratio", &Report::inlier_ratio)
      .def_ro("eigenvalue_ratio", &Report::eigenvalue_ratio)
      .def_ro("least_constrained_sigma_m", &Report::least_constrained_sigma_m,
              "standard deviation in the direction that the surfaces constrain least")
      .def_prop_ro("least_constrained_pose_direction_W",
                   [](const Report& r) { return whole<6>(r.least_constrained_pose_direction_W.data()); })
      .def_ro("normalised_innovation", &Report::normalised_innovation,
              "correction divided by the standard deviation of the prior, per square root of the number of unknowns")
      .def_ro("iterations", &Report::iterations)
      .def_ro("consecutive_rejected_sweeps", &Report::consecutive_rejected_sweeps,
              "number of consecutive rejected sweeps, including this one")
      .def_prop_ro("mean_saturation_deficit_I_rad_s",
                   [](const Report& r) { return whole<3>(r.mean_saturation_deficit_I_rad_s.data()); })
      .def_ro("usable_points", &Report::usable_points)
      .def_ro("isolated_points_dropped", &Report::isolated_points_dropped)
      .def_ro("points_after_downsampling", &Report::points_after_downsampling)
      .def_ro("map_points_added", &Report::map_points_added)
      .def_ro("in_prior_map", &Report::in_prior_map, "True if the poses are in the frame of the prior map");
  using C = LidarImuCalibration;
  nb::class_<C>(m, "LidarImuCalibration", "Estimated calibration of lidar, IMU and gravity.")
      .def_prop_ro(
          "T_IL", [](const C& c) { return matrix(c.T_IL); }, "(4, 4), lidar in IMU axes")
      .def_ro("imu_minus_lidar_clock_s", &C::imu_minus_lidar_clock_s)
      .def_prop_ro(
          "gravity_m_s2", [](const C& c) { return whole<3>(c.gravity_W_m_s2.data()); }, "(3,), in W");
}

/// Python sets the box by the keyword `own_body_L`, so the corner fields are hidden.
const std::vector<const char*> kBoxParameters = {"own_body_*"};

LidarInertialOdometry::Params mapper_params(const nb::kwargs& given) {
  Keywords keywords("LidarInertialOdometry", given);
  LidarInertialOdometry::Params params;
  params.T_IL = pose_of(keywords.need("T_IL"), "T_IL");
  const nb::object body = keywords.take("own_body_L");
  params.own_body_L = body.is_valid() ? box_of(body, "own_body_L") : Eigen::AlignedBox3d();
  read_fields(keywords, params, kBoxParameters);
  keywords.done();
  return params;
}

/// Returns the given rates, or the gyro's readings if `rates` is None.
std::vector<AngularRateState> rates_for(const std::vector<ImuSample>& samples, nb::handle rates) {
  std::vector<AngularRateState> out;
  if (rates.is_none()) {
    out.resize(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      out[k].time_ns = samples[k].time_ns;
      out[k].w_WI_I_rad_s = samples[k].angular_velocity_rad_s;
      out[k].clipped_axes = samples[k].device_clip_flags & kClipGyro;
    }
    return out;
  }
  Rates given;
  if (!nb::try_cast(rates, given)) raise_input("type", "rates", rates.type(), nb::str("Rates, or None"));
  if (given.rows.size() != samples.size())
    raise_input("shape", "rates", nb::int_(given.rows.size()), nb::int_(samples.size()));
  return given.rows;
}

using Object = Guarded<LidarInertialOdometry>;

void add_imu(Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel, nb::handle rates,
             const ArrayLike& clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  const std::vector<AngularRateState> each = rates_for(samples, rates);
  Status status;
  std::size_t k = 0;
  const std::optional<TimeNs> last_ns = self.run_timed([&](LidarInertialOdometry& mapper, LastTimes& last) {
    for (; k < samples.size() && (status = mapper.add_imu(samples[k], each[k])).ok(); ++k)
      last.sample_ns = samples[k].time_ns;
    return last.sample_ns;
  });
  if (!status.ok()) require(status, k, nb::none(), {samples[k].time_ns, last_ns});
}

Report add_sweep(Object& self, const WholeNumber& start_ns, const WholeNumber& end_ns, const ArrayLike& position,
                 const ArrayLike& offset_ns, const ArrayLike& ring, const ArrayLike& intensity) {
  const TimeNs start = time_of(start_ns, "start_ns"), end = time_of(end_ns, "end_ns");
  const std::vector<LidarPoint> points = points_of(position, offset_ns, ring, intensity);
  Report report;
  Status status;
  LastTimes before;
  self.run_timed([&](LidarInertialOdometry& mapper, LastTimes& last) {
    before = last;
    status = mapper.add_sweep(start, end, points, report);
    if (status.ok() || !report.trajectory.empty()) last.sweep_end_ns = end;
  });
  // A report with a trajectory is not an error: its verdict is `rejected`, and its pose is the inertial prediction.
  if (report.trajectory.empty())
    require(status, std::nullopt, nb::none(), exact_sweep(status, start, end, before.sweep_end_ns));
  return report;
}

}  // namespace

void bind_mapping(nb::module_& m) {
  bind_report(m);
  nb::class_<Object> bound(
      m, "LidarInertialOdometry",
      "Lidar-inertial odometry and mapping of a tumbling body, with angular velocities from a rate method.\n\n"
      "LidarInertialOdometry(T_IL=..., own_body_L=None, **options): T_IL (4, 4) is the pose of the lidar in IMU axes.\n"
      "own_body_L (2, 3) has the smallest and the largest corner of a box in lidar axes; returns within the box "
      "belong\n"
      "to the robot. parameters() lists the options. World: z up, origin and yaw of the IMU at the first sample. The "
      "body\n"
      "must be stationary for the first half second.");
  bound
      .def(
          "__init__",
          [](Object* self, const nb::kwargs& options) {
            new (self) Object(LidarInertialOdometry(mapper_params(options)));
          },
          nb::arg("options"), takes_options())
      .def("add_imu", &add_imu, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"), nb::arg("rates") = nb::none(),
           nb::arg("clip_flags") = nb::none(),
           "Adds one sample or many, with the Rates of a rate method. Without rates, the gyro's readings are used.")
      .def("add_sweep", &add_sweep, nb::arg("start_ns"), nb::arg("end_ns"), nb::arg("position"), nb::arg("offset_ns"),
           nb::arg("ring") = nb::none(), nb::arg("intensity") = nb::none(),
           "Registers a sweep of points measured in [start_ns, end_ns]. IMU samples must cover this interval.\n"
           "position (N, 3), m: in lidar axes at the time of each point. offset_ns (N,): time after start_ns. If\n"
           "registration fails, the verdict is `rejected` and the pose is the inertial prior.")
      .def(
          "lidar_calibration",
          [](Object& self) { return self.run([](auto& mapper) { return mapper.lidar_calibration(); }); },
          "Returns the current estimates of T_IL, clock offset and gravity.")
      .def(
          "pose_at",
          [](Object& self, const ArrayLike& time_ns) {
            const TimeNs at = time_of(time_ns, "time_ns");
            PoseState pose;
            require(self.run([&](auto& mapper) { return mapper.pose_at(at, pose); }));
            return pose;
          },
          nb::arg("time_ns"), "Returns the pose at any time within the window of sweeps.")
      .def(
          "window_trajectory",
          [](Object& self) { return joined(self.run([](auto& mapper) { return mapper.window_trajectories(); })); },
          "Returns the poses of the sweeps in the window, which are not final yet.")
      .def(
          "map", [](Object& self) { return MapPoints{self.run([](auto& mapper) { return mapper.map(); })}; },
          "Returns the map within map_radius_m of the sensor.")
      .def_static("parameters", [] { return list_fields(LidarInertialOdometry::Params{}, kBoxParameters); });
  bind_copy<Object>(bound);
}

}  // namespace tumble::python
