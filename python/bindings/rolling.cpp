// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
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
#include "streams.hpp"
#include "tumble/odometry/rolling_odometry.hpp"
#include "tumble/rolling/rolling_filter.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

namespace tumble::python {

namespace {

void bind_rolling_smoother(nb::module_& m) {
  using Object = Guarded<Streaming<RollingSmoother>>;
  nb::class_<Object> bound(
      m, "RollingSmoother",
      "Pose of a rolling sphere from one IMU, smoothed with a fixed lag or, by default, over the whole run.\n\n"
      "RollingSmoother(radius_m=..., lever_arm_m=(x, y, z), **options): lever_arm_m from the centre to the IMU, "
      "sensor\n"
      "axes; options: parameters(). Begin with a second of rest.");
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
          "Takes one sample or many; returns the poses that are old enough with them.")
      .def(
          "finish",
          [](Object& self) {
            RollingPoses out;
            self.run([&](Streaming<RollingSmoother>& at) { at.filter.finish(*at.state, out.rows); });
            return out;
          },
          "The poses that are still owed. The run has ended.")
      .def_static("parameters", [] { return list_fields(RollingSmoother::Params{}); });
  bind_keeping<RollingSmoother>(bound);
}

void bind_filter(nb::module_& m) {
  using Live = Streaming<RollingFilter>;
  using Object = Guarded<Live>;
  nb::class_<Object> bound(
      m, "RollingFilter",
      "Pose of a rolling sphere from one IMU, live: each by what came before it. RollingSmoother also hears what "
      "follows.\n\n"
      "RollingFilter(radius_m=..., lever_arm_m=(x, y, z), **options): as RollingSmoother; options: parameters().");
  bound
      .def(
          "__init__",
          [](Object* self, const nb::kwargs& options) {
            Keywords keywords("RollingFilter", options);
            keywords.need("radius_m");
            RollingFilter::Params params;
            read_fields(keywords, params);
            keywords.done();
            new (self) Object(Live(params));
          },
          nb::arg("options"), takes_options())
      .def(
          "add_imu",
          [](Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel,
             const ArrayLike& clip_flags) {
            const auto step = [](Live& at, const ImuSample& sample, RollingPoses& out) {
              const Status status = at.filter.step(sample, *at.state);
              if (status.ok()) out.rows.push_back(RollingFilter::estimate(*at.state));
              return status;
            };
            return feed<RollingPoses>(self, samples_of(time_ns, gyro, accel, clip_flags), step);
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"), nb::arg("clip_flags") = nb::none(),
          "Takes one sample or many; returns the pose at each. Of the covariance the place alone is known; zero: the "
          "rest.")
      .def_prop_ro(
          "slip_probability",
          [](Object& self) { return self.run([](Live& at) { return at.state->slip_probability; }); },
          "that the contact moves, over all hypotheses")
      .def_prop_ro(
          "bump_probability",
          [](Object& self) { return self.run([](Live& at) { return at.state->bump_probability; }); },
          "the part of slip_probability in which the sphere hops")
      .def_prop_ro(
          "contact_velocity",
          [](Object& self) {
            const Eigen::Vector3d v = self.run([](Live& at) { return at.state->contact_velocity_m_s; });
            return owned(std::vector<double>(v.begin(), v.end()));
          },
          nb::rv_policy::automatic, "(3,), m/s, W: of the sphere's material point that touches the floor")
      .def_prop_ro(
          "gaps", [](Object& self) { return self.run([](Live& at) { return at.state->gaps; }); },
          "between samples, that were bridged")
      .def_prop_ro(
          "started_in_motion",
          [](Object& self) { return self.run([](Live& at) { return at.state->started_in_motion; }); },
          "its attitude is believed less then")
      .def_static("parameters", [] { return list_fields(RollingFilter::Params{}); });
  bind_keeping<RollingFilter>(bound);
}

/// The door's own numbers, and what its sheets say, take the place of these.
const std::vector<const char*> kOfTheDoor = {"merge_count",
                                             "merge_gyro_range_rad_s",
                                             "merge_accel_range_m_s2",
                                             "rolling_radius_m",
                                             "rolling_gravity_m_s2",
                                             "rolling_lever_arm_m",
                                             "rolling_lever_arm_sigma_m",
                                             "rolling_gyro_range_rad_s",
                                             "rolling_accel_range_m_s2",
                                             "rolling_recovered_rate_sigma_rad_s",
                                             "rolling_lag_s"};

RollingOdometry::Params door_params(const nb::kwargs& given) {
  Keywords keywords("RollingOdometry", given);
  RollingOdometry::Params params;
  const nb::object units = keywords.need("units");
  keywords.need("radius_m");
  if (!nb::isinstance<nb::iterable>(units))
    raise_input("type", "units", units.type(), nb::str("pairs (ImuSheet, T_BI)"));
  for (const nb::handle unit : units) {
    const nb::object pair = nb::borrow(unit);
    if (!nb::isinstance<nb::tuple>(pair) || nb::len(pair) != 2) {
      raise_input("type", "units", nb::str(pair), nb::str("pairs (ImuSheet, T_BI)"));
    }
    ImuSheet sheet;
    if (!nb::try_cast(nb::object(pair[0]), sheet))
      raise_input("type", "units", nb::str(pair), nb::str("pairs (ImuSheet, T_BI)"));
    params.units.push_back({sheet, pose_of(pair[1], "units T_BI")});
  }
  read_fields(keywords, params, kOfTheDoor);
  keywords.done();
  return params;
}

RollingEstimate as_estimate(const RollingOdometry::Pose& p) {
  return {p.pose.time_ns,    p.pose.p_WA_m, p.pose.q_WA, p.pose.v_WA_m_s,
          p.pose.covariance, p.mode,        p.at_rest,   p.uncertain};
}

/// Samples of all units: one triple of arrays, or a list with one for each unit. The first's times count.
std::vector<std::vector<ImuSample>> samples_of_units(const ArrayLike& time_ns, const ArrayLike& gyro,
                                                     const ArrayLike& accel, std::size_t units) {
  if (units == 1 && !nb::isinstance<nb::list>(gyro)) return {samples_of(time_ns, gyro, accel, nb::none())};
  std::vector<std::vector<ImuSample>> out;
  for (std::size_t k = 0; k < units; ++k) {
    for (const auto& [name, list] : {std::pair{"gyro", gyro}, std::pair{"accel", accel}}) {
      if (!nb::isinstance<nb::list>(list) || nb::len(list) != units) {
        raise_input("shape", name, list.type(),
                    nb::str(("a list of " + std::to_string(units) + " arrays, one a unit").c_str()));
      }
    }
    out.push_back(samples_of(time_ns, gyro[k], accel[k], nb::none()));
  }
  return out;
}

RollingPoses taken(RollingOdometry& odometry) {
  RollingPoses out;
  while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) out.rows.push_back(as_estimate(*pose));
  return out;
}

/// The door, with how many units it has.
struct Door {
  RollingOdometry odometry;
  std::size_t units;

