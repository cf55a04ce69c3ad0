// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "rails.hpp"
#include "results.hpp"
#include "trouble.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble::python {

namespace {

/// Carried holds a HandHeldSmoother and the measurement ranges from the IMU's data sheet.
struct Carried {
  HandHeldSmoother smoother;
  SaturationLimitDetector::Params axis_aligned_rails;
};

std::tuple<Rates, Attitudes, HandHeldSmoother::Report> hand_held(const Carried& self, const ArrayLike& time_ns,
                                                                 const ArrayLike& gyro, const ArrayLike& accel,
                                                                 const ArrayLike& clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  std::tuple<Rates, Attitudes, HandHeldSmoother::Report> out;
  std::vector<AngularRateState>& rates = std::get<0>(out).rows;
  Status status;
  {
    const nb::gil_scoped_release released;
    status = check_recording(samples, 2, 1.0);
    if (status.ok()) {
      ClippingFinder::Params finding;
      finding.axis_limit_params = self.axis_aligned_rails;
      const ClippedReadings known = clipped_readings_of(samples, ClippingFinder(finding).find(samples));
      status = self.smoother.estimate(samples, known.clipped_element_signs(), rates, std::get<1>(out).rows,
                                      std::get<2>(out));
      if (status.ok()) known.mark_partly_saturated(rates);
    }
  }
  require(status, samples);
  return out;
}

void bind_smoother(nb::module_& m) {
  using Report = HandHeldSmoother::Report;
  nb::class_<Report>(m, "HandHeldReport", "Statistics of a run of HandHeldSmoother.")
      .def_ro("iterations", &Report::iterations)
      .def_ro("converged", &Report::converged)
      .def_ro("cost", &Report::cost)
      .def_ro("revolutions_tested", &Report::revolutions_tested)
      .def_ro("revolutions_corrected", &Report::revolutions_corrected)
      .def_ro("revolutions_ambiguous", &Report::revolutions_ambiguous,
              "clipped segments in which another number of turns remains possible");
  nb::class_<Carried>(
      m, "HandHeldSmoother",
      "Estimates attitude and angular velocity of a hand-held body (held, swung, twirled) over a whole recording,\n"
      "also where its gyro clips.\n\n"
      "HandHeldSmoother(gyro_range_rad_s=None, accel_range_m_s2=None, **options): see parameters().")
      .def(
          "__init__",
          [](Carried* self, const nb::kwargs& options) {
            Keywords keywords("HandHeldSmoother", options);
            HandHeldSmoother::Params params;
            SaturationLimitDetector::Params axis_aligned_rails;
            read_ranges(keywords, axis_aligned_rails);
            read_fields(keywords, params);
            keywords.done();
            new (self) Carried{HandHeldSmoother(params), axis_aligned_rails};
          },
          nb::arg("options"), takes_options())
      .def("estimate", &hand_held, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(),
           "Returns rates and attitudes (heading 0 at the start), one of each per sample, and a HandHeldReport.")
      .def_static("parameters", [] { return list_fields(HandHeldSmoother::Params{}); });
}

}  // namespace

void bind_carried(nb::module_& m) {
  bind_smoother(m);
}

}  // namespace tumble::python
