// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "results.hpp"
#include "saving.hpp"
#include "streams.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/rolling_odometry.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble::python {

namespace {

void bind_rolling_smoother(nb::module_& m) {
  using Object = Guarded<Streaming<RollingSmoother>>;
  nb::class_<Object> bound(
      m, "RollingSmoother",
      "Estimates the pose of a rolling sphere from one IMU, smoothed with a fixed lag or, by default, over the whole "
      "run.\n\n"
      "RollingSmoother(radius_m=..., lever_arm_m=(x, y, z), **options): lever_arm_m is from the centre to the IMU, in\n"
      "sensor axes. parameters() lists the options. The sphere must be stationary for the first second.");
  bound
      .def(
          "__init__",
          [](Object* self, const nb::kwargs& options) {
            Keywords keywords("RollingSmoother", options);
            keywords.need("radius_m");
            RollingSmoother::Params params;
            read_fields(keywords, params);
            keywords.done();
            new (self) Object(Streaming<RollingSmoother>(params));
          },
          nb::arg("options"), takes_options())
      .def(
          "add_imu",
          [](Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel,
             const ArrayLike& clip_flags) {
            const auto step = [](Streaming<RollingSmoother>& at, const ImuSample& sample, RollingPoses& out) {
              return at.filter.step(sample, *at.state, out.rows);
            };
            return feed<RollingPoses>(self, samples_of(time_ns, gyro, accel, clip_flags), step);
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"), nb::arg("clip_flags") = nb::none(),
          "Adds one sample or many. Returns the poses that became available.")
      .def(
          "finish",
          [](Object& self) {
            RollingPoses out;
            self.run([&](Streaming<RollingSmoother>& at) { at.filter.finish(*at.state, out.rows); });
            return out;
          },
          "Ends the estimation and returns the remaining poses.")
      .def_static("parameters", [] { return list_fields(RollingSmoother::Params{}); });
  bind_copy<Object>(bound);
}

/// Returns the names of the parameters that RollingOdometry sets itself.
const std::vector<const char*>& derived_rolling_parameters() {
  static const std::vector<const char*> all(RollingOdometry::Params::computed_parameter_names().begin(),
                                            RollingOdometry::Params::computed_parameter_names().end());
  return all;
}

RollingOdometry::Params rolling_params(const nb::kwargs& given) {
  Keywords keywords("RollingOdometry", given);
  RollingOdometry::Params params;
  const nb::object units = keywords.need("units");
  keywords.need("radius_m");
  if (!nb::isinstance<nb::iterable>(units))
    raise_input("type", "units", units.type(), nb::str("pairs (ImuDataSheet, T_BI)"));
  for (const nb::handle unit : units) {
    const nb::object pair = nb::borrow(unit);
    if (!nb::isinstance<nb::tuple>(pair) || nb::len(pair) != 2) {
      raise_input("type", "units", nb::str(pair), nb::str("pairs (ImuDataSheet, T_BI)"));
    }
    ImuDataSheet sheet;
    if (!nb::try_cast(nb::object(pair[0]), sheet))
      raise_input("type", "units", nb::str(pair), nb::str("pairs (ImuDataSheet, T_BI)"));
    params.imus.push_back({sheet, pose_of(pair[1], "units T_BI")});
  }
  read_fields(keywords, params, derived_rolling_parameters());
  keywords.done();
  return params;
}

RollingEstimate as_estimate(const RollingOdometry::Pose& p) {
  return {p.pose.time_ns,
          p.pose.position_W_m,
          p.pose.orientation_W,
          p.pose.velocity_W_m_s,
          p.angular_velocity_B_rad_s,
          p.pose.covariance,
          p.velocity_covariance_B_m2_s2,
          p.contact_mode,
          p.at_rest,
          p.position_uncertain};
}

/// Returns the samples of all IMUs. The input is one triple of arrays, or lists with one array per IMU. All IMUs share
/// `time_ns`.
std::vector<std::vector<ImuSample>> samples_of_units(const ArrayLike& time_ns, const ArrayLike& gyro,
                                                     const ArrayLike& accel, std::size_t units) {
  if (units == 1 && !nb::isinstance<nb::list>(gyro)) return {samples_of(time_ns, gyro, accel, nb::none())};
  std::vector<std::vector<ImuSample>> out;
  for (std::size_t k = 0; k < units; ++k) {
    for (const auto& [name, list] : {std::pair{"gyro", gyro}, std::pair{"accel", accel}}) {
      if (!nb::isinstance<nb::list>(list) || nb::len(list) != units) {
        raise_input("shape", name, list.type(),
                    nb::str(("a list of " + std::to_string(units) + " arrays, one per unit").c_str()));
      }
    }
    out.push_back(samples_of(time_ns, gyro[k], accel[k], nb::none()));
  }
  return out;
}

RollingPoses take_all(RollingOdometry& odometry) {
  RollingPoses out;
  while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) out.rows.push_back(as_estimate(*pose));
  return out;
}

/// BoundRollingOdometry is a RollingOdometry with the number of its IMUs.
struct BoundRollingOdometry {
  RollingOdometry odometry;
  std::size_t units;
};

void bind_unit(nb::module_& m) {
  using U = MergedImuState;
  nb::class_<U>(m, "SphereUnit",
                "State of one IMU of a sphere, from a comparison with the other IMUs. A sphere with a single IMU has "
                "no such state.")
      .def_ro("frozen", &U::is_frozen, "True if its readings are constant while the readings of the other units change")
      .def_ro("disagrees", &U::disagrees,
              "True if the unit is excluded, because it has disagreed with the other units for a long time")
      .def_ro("left_out", &U::excluded_window_count, "number of windows in which its specific force was excluded")
      .def_ro("absent", &U::missing_samples, "number of samples that were not finite")
      .def_prop_ro("time_offset_s", &U::offset_s, "offset of its clock from the mean of all units")
      .def_prop_ro(
          "rate_bias_rad_s", [](const U& u) { return whole<3>(u.x.data()); },
          "(3,), bias relative to the mean of all units");
}

void bind_rolling_odometry(nb::module_& m) {
  using Object = Guarded<BoundRollingOdometry>;
  nb::class_<Object> bound(
      m, "RollingOdometry",
      "Estimates the pose of a rolling sphere from one to four IMUs, through grip, slip, bumps and slopes. Poses are "
      "live,\n"
      "smoothed with a lag of lag_s, or smoothed with the whole recording (lag_s=1e9: all poses come after "
      "finish()).\n\n"
      "RollingOdometry(units=[(ImuDataSheet, T_BI), ...], radius_m=..., **options): T_BI (4, 4) is the pose of a unit "
      "in\n"
      "sphere axes, relative to the centre. parameters() lists the options. World: z up, origin at the centre at the "
      "first\n"
      "sample, yaw 0. The sphere must be stationary for the first second.");
  bound
      .def(
          "__init__",
          [](Object* self, const nb::kwargs& options) {
            const RollingOdometry::Params params = rolling_params(options);
            new (self) Object(BoundRollingOdometry{RollingOdometry(params), params.imus.size()});
          },
          nb::arg("options"), takes_options())
      .def(
          "add_imu",
          [](Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel) {
            const std::size_t units = self.run([](BoundRollingOdometry& rolling) { return rolling.units; });
            const std::vector<std::vector<ImuSample>> all = samples_of_units(time_ns, gyro, accel, units);
            Status status;
            std::size_t k = 0;
            const std::optional<TimeNs> last_ns = self.run_timed([&](BoundRollingOdometry& rolling, LastTimes& last) {
              std::vector<ImuSample> now(units);
              for (; k < all.front().size(); ++k) {
                for (std::size_t unit = 0; unit < units; ++unit) now[unit] = all[unit][k];
                status = rolling.odometry.add_imus(now);
                if (!may_continue(status)) break;
                if (status.ok()) last.sample_ns = now.front().time_ns;
              }
              return last.sample_ns;
            });
            if (k < all.front().size()) require(status, k, nb::none(), {all.front()[k].time_ns, last_ns});
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
          "Adds the readings of all units at one time or at N times: arrays for one unit, lists with one array per "
          "unit for\n"
          "several. NaN marks a missing reading of a unit. Leaves out the first time after a gap of more than a "
          "second, "
          "and\n"
          "continues with the next time.")
      .def(
          "newest",
          [](Object& self) {
            RollingPoses out;
            self.run([&](BoundRollingOdometry& rolling) {
              if (const auto pose = rolling.odometry.newest()) out.rows.push_back(as_estimate(*pose));
            });
            return out;
          },
          "Returns the live pose at the newest sample; no row before the first sample.")
      .def(
          "take",
          [](Object& self) {
            return self.run([](BoundRollingOdometry& rolling) { return take_all(rolling.odometry); });
          },
          "Returns the poses that became available since the last call, each once: lag_s old, or live if lag_s is 0.")
      .def(
          "health",
          [](Object& self) {
            return self.run([](BoundRollingOdometry& rolling) { return rolling.odometry.health().findings; });
          },
          nb::sig("def health(self) -> list[HealthFinding]"), kHealth)
      .def(
          "finish",
          [](Object& self) {
            require(self.run([](BoundRollingOdometry& rolling) { return rolling.odometry.finish(); }));
          },
          "Ends the estimation and smooths the remaining poses, which take() returns. reset() starts the next run.")
      .def(
          "reset", [](Object& self) { self.run([](BoundRollingOdometry& rolling) { rolling.odometry.reset(); }); },
          "Starts a new run, stationary at the origin.")
      .def_prop_ro(
          "rejected_readings",
          [](Object& self) {
            return self.run([](BoundRollingOdometry& rolling) { return rolling.odometry.rejected_readings(); });
          },
          "number of readings of all units that were rejected as outliers")
      .def_prop_ro(
          "estimated_jitter_s",
          [](Object& self) {
            return self.run([](BoundRollingOdometry& rolling) { return rolling.odometry.estimated_jitter_s(); });
          },
          "standard deviation of the stamps about a regular clock, while that clock replaces them; else None")
      .def_prop_ro(
          "started_in_motion",
          [](Object& self) {
            return self.run([](BoundRollingOdometry& rolling) { return rolling.odometry.started_in_motion(); });
          },
          "True if the sphere moved at the first samples; the initial attitude then has a larger uncertainty")
      .def_prop_ro(
          "units",
          [](Object& self) {
            return self.run([](BoundRollingOdometry& rolling) {
              const auto& all = rolling.odometry.imu_merge_state().imus;
              return std::vector<MergedImuState>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(rolling.units));
            });
          },
          "state of each unit, from a comparison of the units, in the order of `units`")
      .def_static("parameters", [] { return list_fields(RollingOdometry::Params{}, derived_rolling_parameters()); });
  bind_copy<Object>(bound);
  bind_saving<BoundRollingOdometry>(bound,
                                    [](BoundRollingOdometry& self) -> RollingOdometry& { return self.odometry; });
}

}  // namespace

void bind_rolling(nb::module_& m) {
  nb::enum_<ContactMode>(m, "ContactMode", nb::is_arithmetic(), "Type of contact between sphere and floor.")
      .value("grip", ContactMode::grip, "the contact point does not slide, and the floor is level")
      .value("slip", ContactMode::slip, "the contact point slides along the floor")
      .value("bump_or_flight", ContactMode::bump_or_flight, "the contact point also moves up or down")
      .value("incline", ContactMode::incline, "the contact point does not slide, and the floor is a slope")
      .value("rough", ContactMode::rough, "the contact point does not slide, and the floor is uneven");
  bind_rolling_smoother(m);
  bind_unit(m);
  bind_rolling_odometry(m);
}

}  // namespace tumble::python
