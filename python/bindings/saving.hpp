// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "guarded.hpp"
#include "trouble.hpp"
#include "tumble/common/types.hpp"

namespace tumble::python {

/// Returns the bytes of a saved run or map. Raises TumbleError `type` if `given` is not of type bytes.
inline std::span<const std::byte> state_of(nb::handle given) {
  if (!nb::isinstance<nb::bytes>(given)) raise_input("type", "state", given.type(), nb::str("bytes"));
  const auto bytes = nb::borrow<nb::bytes>(given);
  return {reinterpret_cast<const std::byte*>(bytes.c_str()), bytes.size()};
}

/// Binds save() and load() of an odometry class, which `odometry_in(T&)` returns.
template <class T, class Class, class OdometryIn>
void bind_saving(Class& bound, OdometryIn odometry_in) {
  using Object = Guarded<T>;
  bound
      .def(
          "save",
          [odometry_in](Object& self) {
            const std::vector<std::byte> bytes = self.run([&](T& inside) { return odometry_in(inside).save(); });
            return nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          nb::sig("def save(self) -> bytes"),
          "Returns calibration, saturation limits, newest pose and map (TumblingOdometry) with a checksum, for load().")
      .def(
          "load",
          [odometry_in](Object& self, nb::handle state) {
            const std::span<const std::byte> bytes = state_of(state);
            std::optional<PoseState> pose;
            require(self.run_timed([&](T& inside, LastTimes& last) {
              const Status status = odometry_in(inside).load(bytes, &pose);
              if (status.ok()) last = {};
              return status;
            }));
            return pose;
          },
          nb::arg("state"), nb::sig("def load(self, state: bytes) -> Pose | None"),
          "Starts a new run with the calibration and saturation limits that save() returned, at the saved pose, in the "
          "saved map.\n"
          "Returns the saved pose. Raises TumbleError if the bytes are damaged, or belong to another rig or another "
          "version of\n"
          "the library; the object is then unchanged.");
}

}  // namespace tumble::python
