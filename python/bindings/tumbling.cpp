// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "results.hpp"
#include "rig.hpp"
#include "saving.hpp"
#include "streams.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"

namespace tumble::python {

namespace {

using BoundTumblingOdometry = Guarded<TumblingOdometry>;
using Sweep = TumblingOdometry::Sweep;

/// Returns the names of the parameters that TumblingOdometry computes itself or reads from data sheets.
const std::vector<const char*>& derived_tumbling_parameters() {
  static const std::vector<const char*> all = [] {
    const auto derived = TumblingOdometry::Params::Expert::computed_parameter_names();
    std::vector<const char*> out(derived.begin(), derived.end());
    out.insert(out.end(), {"imu_*", "range_*"});
    return out;
  }();
  return all;
}

template <class Sheet>
Sheet sheet_of(nb::handle given, const char* field, const char* type) {
  Sheet sheet;
  if (!nb::try_cast(given, sheet)) raise_input("type", field, given.type(), nb::str(type));
  return sheet;
}

/// Converts pairs (LidarDataSheet, T_IL) or triples (LidarDataSheet, T_IL, own_body_L).
std::vector<FurtherLidar> further_lidars_of(const nb::object& given) {
  std::vector<FurtherLidar> out;
  for (const nb::handle each : given) {
    const bool listed = nb::isinstance<nb::tuple>(each);
    const std::size_t count = listed ? nb::len(each) : 0;
    if (count != 2 && count != 3)
      raise_input("type", "further_lidars", each.type(),
                  nb::str("tuples (LidarDataSheet, T_IL) or (LidarDataSheet, T_IL, own_body_L)"));
    FurtherLidar& lidar = out.emplace_back();
    lidar.data_sheet = sheet_of<LidarDataSheet>(each[0], "further_lidars", "a LidarDataSheet");
    lidar.T_IL = pose_of(each[1], "further_lidars T_IL");
    if (count == 3) lidar.own_body_L = box_of(each[2], "further_lidars own_body_L");
  }
  return out;
}

TumblingOdometry::Params tumbling_params(const nb::kwargs& given) {
  Keywords keywords("TumblingOdometry", given);
  TumblingOdometry::Params params;
  params.imu = sheet_of<ImuDataSheet>(keywords.need("imu"), "imu", "an ImuDataSheet");
  if (const nb::object lidar = keywords.take("lidar"); lidar.is_valid())
    params.lidar = sheet_of<LidarDataSheet>(lidar, "lidar", "a LidarDataSheet");
  params.T_IL = pose_of(keywords.need("T_IL"), "T_IL");
  params.lever_arm_I_m = vector_of(keywords.need("lever_arm_m"), "lever_arm_m");
  if (const nb::object body = keywords.take("own_body_L"); body.is_valid())
    params.own_body_L = box_of(body, "own_body_L");
  if (const nb::object further = keywords.take("further_lidars"); further.is_valid())
    params.further_lidars = further_lidars_of(further);
  if (const nb::object rig = keywords.take("calibration"); rig.is_valid() && !rig.is_none())
    params.expert->rate.rate.model.calibration = rig_of(rig, "calibration");
  read_fields(keywords, params, derived_tumbling_parameters());
  keywords.done();
  return params;
}

void add_tumbling_imu(BoundTumblingOdometry& self, const ArrayLike& time_ns, const ArrayLike& gyro,
                      const ArrayLike& accel, const ArrayLike& clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  Status status;
  std::size_t k = 0;
  const std::optional<TimeNs> last_ns = self.run_timed([&](TumblingOdometry& odometry, LastTimes& last) {
    for (; k < samples.size(); ++k) {
      status = odometry.add_imu(samples[k]);
      if (!may_continue(status)) break;
      if (status.ok()) last.sample_ns = samples[k].time_ns;
    }
    return last.sample_ns;
  });
  if (k < samples.size()) require(status, k, nb::none(), {samples[k].time_ns, last_ns});
}

void add_tumbling_sweep(BoundTumblingOdometry& self, const WholeNumber& start_ns, const WholeNumber& end_ns,
                        const ArrayLike& position, const ArrayLike& offset_ns, const ArrayLike& ring,
                        const ArrayLike& intensity, std::size_t lidar) {
  const TimeNs start = time_of(start_ns, "start_ns"), end = time_of(end_ns, "end_ns");
  const std::vector<LidarPoint> points = points_of(position, offset_ns, ring, intensity);
  LastTimes before;
  const Status status = self.run_timed([&](TumblingOdometry& odometry, LastTimes& last) {
    before = last;
    const Status added = odometry.add_sweep(lidar, start, end, points);
    if (added.ok() && lidar == 0) last.sweep_end_ns = end;
    return added;
  });
  require(status, std::nullopt, nb::none(), exact_sweep(status, start, end, before.sweep_end_ns));
}

void add_tumbling_position(BoundTumblingOdometry& self, const WholeNumber& time_ns, const ArrayLike& position,
                           const ArrayLike& covariance, nb::handle lever_arm) {
  PositionReading reading{.time_ns = time_of(time_ns, "time_ns"),
                          .antenna_position_P_m = vector_of(position, "position")};
  const std::vector<double> numbers = numbers_of(as_array(covariance, "covariance").attr("ravel")(), "covariance", 9);
  reading.covariance_m2 = Eigen::Map<const Eigen::Matrix3d>(numbers.data());
  if (!lever_arm.is_none()) reading.antenna_lever_arm_I_m = vector_of(lever_arm, "lever_arm");
  require(self.run([&](TumblingOdometry& odometry) { return odometry.add_frame_alignment_position(reading); }));
}

Rates rates_of(const std::optional<AngularRateState>& rate) {
  Rates out;
  if (rate) out.rows.push_back(*rate);
  return out;
}

/// Calls a member function without arguments while no other thread uses the estimator.
template <auto kMember>
auto locked(BoundTumblingOdometry& self) {
  return self.run([](TumblingOdometry& odometry) { return (odometry.*kMember)(); });
}

template <class Class>
void bind_accessors(Class& bound) {
  bound
      .def(
          "newest",
          [](BoundTumblingOdometry& self) {
            PoseState pose;
            require(self.run([&](TumblingOdometry& odometry) { return odometry.newest(pose); }));
            return pose;
          },
          "Returns pose and velocity of the IMU at its newest sample, with covariance, predicted from the last "
          "registered\n"
          "sweep. Raises TumbleError `empty` before the first registered sweep.")
      .def(
          "newest_rate",
          [](BoundTumblingOdometry& self) {
            return rates_of(self.run([](TumblingOdometry& odometry) { return odometry.newest_rate(); }));
          },
          "Returns the rate of the newest sample, provisional where the gyro clips; no row before the first sample.")
      .def(
          "newest_smoothed_rate",
          [](BoundTumblingOdometry& self) {
            return rates_of(self.run([](TumblingOdometry& odometry) { return odometry.newest_smoothed_rate(); }));
          },
          "Returns the latest rate of the fixed-lag smoother, lag_s old; no row during the first lag_s.")
      .def("body_imu_calibration", &locked<&TumblingOdometry::body_imu_calibration>,
           "Returns the estimated calibration of the IMU: lever arm, biases, elements. Pass it to the next run as "
           "`calibration`.")
      .def(
          "lidar_calibration",
          [](BoundTumblingOdometry& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.mapper().lidar_calibration(); });
          },
          "Returns the current estimates of T_IL, clock offset and gravity.")
      .def(
          "lidar_calibration_covariance",
          [](BoundTumblingOdometry& self) {
            const auto P =
                self.run([](TumblingOdometry& odometry) { return odometry.mapper().lidar_calibration_covariance(); });
            constexpr int kErrorCount = LidarImuCalibration::kErrorCount;
            const nb::object all = nb::cast(owned(std::vector<double>(P.data(), P.data() + P.size())));
            return nb::cast<Doubles>(all.attr("reshape")(kErrorCount, kErrorCount).attr("copy")());
          },
          "Returns the covariance (N, N) of the errors of lidar_calibration(); 0 for values that are not estimated.")
      .def(
          "window_trajectory",
          [](BoundTumblingOdometry& self) {
            return joined(self.run([](TumblingOdometry& odometry) { return odometry.mapper().window_trajectories(); }));
          },
          "Returns the poses of the sweeps in the window, which are not final yet.")
      .def(
          "map",
          [](BoundTumblingOdometry& self) {
            return MapPoints{self.run([](TumblingOdometry& odometry) { return odometry.mapper().map(); })};
          },
          "Returns the map within mapping_map_radius_m of the sensor.")
      .def(
          "health",
          [](BoundTumblingOdometry& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.health().findings; });
          },
          nb::sig("def health(self) -> list[HealthFinding]"), kHealth)
      .def_prop_ro("gaps", &locked<&TumblingOdometry::restart_count>,
                   "number of gaps in the IMU samples after which rate estimation restarted")
      .def_prop_ro("samples_rejected_by_mapper", &locked<&TumblingOdometry::samples_rejected_by_mapper>,
                   "number of samples that the mapper rejected with their rates: 0 in normal operation")
      .def_prop_ro("rejected_readings", &locked<&TumblingOdometry::rejected_readings>,
                   "number of samples that were rejected because their readings or stamps are outliers")
      .def_prop_ro("newest_imu_time_ns", &locked<&TumblingOdometry::newest_imu_time_ns>,
                   "time of the newest accepted sample; None before the first")
      .def_prop_ro(
          "estimated_jitter_s", &locked<&TumblingOdometry::estimated_jitter_s>,
          "standard deviation of the IMU's stamps about a regular clock, while that clock replaces them; else None")
      .def_prop_ro("lidar_scale", &locked<&TumblingOdometry::lidar_scale>,
                   "ratio of the lidar's scale to the IMU's scale, estimated from the motion so far")
      .def_prop_ro("second_pass_applied", &locked<&TumblingOdometry::first_seconds_reprocessing_applied>,
                   "True if the map and the pose come from the second pass")
      .def_prop_ro("dropped_untaken_sweeps", &locked<&TumblingOdometry::dropped_untaken_sweeps>,
                   "number of sweeps that were dropped because take() was not called in time");
}

}  // namespace

