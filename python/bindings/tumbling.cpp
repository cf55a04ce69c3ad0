// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/tumbling_odometry.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "results.hpp"
#include "rig.hpp"
#include "streams.hpp"

namespace tumble::python {

namespace {

TumblingOdometry restored_tumbling(std::span<const std::byte> bytes) {
  TumblingOdometry::Params params;
  require(TumblingOdometry::saved_params(bytes, params));
  TumblingOdometry out(params);
  require(out.load(bytes));
  return out;
}

using TumblingDoor = Guarded<TumblingOdometry>;
using Sweep = TumblingOdometry::Sweep;

/// The door's own numbers take the place of these.
const std::vector<const char*> kOfTumbling = {"imu_*",
                                              "range_*",
                                              "rate_lever_arm_sigma_m",
                                              "rate_gyro_noise_density",
                                              "rate_accel_noise_density",
                                              "rate_period_s",
                                              "rate_lag_s",
                                              "rate_evidence_gravity_m_s2",
                                              "rate_carried_gravity_m_s2",
                                              "rate_carried_gap_max_s",
                                              "rate_carried_period_s",
                                              "rate_carried_lag_s",
                                              "rate_carried_iterations_max",
                                              "mapping_mount_sigma_*",
                                              "mapping_time_offset_sigma_s",
                                              "mapping_gravity_m_s2",
                                              "mapping_range_*",
                                              "mapping_own_body_*",
                                              "mapping_accel_rail_m_s2"};

template <class Sheet>
Sheet sheet_of(nb::handle given, const char* field, const char* type) {
  Sheet sheet;
  if (!nb::try_cast(given, sheet)) raise_input("type", field, given.type(), nb::str(type));
  return sheet;
}

TumblingOdometry::Params tumbling_params(const nb::kwargs& given) {
  Keywords keywords("TumblingOdometry", given);
  TumblingOdometry::Params params;
  params.imu = sheet_of<ImuSheet>(keywords.need("imu"), "imu", "an ImuSheet");
  if (const nb::object lidar = keywords.take("lidar"); lidar.is_valid())
    params.lidar = sheet_of<LidarSheet>(lidar, "lidar", "a LidarSheet");
  params.T_IL = pose_of(keywords.need("T_IL"), "T_IL");
  params.lever_arm_I_m = vector_of(keywords.need("lever_arm_m"), "lever_arm_m");
  if (const nb::object body = keywords.take("own_body_L"); body.is_valid())
    params.own_body_L = box_of(body, "own_body_L");
  if (const nb::object rig = keywords.take("calibration"); rig.is_valid() && !rig.is_none())
    params.expert.rate.rate.model.calibration = rig_of(rig, "calibration");
  read_fields(keywords, params, kOfTumbling);
  keywords.done();
  return params;
}

void add_tumbling_imu(TumblingDoor& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel,
                      const ArrayLike& clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  Status status;
  std::size_t k = 0;
  const std::optional<TimeNs> last_ns = self.run_timed([&](TumblingOdometry& odometry, LastTimes& last) {
    for (; k < samples.size() && (status = odometry.add_imu(samples[k])).ok(); ++k) last.sample_ns = samples[k].time_ns;
    return last.sample_ns;
  });
  if (!status.ok()) require(status, k, nb::none(), {samples[k].time_ns, last_ns});
}

void add_tumbling_sweep(TumblingDoor& self, const WholeNumber& start_ns, const WholeNumber& end_ns,
                        const ArrayLike& position, const ArrayLike& offset_ns, const ArrayLike& ring,
                        const ArrayLike& intensity) {
  const TimeNs start = time_of(start_ns, "start_ns"), end = time_of(end_ns, "end_ns");
  const std::vector<LidarPoint> points = points_of(position, offset_ns, ring, intensity);
  LastTimes before;
  const Status status = self.run_timed([&](TumblingOdometry& odometry, LastTimes& last) {
    before = last;
    const Status added = odometry.add_sweep(start, end, points);
    if (added.ok()) last.sweep_end_ns = end;
    return added;
  });
  require(status, std::nullopt, nb::none(), exact_sweep(status, start, end, before.sweep_end_ns));
}

Rates rates_of(const std::optional<RateState>& rate) {
  Rates out;
  if (rate) out.rows.push_back(*rate);
  return out;
}

template <class Class>
void bind_talk(Class& bound) {
  bound
      .def(
          "newest",
          [](TumblingDoor& self) {
            PoseState pose;
            require(self.run([&](TumblingOdometry& odometry) { return odometry.newest(pose); }));
            return pose;
          },
          "Pose and velocity of the IMU at its newest sample, by inertia from the last sweep that was registered, "
          "with\n"
          "covariance. TumbleError `empty` before that.")
      .def(
          "newest_rate",
          [](TumblingDoor& self) {
            return rates_of(self.run([](TumblingOdometry& odometry) { return odometry.newest_rate(); }));
          },
          "Rate of the newest sample, provisional where the gyro clips; no row before the first.")
      .def(
          "smoothed_rate",
          [](TumblingDoor& self) {
            return rates_of(self.run([](TumblingOdometry& odometry) { return odometry.smoothed_rate(); }));
          },
          "Latest rate of the fixed-lag smoother, lag_s old; no row while the lag fills.")
      .def(
          "rig", [](TumblingDoor& self) { return self.run([](TumblingOdometry& odometry) { return odometry.rig(); }); },
          "What is known of the IMU on the body: lever arm, biases, elements. For the next run's `calibration`.")
      .def(
          "calibration",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.mapper().calibration(); });
          },
          "T_IL, the clocks' offset and gravity as estimated so far.")
      .def(
          "calibration_covariance",
          [](TumblingDoor& self) {
            const auto P =
                self.run([](TumblingOdometry& odometry) { return odometry.mapper().calibration_covariance(); });
            constexpr int kErrors = SweepCalibration::kErrors;
            const nb::object all = nb::cast(owned(std::vector<double>(P.data(), P.data() + P.size())));
            return nb::cast<Doubles>(all.attr("reshape")(kErrors, kErrors).attr("copy")());
          },
          "(N, N), of its errors; 0 where not estimated.")
      .def(
          "open_trajectory",
          [](TumblingDoor& self) {
            return joined(self.run([](TumblingOdometry& odometry) { return odometry.mapper().open_trajectories(); }));
          },
          "Poses of the sweeps in the window that have not had their last word yet.")
      .def(
          "map",
          [](TumblingDoor& self) {
            return MapPoints{self.run([](TumblingOdometry& odometry) { return odometry.mapper().map(); })};
          },
          "The map within mapping_map_radius_m of the sensor.")
      .def(
          "doubt",
          [](TumblingDoor& self) {
            return doubt_of(self.run([](TumblingOdometry& odometry) { return odometry.doubt(); }));
          },
          nb::sig("def doubt(self) -> tumble.errors.TumbleError | None"), kDoubt)
      .def_prop_ro(
          "gaps",
          [](TumblingDoor& self) { return self.run([](TumblingOdometry& odometry) { return odometry.gaps(); }); },
          "of the IMU, after which the rates began anew")
      .def_prop_ro(
          "refused_samples",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.refused_samples(); });
          },
          "that the mapper did not take with their rates: 0 unless something is wrong")
      .def_prop_ro(
          "rejected_readings",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.rejected_readings(); });
          },
          "number of samples that were rejected because their readings or stamps are wild")
      .def_prop_ro(
          "newest_ns",
          [](TumblingDoor& self) { return self.run([](TumblingOdometry& odometry) { return odometry.newest_ns(); }); },
          "time of the newest sample that was taken in; None before the first")
      .def_prop_ro(
          "mended_jitter_s",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.mended_jitter_s(); });
          },
          "standard deviation of the IMU's stamps about a regular clock, while that clock's times count for them; else "
          "None")
      .def_prop_ro(
          "sweep_scale",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.sweep_scale(); });
          },
          "by how much the lidar's ranges are longer than the IMU has it, as far as the motion told")
      .def_prop_ro(
          "passed_again",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.passed_again(); });
          },
          "whether map and pose are those of the second pass")
      .def_prop_ro(
          "dropped_sweeps",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) { return odometry.dropped_sweeps(); });
          },
          "that nobody took in time");
}

}  // namespace

