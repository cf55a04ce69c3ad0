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
void read_rig(Keywords& keywords, AngularRateModelParams& model, SaturationLimitDetector::Params& rails) {
  model.nominal.lever_arm_m = vector_of(keywords.need("lever_arm_m"), "lever_arm_m");
  const nb::object calibration = keywords.take("calibration");
  if (calibration.is_valid() && !calibration.is_none()) model.calibration = rig_of(calibration, "calibration");
  read_ranges(keywords, rails);
}

/// Returns the member of `params` that contains the rate model and the saturation limits.
AngularRateSmoother::Params& rate_part(AngularRateSmoother::Params& params) {
  return params;
}
AngularRateStream::Params& rate_part(AngularRateStream::Params& params) {
  return params;
}
AngularRateSmoother::Params& rate_part(MotionRegimeSmoother::Params& params) {
  return params.rate;
}
AngularRateStream::Params& rate_part(MotionRegimeStream::Params& params) {
  return params.rate;
}

template <class Class>
typename Class::Params params_of(const char* name, const nb::kwargs& given,
                                 const std::vector<const char*>& hidden = {}) {
  Keywords keywords(name, given);
  typename Class::Params params;
  read_rig(keywords, rate_part(params).model, rate_part(params).saturation_detector);
  read_fields(keywords, params, hidden);
  keywords.done();
  return params;
}

AngularRateStream::Params stream_params(const nb::kwargs& given) {
  return params_of<AngularRateStream>("AngularRateStream", given);
}

/// MotionRegimeStream derives these parameters from its AngularRateStream. The HandHeldRateStream of MotionRegimeStream
/// makes one iteration per node.
const std::vector<const char*> kDerivedRegimeParameters = {"carried_period_s", "carried_lag_s", "carried_gap_max_s",
                                                           "carried_iterations_max"};