void bind_tumbling(nb::module_& m) {
  nb::class_<Sweep>(m, "Sweep", "Result of a sweep that was added.")
      .def_prop_ro("ok", [](const Sweep& s) { return s.status.ok(); })
      .def_prop_ro(
          "message", [](const Sweep& s) { return s.status.message(); }, "\"ok\", or the error")
      .def_prop_ro(
          "placed", [](const Sweep& s) { return !s.result.trajectory.empty(); },
          "True if the sweep has poses; a sweep that starts before the first IMU sample has no poses")
      .def_ro("result", &Sweep::result)
      .def_prop_ro(
          "pose_in_position_frame",
          [](const Sweep& s) {
            return s.position_frame ? std::optional(s.position_frame->transform(s.result.pose)) : std::nullopt;
          },
          "pose at the end of the sweep in the frame of the position readings; None until they determine the frame");
  nb::class_<LidarScale>(m, "SweepScale",
                         "Ratio of the motion between sweeps measured by the lidar to that measured by the IMU.")
      .def_ro("scale", &LidarScale::scale)
      .def_ro("sigma", &LidarScale::sigma, "standard deviation of scale; infinite before the first comparison")
      .def_ro("changes", &LidarScale::velocity_change_count, "number of compared changes of velocity")
      .def_prop_ro("is_inconsistent", &LidarScale::is_inconsistent,
                   "True if scale differs from 1 by more than 2 % and by more than five standard deviations");
  nb::class_<BoundTumblingOdometry> bound(
      m, "TumblingOdometry",
      "Estimates pose, velocity and map of a tumbling body, causally and sample by sample. The sensors are one IMU, "
      "whose\n"
      "gyro may clip, and a lidar, whose sweeps are distorted by the motion.\n\n"
      "TumblingOdometry(imu=ImuDataSheet, T_IL=..., lever_arm_m=(x, y, z), lidar=LidarDataSheet(), own_body_L=None,\n"
      "calibration=None, **options): T_IL (4, 4) is the pose of the lidar in IMU axes. lever_arm_m is from the centre "
      "of\n"
      "mass to the IMU, in IMU axes, accurate to 1 cm. own_body_L (2, 3) has the smallest and the largest corner of a "
      "box\n"
      "in lidar axes; returns within the box belong to the robot. further_lidars: tuples (LidarDataSheet, T_IL[, "
      "own_body_L]).\n"
      "calibration is body_imu_calibration() of an earlier run. Options: "
      "see\n"
      "parameters(). World: z up, origin and yaw of the IMU at the first sample. The body must be stationary for the\n"
      "first half second.");
  bound
      .def(
          "__init__",
          [](BoundTumblingOdometry* self, const nb::kwargs& options) {
            new (self) BoundTumblingOdometry(TumblingOdometry(tumbling_params(options)));
          },
          nb::arg("options"), takes_options())
      .def("add_imu", &add_tumbling_imu, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(),
           "Adds one sample or many, in order of time. Registers the sweeps whose rates became available. Leaves out "
           "the "
           "first\n"
           "sample after a gap of more than a second, and continues with the next sample; `gaps` counts the gaps.")
      .def(
          "add_sweep", &add_tumbling_sweep, nb::arg("start_ns"), nb::arg("end_ns"), nb::arg("position"),
          nb::arg("offset_ns"), nb::arg("ring") = nb::none(), nb::arg("intensity") = nb::none(), nb::arg("lidar") = 0,
          "Adds a sweep of points measured in [start_ns, end_ns]; the call may come at any time after the last point.\n"
          "position (N, 3), m: in lidar axes at the time of each point. offset_ns (N,): time after start_ns. lidar k "
          "is\n"
          "further_lidars[k - 1]; its points join the sweep of lidar 0 at their time, if they arrive within lag_s.")
      .def(
          "add_frame_alignment_position", &add_tumbling_position, nb::arg("time_ns"), nb::arg("position"),
          nb::arg("covariance"), nb::arg("lever_arm") = nb::none(),
          "Adds a position reading, for example of GPS or a beacon, before its sweep is registered. position (3,), m: "
          "of\n"
          "the antenna, in a frame P with z up. covariance (3, 3), m^2. lever_arm (3,), m: antenna in IMU axes. Poses\n"
          "and map do not change; Sweep.pose_in_position_frame is the pose in P, which does not drift.")
      .def(
          "set_prior_map",
          [](BoundTumblingOdometry& self, const MapPoints& map, nb::handle start_T_MI, double start_position_sigma_m,
             double start_heading_sigma_rad, bool extend) {
            PriorMap prior{.points = map.rows,
                           .start_position_sigma_m = start_position_sigma_m,
                           .start_heading_sigma_rad = start_heading_sigma_rad,
                           .extend = extend};
            if (!start_T_MI.is_none()) prior.start_T_MI = pose_of(start_T_MI, "start_T_MI");
            require(self.run([&](TumblingOdometry& odometry) { return odometry.set_prior_map(std::move(prior)); }));
          },
          nb::arg("map"), nb::arg("start_T_MI") = nb::none(), nb::arg("start_position_sigma_m") = 0.0,
          nb::arg("start_heading_sigma_rad") = 0.0, nb::arg("extend") = true,
          "Localises the run in the map of an earlier run; call it before the first sweep. start_T_MI (4, 4): pose of "
          "the IMU\n"
          "in the map at the start, with its standard deviations per axis and of the heading; None: the whole map is\n"
          "searched.\n"
          "extend=False keeps the map unchanged. Until result.in_prior_map is true, poses are in a local frame, and\n"
          "health() reports that the robot is not localised.")
      .def("take", &locked<&TumblingOdometry::take>,
           "Returns the next processed sweep, in order, or None if no sweep is ready.")
      .def(
          "take_all",
          [](BoundTumblingOdometry& self) {
            return self.run([](TumblingOdometry& odometry) {
              std::vector<Sweep> out;
              while (std::optional<Sweep> sweep = odometry.take()) out.push_back(std::move(*sweep));
              return out;
            });
          },
          "Returns all processed sweeps that take() has not returned yet.")
      .def(
          "finish",
          [](BoundTumblingOdometry& self) {
            require(self.run([](TumblingOdometry& odometry) { return odometry.finish(); }));
          },
          "Processes all waiting sweeps that the IMU covers, at the end of a run or at a halt. take() returns them.\n"
          "With lag_s=1e9, estimates the whole recording. Raises TumbleError for a recording that cannot be estimated.")
      .def(
          "rates",
          [](BoundTumblingOdometry& self) {
            Rates out;
            self.run([&](TumblingOdometry& odometry) {
              if (odometry.whole_recording_result()) out.rows = odometry.whole_recording_result()->rates;
              return true;
            });
            return out;
          },
          "Returns the rates of all samples after finish() with lag_s=1e9; otherwise no row.")
      .def_static("parameters", [] { return list_fields(TumblingOdometry::Params{}, derived_tumbling_parameters()); });
  bind_accessors(bound);
  bind_copy<BoundTumblingOdometry>(bound);
  bind_saving<TumblingOdometry>(bound, [](TumblingOdometry& self) -> TumblingOdometry& { return self; });
}

}  // namespace tumble::python
