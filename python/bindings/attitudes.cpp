// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "results.hpp"
#include "streams.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"
#include "tumble/attitude/detail/vqf.hpp"

namespace tumble::python {

namespace {

/// Binds a filter that processes one sample at a time and estimates the attitude q_WI.
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
          nb::arg("options"), takes_options())
      .def(
          "add_imu",
          [](Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel,
             const ArrayLike& clip_flags) {
            const auto step = [](Running<Filter>& at, const ImuSample& sample, Attitudes& out) {
              const Status status = at.filter.step(sample, at.state);
              if (status.ok()) out.rows.push_back({sample.time_ns, at.state.q_WI, Eigen::Matrix3d::Zero()});
              return status;
            };
            return feed<Attitudes>(self, samples_of(time_ns, gyro, accel, clip_flags), step);
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"), nb::arg("clip_flags") = nb::none(),
          "Adds one sample or many. Returns the attitude at each sample. The first sample sets roll and pitch, with "
          "yaw 0.")
      .def_static("parameters", [] { return list_fields(typename Filter::Params{}); });
  bind_copy<Object>(bound);
  return bound;
}

}  // namespace

void bind_attitudes(nb::module_& m) {
  bind_filter<Vqf>(
      m, "Vqf",
      "Estimates attitude from gyro and accelerometer with the versatile quaternion filter (D. Laidig, T. Seel,\n"
      "Information Fusion 91, 2023). Vqf(**options): see parameters().");
  bind_filter<TumbleAttitude>(
      m, "TumbleAttitude",
      "Estimates attitude from gyro and accelerometer. Assumes that the velocity is bounded, and zero when "
      "stationary.\n"
      "With radius_m above 0 the body is a rolling sphere. TumbleAttitude(**options): see parameters().")
      .def_prop_ro("at_rest", [](Guarded<Running<TumbleAttitude>>& self) {
        return self.run([](Running<TumbleAttitude>& at) { return at.state.at_rest; });
      });
  bind_filter<Strapdown>(m, "Strapdown",
                         "Estimates attitude by integrating the gyro alone. Strapdown(**options): see parameters().");
}

}  // namespace tumble::python
