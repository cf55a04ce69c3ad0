// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "rails.hpp"
#include "results.hpp"
#include "streams.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"
#include "tumble/attitude/carried_elements.hpp"
#include "tumble/attitude/carried_smoother.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/attitude/tumble_attitude.hpp"
#include "tumble/attitude/vqf.hpp"

namespace tumble::python {

namespace {

/// A filter of samples whose state has the attitude q_WI.
template <class Filter>
auto bind_filter(nb::module_& m, const char* name, const char* doc) {
  using Object = Guarded<Running<Filter>>;
  nb::class_<Object> bound(m, name, doc);
  bound
      .def(
          "__init__",
          [name](Object* self, const nb::kwargs& options) {
            Keywords keywords(name, options);
            typename Filter::Params params;
            read_fields(keywords, params);
            keywords.done();
            new (self) Object(Running<Filter>{Filter(params), {}});
          },
          nb::arg("options"))
      .def(
          "add_imu",
          [](Object& self, nb::handle time_ns, nb::handle gyro, nb::handle accel, nb::handle clip_flags) {
            const auto step = [](Running<Filter>& at, const ImuSample& sample, Attitudes& out) {
              const Status status = at.filter.step(sample, at.state);
              if (status.ok()) out.rows.push_back({sample.time_ns, at.state.q_WI, Eigen::Matrix3d::Zero()});
              return status;
            };
            return feed<Attitudes>(self, samples_of(time_ns, gyro, accel, clip_flags), step);
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"), nb::arg("clip_flags") = nb::none(),
          "Takes one sample or many; returns the attitude at each. The first sample levels it, with yaw 0.")
      .def_static("parameters", [] { return list_fields(typename Filter::Params{}); });
  bind_copy<Object>(bound);
  return bound;
}

/// CarriedSmoother with what its data sheet says of the rails.
struct Carried {
  CarriedSmoother smoother;
  RailDetector::Params walls;
};

std::tuple<Rates, Attitudes, CarriedSmoother::Report> carried(const Carried& self, nb::handle time_ns, nb::handle gyro,
                                                              nb::handle accel, nb::handle clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  std::tuple<Rates, Attitudes, CarriedSmoother::Report> out;
  std::vector<RateState>& rates = std::get<0>(out).rows;
  Status status;
  {
    const nb::gil_scoped_release released;
    status = check_recording(samples, 2, 1.0);
    if (status.ok()) {
      ClippingFinder::Params finding;
      finding.walls = self.walls;
      const CarriedElements known = carried_elements(samples, ClippingFinder(finding).find(samples));
      status = self.smoother.estimate(samples, known.clipped(), rates, std::get<1>(out).rows, std::get<2>(out));
      if (status.ok()) known.mark_near(rates);
    }
  }
  require(status);
  return out;
}

void bind_carried(nb::module_& m) {
  using Report = CarriedSmoother::Report;
  nb::class_<Report>(m, "CarriedReport", "What a run of CarriedSmoother tells about itself.")
      .def_ro("iterations", &Report::iterations)
      .def_ro("converged", &Report::converged)
      .def_ro("cost", &Report::cost)
      .def_ro("hand_surprise", &Report::hand_surprise, "2 and more: thrown, or a rough hand")
      .def_ro("turns_asked", &Report::turns_asked)
      .def_ro("turns_taken", &Report::turns_taken)
      .def_ro("turns_open", &Report::turns_open, "clipped stretches in which another number of turns stays possible");
  nb::class_<Carried>(
      m, "CarriedSmoother",
      "Attitude and angular velocity of a body that is carried (held, swung, twirled), also where its gyro\n"
      "clips, over a whole recording.\n\n"
      "CarriedSmoother(gyro_range_rad_s=None, accel_range_m_s2=None, **options): parameters().")
      .def(
          "__init__",
          [](Carried* self, const nb::kwargs& options) {
            Keywords keywords("CarriedSmoother", options);
            CarriedSmoother::Params params;
            RailDetector::Params walls;
            read_ranges(keywords, walls);
            read_fields(keywords, params);
            keywords.done();
            new (self) Carried{CarriedSmoother(params), walls};
          },
          nb::arg("options"))
      .def("estimate", &carried, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(),
           "Rates, attitudes (heading 0 at the start), one of each per sample, and what the run tells of itself.")
      .def_static("parameters", [] { return list_fields(CarriedSmoother::Params{}); });
}

}  // namespace

void bind_attitudes(nb::module_& m) {
  bind_filter<Vqf>(
      m, "Vqf",
      "The versatile quaternion filter, gyro and accelerometer (D. Laidig, T. Seel, Information Fusion 91,\n"
      "2023). Vqf(**options): parameters().");
  bind_filter<TumbleAttitude>(
      m, "TumbleAttitude",
      "Attitude from gyro and accelerometer by what a body cannot do: its velocity is bounded, and at\n"
      "rest it is zero. radius_m above 0: of a rolling sphere. TumbleAttitude(**options): parameters().")
      .def_prop_ro("at_rest", [](Guarded<Running<TumbleAttitude>>& self) {
        return self.run([](Running<TumbleAttitude>& at) { return at.state.at_rest; });
      });
  bind_filter<Strapdown>(m, "Strapdown",
                         "Attitude by integration of the gyro alone. Strapdown(**options): parameters().");
  bind_carried(m);
}

}  // namespace tumble::python