MotionRegimeStream::Params regime_params(const nb::kwargs& given) {
  MotionRegimeStream::Params params =
      params_of<MotionRegimeStream>("MotionRegimeStream", given, kDerivedRegimeParameters);
  params.hand_held.body.expert.gap_max_s = params.rate.kGapMax_s;
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

Rates saave(const SaturationAwareRateEstimator& self, const ArrayLike& time_ns, const ArrayLike& gyro,
            const ArrayLike& accel, const ArrayLike& clip_flags) {
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
  nb::class_<AngularRateReport>(m, "AngularRateReport", "Statistics of a run of AngularRateSmoother.")
      .def_ro("iterations", &AngularRateReport::iterations)
      .def_ro("converged", &AngularRateReport::converged)
      .def_ro("restarts", &AngularRateReport::restarts)
      .def_ro("calibration", &AngularRateReport::calibration,
              "estimated calibration of the rig, which the next run can start from")
      .def_ro("calibration_mahalanobis", &AngularRateReport::calibration_mahalanobis,
              "distance of the calibration from its prior; a value far above 1 indicates a wrong prior")
      .def_ro("calibration_at_prior", &AngularRateReport::calibration_at_prior,
              "True if the run did not update the calibration, which then equals its prior")
      .def_ro("rail", &AngularRateReport::saturation_limits,
              "rails in use: gyro x y z [rad/s], accelerometer [m/s^2]; None: not detected")
      .def_prop_ro(
          "planes", [](const AngularRateReport& r) { return as_list(r.gyro_planes); },
          nb::for_getter(nb::sig("def planes(self) -> list[SaturationPlane | None]")), "rails of the gyro elements")
      .def_ro("samples", &AngularRateReport::samples)
      .def_ro("clipped", &AngularRateReport::clipped_sample_count)
      .def_ro("recovered_in_flight", &AngularRateReport::recovered_in_flight)
      .def_ro("recovered_in_contact", &AngularRateReport::recovered_in_contact)
      .def_ro("lower_bound_only", &AngularRateReport::lower_bound_only)
      .def_ro("flight_share", &AngularRateReport::flight_fraction)
      .def_prop_ro(
          "suspect_axes", [](const AngularRateReport& r) { return owned(r.suspected_saturation_axes); },
          nb::rv_policy::automatic, "(N,) uint8, bit j: axis j may be at a rail that was not detected");
  nb::class_<AngularRateSmoother>(
      m, "AngularRateSmoother",
      "Estimates the angular velocity of a tumbling body through gyro saturation, over a whole recording.\n\n"
      "AngularRateSmoother(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None,\n"
      "calibration=None, **options): lever_arm_m is from the centre of mass to the IMU, in IMU axes.\n"
      "The ranges are those of the data sheet, or None. calibration is a BodyImuCalibration of an earlier run.\n"
      "parameters() lists the options. The model covers flight and contact. For hand-held motion use "
      "MotionRegimeSmoother "
      "or\n"
      "HandHeldSmoother; tumble.rate() uses MotionRegimeSmoother.")
      .def(
          "__init__",
          [](AngularRateSmoother* self, const nb::kwargs& options) {
            new (self) AngularRateSmoother(params_of<AngularRateSmoother>("AngularRateSmoother", options));
          },
          nb::arg("options"), takes_options())
      .def("estimate", &smooth<AngularRateSmoother, AngularRateReport>, nb::arg("time_ns"), nb::arg("gyro"),
           nb::arg("accel"), nb::arg("clip_flags") = nb::none(),
           "Returns one rate per sample, and an AngularRateReport.")
      .def_static("parameters", [] { return list_fields(AngularRateSmoother::Params{}); });
  using Joint = MotionRegimeSmoother::Report;
  nb::class_<Joint>(m, "RegimeReport", "Statistics of a run of MotionRegimeSmoother.")
      .def_ro("rate", &Joint::rate, "report of AngularRateSmoother")
      .def_prop_ro(
          "shares", [](const Joint& r) { return shares_of(r.probabilities); },
          nb::for_getter(nb::sig("def shares(self) -> dict[str, float]")),
          "mean probabilities of flight, contact and hand-held motion")
      .def_ro("hand_held_probability_max", &Joint::hand_held_probability_max,
              "largest probability of hand-held motion in a clipped segment")
      .def_ro("hand_held_smoother_ran", &Joint::hand_held_smoother_ran, "whether HandHeldSmoother was used")
      .def_ro("carried", &Joint::hand_held, "report of HandHeldSmoother, if it was used");
  nb::class_<MotionRegimeSmoother>(
      m, "MotionRegimeSmoother",
      "Estimates the angular velocity of a body in flight, contact or hand-held motion, over a\n"
      "whole recording. Uses AngularRateSmoother, and HandHeldSmoother where the gyro clipped during\n"
      "hand-held motion.\n\n"
      "MotionRegimeSmoother(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None,\n"
      "calibration=None, **options): the arguments of AngularRateSmoother. parameters() lists the options.")
      .def(
          "__init__",
          [](MotionRegimeSmoother* self, const nb::kwargs& options) {
            new (self) MotionRegimeSmoother(params_of<MotionRegimeSmoother>("MotionRegimeSmoother", options));
          },
          nb::arg("options"), takes_options())
      .def("estimate", &smooth<MotionRegimeSmoother, Joint>, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(), "Returns one rate per sample, and a RegimeReport.")
      .def_static("parameters", [] { return list_fields(MotionRegimeSmoother::Params{}); });
  nb::class_<SaturationAwareRateEstimator>(
      m, "Saave",
      "Recovers one clipped axis by the published method (Deschenes et al., ICRA 2024), followed by a smoother over "
      "the\n"
      "whole recording.\n\n"
      "Saave(lever_arm_m=(x, y, z), saturation_point_rad_s=..., **options): lever_arm_m is from "
      "the centre of mass to\n"
      "the IMU, in IMU axes. A reading beyond saturation_point_rad_s is clipped. parameters() lists the options.")
      .def(
          "__init__",
          [](SaturationAwareRateEstimator* self, const nb::kwargs& options) {
            Keywords keywords("Saave", options);
            keywords.need("lever_arm_m");
            keywords.need("saturation_point_rad_s");
            SaturationAwareRateEstimator::Params params;
            read_fields(keywords, params);
            keywords.done();
            new (self) SaturationAwareRateEstimator(params);
          },
          nb::arg("options"), takes_options())
      .def("estimate", &saave, nb::arg("time_ns"), nb::arg("gyro"), nb::arg("accel"),
           nb::arg("clip_flags") = nb::none(), "Returns one rate per sample.")
      .def_static("parameters", [] { return list_fields(SaturationAwareRateEstimator::Params{}); });
}

/// Binds the interface that both rate streams share. `rate(stream)` returns the AngularRateStream inside a stream, and
/// `rate_stream_state(state)` returns the state of this AngularRateStream.
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
            std::optional<AngularRateState> smoothed;
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
              const std::optional<AngularRateState> newest = rate(at.filter).newest(rate_state(*at.state));
              if (newest) out.rows.push_back(*newest);
            });
            return out;
          },
          "Returns the provisional rate of the newest sample. Returns no row before the first sample.")
      .def(
          "body_imu_calibration",
          [rate, rate_state](Object& self) {
            return self.run(
                [&](Streaming<Stream>& at) { return rate(at.filter).body_imu_calibration(rate_state(*at.state)); });
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
  bind_stream<AngularRateStream>(
      m, "AngularRateStream",
      "The streaming form of AngularRateSmoother: returns each rate when its sample is lag_s old.\n\n"
      "AngularRateStream(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None, calibration=None, "
      "**options):\n"
      "the arguments of AngularRateSmoother. parameters() lists the options.",
      &stream_params, [](const AngularRateStream& s) -> const AngularRateStream& { return s; },
      [](const AngularRateStream::State& s) -> const AngularRateStream::State& { return s; })
      .def_static("parameters", [] { return list_fields(AngularRateStream::Params{}); });
  bind_stream<MotionRegimeStream>(
      m, "MotionRegimeStream",
      "Estimates the angular velocity of a body in flight, contact or hand-held motion, as a stream. Uses "
      "AngularRateStream, "
      "and\n"
      "HandHeldRateStream where the gyro clips during hand-held motion.\n\n"
      "MotionRegimeStream(lever_arm_m=(x, y, z), gyro_range_rad_s=None, accel_range_m_s2=None, calibration=None,\n"
      "**options): the arguments of AngularRateSmoother. parameters() lists the options.",
      &regime_params, [](const MotionRegimeStream& s) -> const AngularRateStream& { return s.rate(); },
      [](const MotionRegimeStream::State& s) -> const AngularRateStream::State& { return s.rate; })
      .def(
          "regime_shares",
          [](Guarded<Streaming<MotionRegimeStream>>& self) {
            const RegimeProbabilities shares =
                self.run([](Streaming<MotionRegimeStream>& at) { return at.state->probabilities; });
            return shares_of(shares);
          },
          nb::sig("def regime_shares(self) -> dict[str, float]"),
          "Returns the probabilities of flight, contact and hand-held motion at the sample returned last.")
      .def_static("parameters", [] { return list_fields(MotionRegimeStream::Params{}, kDerivedRegimeParameters); });
}

}  // namespace

void bind_rates(nb::module_& m) {
  nb::enum_<AngularRateSource>(m, "AngularRateSource", nb::is_arithmetic(), "Source of an angular velocity.")
      .value("measured", AngularRateSource::measured, "no axis of the gyro is clipped or suspect")
      .value("recovered_in_flight", AngularRateSource::recovered_in_flight,
             "clipped, recovered from the centripetal specific force of free flight")
      .value("recovered_in_contact", AngularRateSource::recovered_in_contact, "clipped, recovered while in contact")
      .value("lower_bound_only", AngularRateSource::lower_bound_only,
             "clipped or suspect; constrained only by the rail and the smoothness of the motion");
  bind_rig(m);
  bind_batch(m);
  bind_streams(m);
}

}  // namespace tumble::python
