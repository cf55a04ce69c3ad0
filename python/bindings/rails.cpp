// SPDX-License-Identifier: BSD-3-Clause
#include "rails.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "streams.hpp"
#include "trouble.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble::python {

namespace {

using Found = ClippingFinder::ClippingSearchResult;

constexpr ParameterInfo kGyroRange{"gyro_range_rad_s", "rad/s", 1e-9, 1e3, "range that the data sheet states"};
constexpr ParameterInfo kAccelRange{"accel_range_m_s2", "m/s^2", 1e-9, 1e5, "range that the data sheet states"};

std::optional<double> range_of(Keywords& keywords, const ParameterInfo& field) {
  const nb::object given = keywords.take(field.name);
  if (!given.is_valid() || given.is_none()) return std::nullopt;
  double value = 0.0;
  keywords.read(field.name, field, false, value);
  return value;
}

Found find_rails(const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel, const ArrayLike& clip_flags,
                 const nb::kwargs& given) {
  Keywords keywords("find_rails", given);
  ClippingFinder::Params params;
  read_ranges(keywords, params.axis_limit_params);
  read_fields(keywords, params);
  keywords.done();
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  Found found;
  Status status;
  {
    const nb::gil_scoped_release released;
    status = check_recording(samples, 2, 3600.0);
    if (status.ok()) found = ClippingFinder(params).find(samples);
  }
  require(status, samples);
  return found;
}

auto bits(const Found& found, std::uint8_t Clipping::*which) {
  return column<std::uint8_t>(found.clipping_per_sample, [which](const Clipping& c) { return &(c.*which); });
}

}  // namespace

void read_ranges(Keywords& keywords, SaturationLimitDetector::Params& rails) {
  rails.stated_gyro_range_rad_s = range_of(keywords, kGyroRange);
  rails.stated_accel_range_m_s2 = range_of(keywords, kAccelRange);
}

nb::list as_list(const SaturationPlanes& planes) {
  nb::list out;
  for (const std::optional<SaturationPlane>& plane : planes.sensing_axis)
    out.append(plane ? nb::cast(*plane) : nb::none());
  return out;
}

void bind_rails(nb::module_& m) {
  nb::class_<SaturationPlane>(
      m, "SaturationPlane",
      "The rail of one sensing element, estimated from readings: the planes row . y = offset -+ distance.")
      .def_prop_ro(
          "row", [](const SaturationPlane& p) { return whole<3>(p.row.data()); },
          "(3,): 1 along the element's own axis, and the slopes of the plane along the other two axes")
      .def_ro("distance", &SaturationPlane::saturation_limit_rad_s, "rad/s for a gyro, m/s^2 for an accelerometer")
      .def_ro("offset", &SaturationPlane::offset_rad_s)
      .def_ro("tolerance", &SaturationPlane::tolerance_rad_s,
              "a reading is clipped if it is within this distance of the plane, or beyond the plane")
      .def_ro("samples", &SaturationPlane::samples, "number of samples on the negative and on the positive plane")
      .def_ro("log_odds", &SaturationPlane::log_odds, "log odds of a rail versus a motion that resembles one");
  nb::class_<Found>(m, "Rails", "The rails of an IMU, and the readings of a recording that are clipped.")
      .def_prop_ro(
          "gyro", [](const Found& f) { return as_list(f.saturation_levels.gyro_planes); },
          nb::for_getter(nb::sig("def gyro(self) -> list[SaturationPlane | None]")),
          "planes of the gyro elements x, y, z: a SaturationPlane each, or None if no rail was detected")
      .def_prop_ro(
          "accel", [](const Found& f) { return as_list(f.saturation_levels.accel_saturation_planes); },
          nb::for_getter(nb::sig("def accel(self) -> list[SaturationPlane | None]")))
      .def_prop_ro(
          "upright", [](const Found& f) { return f.saturation_levels.gyro_clips_after_compensation; },
          "True if the device clips its output axes; clipping of one axis then leaves the other axes unaffected")
      .def_prop_ro(
          "clipped_gyro", [](const Found& f) { return bits(f, &Clipping::gyro); },
          "(N,) uint8, bit j: axis j is clipped; the true value is at or beyond the reading")
      .def_prop_ro("clipped_accel", [](const Found& f) { return bits(f, &Clipping::accel); })
      .def_prop_ro(
          "unusable_gyro", [](const Found& f) { return bits(f, &Clipping::unusable_gyro); },
          "(N,) uint8, bit j: the reading of axis j is invalid (its sign flipped at the rail)");
  m.def(
      "find_rails", &find_rails, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
      nb::arg("clip_flags") = nb::none(), nb::arg("options"),
      nb::sig("def find_rails(time_ns: numpy.typing.ArrayLike, gyro: numpy.typing.ArrayLike, accel: "
              "numpy.typing.ArrayLike, "
              "clip_flags: numpy.typing.ArrayLike | None = None, **options: object) -> Rails"),
      "Detects which readings of a recording are clipped. Needs neither flags nor a stated range: searches for level\n"
      "plateaus and tilted planes. gyro_range_rad_s, accel_range_m_s2: the ranges that the data sheet states, or "
      "None.\n"
      "Further keywords: see rails_parameters().");
  m.def(
      "rails_parameters", [] { return list_fields(ClippingFinder::Params{}); }, "Lists the keywords of find_rails.");
}

}  // namespace tumble::python
