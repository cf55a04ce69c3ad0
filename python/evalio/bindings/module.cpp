// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <stdexcept>
#include <string>

#include "feed.hpp"
#include "nb_abi.h"

namespace nb = nanobind;

namespace {

/// Classes are shared between modules of one ABI of nanobind alone.
void require_abi(const std::string& of_evalio) {
  if (of_evalio == NB_ABI_TAG) return;
  throw std::runtime_error(
      "tumble-evalio is compiled for nanobind's ABI " NB_ABI_TAG ", evalio here has " + of_evalio +
      ": install evalio >= 0.6.1, < 0.7, or compile tumble-evalio anew beside the evalio that is there");
}

}  // namespace

NB_MODULE(tumble_evalio, m) {
  using tumble::evalio_bindings::Feed;
  m.doc() = "The compiled half of tumble.evalio, which is what to use.";
  m.def("require_abi", &require_abi, nb::arg("of_evalio"), "RuntimeError unless this was compiled for that ABI.");
  require_abi(nb::cast<std::string>(nb::module_::import_("evalio").attr("_abi_tag")()));
  nb::class_<Feed, evalio::Pipeline>(m, "Feed", "A pipeline of evalio over an estimator that `begin` is given.")
      .def(nb::init<>())
      .def("begin", &Feed::begin, nb::arg("odometry"), nb::arg("sweep_length_ns"),
           "odometry: has add_imu, add_sweep, take_all, window_trajectory, finish and map, as TumblingOdometry.")
      .def("finish", &Feed::finish,
           "At the end of a run: saves what has not been saved. A sweep that the IMU did not cover has no pose.");
}