  std::vector<std::byte> save() const { return odometry.save(); }
  Status load(std::span<const std::byte> bytes) { return odometry.load(bytes); }
};

Door restored_door(std::span<const std::byte> bytes) {
  RollingOdometry::Params params;
  require(RollingOdometry::saved_params(bytes, params));
  Door out{RollingOdometry(params), params.units.size()};
  require(out.load(bytes));
  return out;
}

void bind_unit(nb::module_& m) {
  using U = ImuMergeUnit;
  nb::class_<U>(m, "SphereUnit", "What the IMUs of a sphere say of one of them. Of one alone nothing is said.")
      .def_ro("frozen", &U::frozen, "it repeats itself while the others move")
      .def_ro("disagrees", &U::disagrees, "it is off from the others for long, and left out")
      .def_ro("left_out", &U::left_out, "windows in which it was left out of the force")
      .def_ro("absent", &U::absent, "samples that were not finite")
      .def_prop_ro("time_offset_s", &U::offset_s, "of its clock about the mean of all")
      .def_prop_ro(
          "rate_bias_rad_s", [](const U& u) { return whole<3>(u.x.data()); }, "(3,), about the mean of all");
}

void bind_door(nb::module_& m) {
  using Object = Guarded<Door>;
  nb::class_<Object> bound(
      m, "RollingOdometry",
      "Pose of a rolling sphere from one to four IMUs, through grip, slip, bumps and slopes: live, and smoothed with "
      "what\n"
      "follows within lag_s.\n\n"
      "RollingOdometry(units=[(ImuSheet, T_BI), ...], radius_m=..., **options): T_BI (4, 4) places a unit in axes of "
      "the\n"
      "sphere, from its centre. Options: parameters(). World: z up, origin at the centre at the first sample, yaw 0.\n"
      "Begin with a second of rest.");
  bound
      .def(
          "__init__",
          [](Object* self, const nb::kwargs& options) {
            const RollingOdometry::Params params = door_params(options);
            new (self) Object(Door{RollingOdometry(params), params.units.size()});
          },
          nb::arg("options"), takes_options())
      .def(
          "add_imu",
          [](Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel) {
            const std::size_t units = self.run([](Door& door) { return door.units; });
            const std::vector<std::vector<ImuSample>> all = samples_of_units(time_ns, gyro, accel, units);
            Status status;
            std::size_t k = 0;
            const std::optional<TimeNs> last_ns = self.run_timed([&](Door& door, LastTimes& last) {
              std::vector<ImuSample> now(units);
              for (; k < all.front().size(); ++k) {
                for (std::size_t unit = 0; unit < units; ++unit) now[unit] = all[unit][k];
                status = door.odometry.add_imus(now);
                if (!status.ok()) break;
                last.sample_ns = now.front().time_ns;
              }
              return last.sample_ns;
            });
            if (!status.ok()) require(status, k, nb::none(), {all.front()[k].time_ns, last_ns});
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
          "Takes what all units read at one time, or at N: of one unit arrays, of several lists with one for each "
          "unit.\n"
          "A unit that has nothing to say gives NaN.")
      .def(
          "newest",
          [](Object& self) {
            RollingPoses out;
            self.run([&](Door& door) {
              if (const auto pose = door.odometry.newest()) out.rows.push_back(as_estimate(*pose));
            });
            return out;
          },
          "Pose at the newest sample by what came before it; no row before the first.")
      .def(
          "take", [](Object& self) { return self.run([](Door& door) { return taken(door.odometry); }); },
          "The poses that have become known since the last call, each once: lag_s old, or live ones without a lag.")
      .def(
          "doubt", [](Object& self) { return doubt_of(self.run([](Door& door) { return door.odometry.doubt(); })); },
          nb::sig("def doubt(self) -> tumble.errors.TumbleError | None"), kDoubt)
      .def(
          "finish", [](Object& self) { self.run([](Door& door) { door.odometry.finish(); }); },
          "Smooths what is still within the lag: the run has ended, until reset(). take() gives it.")
      .def(
          "reset", [](Object& self) { self.run([](Door& door) { door.odometry.reset(); }); },
          "Begins a new run: at the origin, at rest.")
      .def_prop_ro(
          "rejected_readings",
          [](Object& self) { return self.run([](Door& door) { return door.odometry.rejected_readings(); }); },
          "number of readings that were rejected because they are wild, over all units")
      .def_prop_ro(
          "mended_jitter_s",
          [](Object& self) { return self.run([](Door& door) { return door.odometry.mended_jitter_s(); }); },
          "standard deviation of the stamps about a regular clock, while that clock's times count for them; else None")
      .def_prop_ro(
          "units",
          [](Object& self) {
            return self.run([](Door& door) {
              const auto& all = door.odometry.units().units;
              return std::vector<ImuMergeUnit>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(door.units));
            });
          },
          "What the units say of each other, in their order.")
      .def_static("parameters", [] { return list_fields(RollingOdometry::Params{}, kOfTheDoor); });
  bind_copy<Object>(bound);
  bind_saving<Door>(bound, &restored_door);
}

}  // namespace

void bind_rolling(nb::module_& m) {
  nb::enum_<RollingMode>(m, "RollingMode", nb::is_arithmetic(), "How the sphere meets the floor.")
      .value("grip", RollingMode::grip, "the contact point stands still, the floor is level")
      .value("slip", RollingMode::slip, "it moves along the floor")
      .value("bump", RollingMode::bump, "it also rises or falls")
      .value("incline", RollingMode::incline, "it stands still on a slope")
      .value("rough", RollingMode::rough, "it stands still, the floor goes up and down");
  bind_filter(m);
  bind_rolling_smoother(m);
  bind_unit(m);
  bind_door(m);
}

}  // namespace tumble::python
