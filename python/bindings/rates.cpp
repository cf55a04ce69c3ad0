// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parameters.hpp"
#include "rails.hpp"
#include "results.hpp"
#include "rig.hpp"
#include "streams.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/attitude/detail/regime_stream.hpp"

namespace tumble::python {

namespace {

/// Reads lever arm, calibration and measurement ranges, which are not numeric fields of `Params`.
void read_rig(Keywords& keywords, RateModelParams& model, RailDetector::Params& rails) {
  model.nominal.lever_arm_m = vector_of(keywords.need("lever_arm_m"), "lever_arm_m");
  const nb::object calibration = keywords.take("calibration");
  if (calibration.is_valid() && !calibration.is_none()) model.calibration = rig_of(calibration, "calibration");
  read_ranges(keywords, rails);
}

/// Returns the member of `params` that contains the rate model and the saturation limits.
RateSmoother::Params& rate_part(RateSmoother::Params& params) {
  return params;
}
RateStream::Params& rate_part(RateStream::Params& params) {
  return params;
}
RateSmoother::Params& rate_part(RegimeSmoother::Params& params) {
  return params.rate;
}
RateStream::Params& rate_part(RegimeStream::Params& params) {
  return params.rate;
}

template <class Class>
typename Class::Params params_of(const char* name, const nb::kwargs& given,
                                 const std::vector<const char*>& hidden = {}) {
  Keywords keywords(name, given);
  typename Class::Params params;
  read_rig(keywords, rate_part(params).model, rate_part(params).rails);
  read_fields(keywords, params, hidden);
  keywords.done();
  return params;
}

RateStream::Params stream_params(const nb::kwargs& given) {
  return params_of<RateStream>("RateStream", given);
}

/// RegimeStream derives these parameters from its RateStream. The HandHeldStream of RegimeStream makes one iteration
/// per node.
const std::vector<const char*> kDerivedRegimeParameters = {"carried_period_s", "carried_lag_s", "carried_gap_max_s",
                                                           "carried_iterations_max"};

RegimeStream::Params regime_params(const nb::kwargs& given) {
  RegimeStream::Params params = params_of<RegimeStream>("RegimeStream", given, kDerivedRegimeParameters);
  params.hand_held.body.expert.gap_max_s = params.rate.gap_max_s;
  return params;
}

template <class Smoother, class Report>
std::pair<Rates, Report> smooth(const Smoother& self, const ArrayLike& time_ns, const ArrayLike& gyro,
                                const ArrayLike& accel, const ArrayLike& clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  std::pair<Rates, Report> out;
  Status status;
  {
    const nb::gil_scoped_release released;
    status = self.estimate(samples, out.first.rows, out.second);
  }
  require(status, samples);
  return out;
}

Rates saave(const Saave& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel,
            const ArrayLike& clip_flags) {
  const std::vector<ImuSample> samples = samples_of(time_ns, gyro, accel, clip_flags);
  Rates out;
  Status status;
  {
    const nb::gil_scoped_release released;
    status = self.estimate(samples, out.rows);
  }
  require(status, samples);
  return out;
}

nb::dict shares_of(const RegimeProbabilities& shares) {
  nb::dict out;
  out["flight"] = shares.flight;
  out["contact"] = shares.contact;
  out["carried"] = shares.hand_held;
  return out;
}

void bind_batch(nb::module_& m) {
  nb::class_<RateReport>(m, "RateReport", "Statistics of a run of RateSmoother.")
      .def_ro("iterations", &RateReport::iterations)
      .def_ro("converged", &RateReport::converged)
      .def_ro("restarts", &RateReport::restarts)
      .def_ro("calibration", &RateReport::calibration,
              "estimated calibration of the rig, which the next run can start from")
      .def_ro("calibration_mahalanobis", &RateReport::calibration_mahalanobis,
              "distance of the calibration from its prior; a value far above 1 indicates a wrong prior")
      .def_ro("calibration_at_prior", &RateReport::calibration_at_prior,
              "True if the run did not update the calibration, which then equals its prior")
      .def_ro("rail", &RateReport::rail, "rails in use: gyro x y z [rad/s], accelerometer [m/s^2]; None: not detected")
      .def_prop_ro(
          "planes", [](const RateReport& r) { return as_list(r.planes); },
          nb::for_getter(nb::sig("def planes(self) -> list[RailPlane | None]")), "rails of the gyro elements")
      .def_ro("samples", &RateReport::samples)
      .def_ro("clipped", &RateReport::clipped)
      .def_ro("recovered_flight", &RateReport::recovered_flight)
      .def_ro("recovered_contact", &RateReport::recovered_contact)
      .def_ro("bounded_only", &RateReport::bounded_only)
      .def_ro("flight_share", &RateReport::flight_share)
      .def_prop_ro(
          "suspect_axes", [](const RateReport& r) { return owned(r.suspect_axes); }, nb::rv_policy::automatic,
          "(N,) uint8, bit j: axis j may be at a rail that was not detected");
  nb::class_<RateSmoother>(
      m, "RateSmoother",
      "Estimates the angular velocity of a tumbling body through gyro saturation, over a whole recording.\n\n"
      "RateSmoother(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None,\n"
      "calibration=None, **options): lever_arm_m is from the centre of mass to the IMU, in IMU axes.\n"
      "The ranges are those of the data sheet, or None. calibration is a RigCalibration of an earlier run.\n"
      "parameters() lists the options. The model covers flight and contact. For hand-held motion use RegimeSmoother "
      "or\n"
      "HandHeldSmoother; tumble.rate() uses RegimeSmoother.")
      .def(
          "__init__",
          [](RateSmoother* self, const nb::kwargs& options) {
            new (self) RateSmoother(params_of<RateSmoother>("RateSmoother", options));
          },
          nb::arg("options"), takes_options())
      .def("estimate", &smooth<RateSmoother, RateReport>, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(), "Returns one rate per sample, and a RateReport.")
      .def_static("parameters", [] { return list_fields(RateSmoother::Params{}); });
  using Joint = RegimeSmoother::Report;
  nb::class_<Joint>(m, "RegimeReport", "Statistics of a run of RegimeSmoother.")
      .def_ro("rate", &Joint::rate, "report of RateSmoother")
      .def_prop_ro(
          "shares", [](const Joint& r) { return shares_of(r.probabilities); },
          nb::for_getter(nb::sig("def shares(self) -> dict[str, float]")),
          "mean probabilities of flight, contact and hand-held motion")
      .def_ro("hand_held_probability_max", &Joint::hand_held_probability_max,
              "largest probability of hand-held motion in a clipped segment")
      .def_ro("hand_held_smoother_ran", &Joint::hand_held_smoother_ran, "whether HandHeldSmoother was used")
      .def_ro("carried", &Joint::hand_held, "report of HandHeldSmoother, if it was used");
  nb::class_<RegimeSmoother>(
      m, "RegimeSmoother",
      "Estimates the angular velocity of a body in flight, contact or hand-held motion, over a\n"
      "whole recording. Uses RateSmoother, and HandHeldSmoother where the gyro clipped during\n"
      "hand-held motion.\n\n"
      "RegimeSmoother(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None,\n"
      "calibration=None, **options): the arguments of RateSmoother. parameters() lists the options.")
      .def(
          "__init__",
          [](RegimeSmoother* self, const nb::kwargs& options) {
            new (self) RegimeSmoother(params_of<RegimeSmoother>("RegimeSmoother", options));
          },
          nb::arg("options"), takes_options())
      .def("estimate", &smooth<RegimeSmoother, Joint>, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(), "Returns one rate per sample, and a RegimeReport.")
      .def_static("parameters", [] { return list_fields(RegimeSmoother::Params{}); });
  nb::class_<Saave>(
      m, "Saave",
      "Recovers one clipped axis by the published method (Deschenes et al., ICRA 2024), followed by a smoother over "
      "the\n"
      "whole recording.\n\n"
      "Saave(lever_arm_m=(x, y, z), saturation_point_rad_s=..., **options): lever_arm_m is from the centre of mass to\n"
      "the IMU, in IMU axes. A reading beyond saturation_point_rad_s is clipped. parameters() lists the options.")
      .def(
          "__init__",
          [](Saave* self, const nb::kwargs& options) {
            Keywords keywords("Saave", options);
            keywords.need("lever_arm_m");
            keywords.need("saturation_point_rad_s");
            Saave::Params params;
            read_fields(keywords, params);
            keywords.done();
            new (self) Saave(params);
          },
          nb::arg("options"), takes_options())
      .def("estimate", &saave, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(), "Returns one rate per sample.")
      .def_static("parameters", [] { return list_fields(Saave::Params{}); });
}

/// Binds the interface that both rate streams share. `rate(stream)` returns the RateStream inside a stream, and
/// `rate_state(state)` returns the state of this RateStream.
template <class Stream, class Rate, class RateState_>
auto bind_stream(nb::module_& m, const char* name, const char* doc,
                 typename Stream::Params (*params)(const nb::kwargs&), Rate rate, RateState_ rate_state) {
  using Object = Guarded<Streaming<Stream>>;
  nb::class_<Object> bound(m, name, doc);
  bound
      .def(
          "__init__",
          [params](Object* self, const nb::kwargs& options) { new (self) Object(Streaming<Stream>(params(options))); },
          nb::arg("options"), takes_options())
      .def(
          "add_imu",
          [](Object& self, const ArrayLike& time_ns, const ArrayLike& gyro, const ArrayLike& accel,
             const ArrayLike& clip_flags) {
            std::optional<RateState> smoothed;
            const auto step = [&smoothed](Streaming<Stream>& at, const ImuSample& sample, Rates& out) {
              const Status status = at.filter.push(sample, *at.state, smoothed);
              if (smoothed) out.rows.push_back(*smoothed);
              return status;
            };
            return feed<Rates>(self, samples_of(time_ns, gyro, accel, clip_flags), step);
          },
          nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"), nb::arg("clip_flags") = nb::none(),
          "Adds one sample or many. Returns the rates that became available, each lag_s old.")
      .def(
          "flush",
          [](Object& self) {
            Rates out;
            self.run([&](Streaming<Stream>& at) { at.filter.flush(*at.state, out.rows); });
            return out;
          },
          "Returns the current estimates for the samples still in the window. The stream is unchanged.")
      .def(
          "newest",
          [rate, rate_state](Object& self) {
            Rates out;
            self.run([&](Streaming<Stream>& at) {
              const std::optional<RateState> newest = rate(at.filter).newest(rate_state(*at.state));
              if (newest) out.rows.push_back(*newest);
            });
            return out;
          },
          "Returns the provisional rate of the newest sample. Returns no row before the first sample.")
      .def(
          "calibration",
          [rate, rate_state](Object& self) {
            return self.run([&](Streaming<Stream>& at) { return rate(at.filter).calibration(rate_state(*at.state)); });
          },
          "Returns the calibration of the rig estimated so far.")
      .def(
          "health",
          [rate, rate_state](Object& self) {
            return self.run(
                [&](Streaming<Stream>& at) { return rate(at.filter).health(rate_state(*at.state)).findings; });
          },
          nb::sig("def health(self) -> list[HealthFinding]"), kHealth);
  bind_copy<Object>(bound);
  return bound;
}

void bind_streams(nb::module_& m) {
  bind_stream<RateStream>(
      m, "RateStream",
      "The streaming form of RateSmoother: returns each rate when its sample is lag_s old.\n\n"
      "RateStream(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None, calibration=None, **options):\n"
      "the arguments of RateSmoother. parameters() lists the options.",
      &stream_params, [](const RateStream& s) -> const RateStream& { return s; },
      [](const RateStream::State& s) -> const RateStream::State& { return s; })
      .def_static("parameters", [] { return list_fields(RateStream::Params{}); });
  bind_stream<RegimeStream>(
      m, "RegimeStream",
      "Estimates the angular velocity of a body in flight, contact or hand-held motion, as a stream. Uses RateStream, "
      "and\n"
      "HandHeldStream where the gyro clips during hand-held motion.\n\n"
      "RegimeStream(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None, calibration=None,\n"
      "**options): the arguments of RateSmoother. parameters() lists the options.",
      &regime_params, [](const RegimeStream& s) -> const RateStream& { return s.rate(); },
      [](const RegimeStream::State& s) -> const RateStream::State& { return s.rate; })
      .def(
          "regime_shares",
          [](Guarded<Streaming<RegimeStream>>& self) {
            const RegimeProbabilities shares =
                self.run([](Streaming<RegimeStream>& at) { return at.state->probabilities; });
            return shares_of(shares);
          },
          nb::sig("def regime_shares(self) -> dict[str, float]"),
          "Returns the probabilities of flight, contact and hand-held motion at the sample returned last.")
      .def_static("parameters", [] { return list_fields(RegimeStream::Params{}, kDerivedRegimeParameters); });
}

}  // namespace

void bind_rates(nb::module_& m) {
  nb::enum_<RateSource>(m, "RateSource", nb::is_arithmetic(), "Source of an angular velocity.")
      .value("measured", RateSource::measured, "no axis of the gyro is clipped or suspect")
      .value("recovered_flight", RateSource::recovered_flight,
             "clipped, recovered from the centripetal specific force of free flight")
      .value("recovered_contact", RateSource::recovered_contact, "clipped, recovered while in contact")
      .value("bounded_only", RateSource::bounded_only,
             "clipped or suspect; constrained only by the rail and the smoothness of the motion");
  bind_rig(m);
  bind_batch(m);
  bind_streams(m);
}

}  // namespace tumble::python
