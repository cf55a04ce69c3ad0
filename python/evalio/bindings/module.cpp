// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <stdexcept>
#include <string>

#include "feed.hpp"
#include "nb_abi.h"

namespace nb = nanobind;

namespace {

/// Modules can share classes only if they have the same nanobind ABI.
void require_abi(const std::string& of_evalio) {
  if (of_evalio == NB_ABI_TAG) return;
  throw std::runtime_error(
      "tumble-evalio is compiled for nanobind's ABI " NB_ABI_TAG ", but the installed evalio has " + of_evalio +
      "; install evalio >= 0.6.1, < 0.7, or compile tumble-evalio against the installed evalio");
}

}  // namespace

NB_MODULE(tumble_evalio, m) {
  using tumble::evalio_bindings::Feed;
  m.doc() = "The compiled part of tumble.evalio. Use tumble.evalio instead of this module.";
  m.def("require_abi", &require_abi, nb::arg("of_evalio"),
        "Raises RuntimeError if this module was compiled for another ABI.");
  require_abi(nb::cast<std::string>(nb::module_::import_("evalio").attr("_abi_tag")()));
  nb::class_<Feed, evalio::Pipeline>(m, "Feed", "An evalio pipeline for an estimator that is passed to `begin`.")
      .def(nb::init<>())
      .def("begin", &Feed::begin, nb::arg("odometry"), nb::arg("sweep_length_ns"),
           "odometry: an object with add_imu, add_sweep, take_all, window_trajectory, finish and map, as "
           "TumblingOdometry.")
      .def("finish", &Feed::finish,
           "Ends the estimation and saves the remaining poses. A sweep that the IMU did not cover has no pose.");
}