void bind_tumbling(nb::module_& m) {
  nb::class_<Sweep>(m, "Sweep", "What became of a sweep.")
      .def_prop_ro("ok", [](const Sweep& s) { return s.status.ok(); })
      .def_prop_ro(
          "message", [](const Sweep& s) { return s.status.message(); }, "\"ok\", or the trouble with it")
      .def_prop_ro(
          "placed", [](const Sweep& s) { return !s.report.trajectory.empty(); },
          "whether it has poses; one that begins before the IMU has none")
      .def_ro("report", &Sweep::report);
  nb::class_<SweepScale>(m, "SweepScale", "By how much ways between sweeps are longer than the IMU has it.")
      .def_ro("scale", &SweepScale::scale)
      .def_ro("sigma", &SweepScale::sigma, "its standard deviation; infinite while nothing was compared")
      .def_ro("changes", &SweepScale::changes, "of velocity that were compared")
      .def_prop_ro("is_off", &SweepScale::is_off, "further from 1 than 2 % and than five of its deviations");
  nb::class_<TumblingDoor> bound(
      m, "TumblingOdometry",
      "Pose, velocity and map of a body that tumbles, from one IMU whose gyro may clip and a lidar whose sweeps are "
      "bent:\n"
      "causal, sample by sample.\n\n"
      "TumblingOdometry(imu=ImuSheet, T_IL=..., lever_arm_m=(x, y, z), lidar=LidarSheet(), own_body_L=None,\n"
      "calibration=None, **options): T_IL (4, 4), lidar in IMU axes; lever_arm_m from the centre of mass to the IMU, "
      "IMU\n"
      "axes, to a centimetre; own_body_L (2, 3), least and largest corner of the box in lidar axes whose returns are "
      "the\n"
      "robot's own; calibration: rig() of an earlier run. Options: parameters().\n"
      "World: z up, origin and yaw at the IMU at the first sample. Begin at rest, half a second or more.");
  bound
      .def(
          "__init__",
          [](TumblingDoor* self, const nb::kwargs& options) {
            new (self) TumblingDoor(TumblingOdometry(tumbling_params(options)));
          },
          nb::arg("options"), takes_options())
      .def("add_imu", &add_tumbling_imu, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(),
           "Takes one sample or many, in order of time. Sweeps whose rates are known with them are registered now.")
      .def("add_sweep", &add_tumbling_sweep, nb::arg("start_ns"), nb::arg("end_ns"), nb::arg("position"),
           nb::arg("offset_ns"), nb::arg("ring") = nb::none(), nb::arg("intensity") = nb::none(),
           "Takes a sweep of points fired in [start_ns, end_ns], at any time after its last point: position (N, 3), m, "
           "in\n"
           "the lidar's axes at each point's own instant; offset_ns (N,), after the start.")
      .def(
          "take",
          [](TumblingDoor& self) { return self.run([](TumblingOdometry& odometry) { return odometry.take(); }); },
          "The next sweep that was registered, in order; None when there is none yet.")
      .def(
          "take_all",
          [](TumblingDoor& self) {
            return self.run([](TumblingOdometry& odometry) {
              std::vector<Sweep> out;
              while (std::optional<Sweep> sweep = odometry.take()) out.push_back(std::move(*sweep));
              return out;
            });
          },
          "All of them.")
      .def(
          "finish", [](TumblingDoor& self) { self.run([](TumblingOdometry& odometry) { odometry.finish(); }); },
          "Settles what there is, at the end of a run or at a halt: take() gives the sweeps that the IMU covers.")
      .def_static("parameters", [] { return list_fields(TumblingOdometry::Params{}, kOfTumbling); });
  bind_talk(bound);
  bind_copy<TumblingDoor>(bound);
  bind_saving<TumblingOdometry>(bound, &restored_tumbling);
}

}  // namespace tumble::python
