// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "tumble/odometry/saved_streams.hpp"

/// Streams with their parameters and states, and what they are fed, all alike.
namespace tumble::test {

/// A body that is thrown, with a gyro that clips. Gaps of half a second, and readings that another clock would give.
inline std::vector<ImuSample> thrown_samples() {
  const ThrownBody body;
  std::vector<ImuSample> out = body.imu();
  std::erase_if(out, [](const ImuSample& s) { return s.time_ns > 2'400'000'000 && s.time_ns < 2'800'000'000; });
  return out;
}

/// A rolling sphere, without samples for half a second.
inline std::vector<ImuSample> rolled_samples() {
  std::vector<ImuSample> out = unit_at(kPositions[0]);
  std::erase_if(out, [](const ImuSample& s) { return s.time_ns > 2'700'000'000 && s.time_ns < 3'200'000'000; });
  return out;
}

template <class Stream>
typename Stream::Params params_of_stream() {
  typename Stream::Params out;
  const auto set_rate = [](RateStream::Params& rate) {
    rate.model.nominal = {};
    rate.model.nominal.lever_arm_m = ThrownBody{}.lever_arm_I_m;
    rate.lag_s = 0.1;
  };
  if constexpr (std::same_as<Stream, RateStream>) set_rate(out);
  if constexpr (std::same_as<Stream, RegimeStream>) set_rate(out.rate);
  const auto set_sphere = [](RollingParams& sphere) {
    sphere.radius_m = kRadius_m;
    sphere.lever_arm_m = kPositions[0];
  };
  if constexpr (std::same_as<Stream, RollingFilter>) set_sphere(out);
  if constexpr (std::same_as<Stream, RollingSmoother>) {
    set_sphere(out.filter);
    out.lag_s = 0.3;
  }
  return out;
}

template <class Stream>
inline constexpr bool kRolls = std::same_as<Stream, RollingFilter> || std::same_as<Stream, RollingSmoother>;

template <class Stream>
std::vector<ImuSample> samples_of_stream() {
  return kRolls<Stream> ? rolled_samples() : thrown_samples();
}

/// Appends the numbers of a stream's result.
inline void append_result(const RateState& rate, std::vector<double>& out) {
  out.push_back(static_cast<double>(rate.time_ns));
  out.insert(out.end(), rate.w_WI_I_rad_s.begin(), rate.w_WI_I_rad_s.end());
  out.insert(out.end(), rate.covariance_rad2_s2.reshaped().begin(), rate.covariance_rad2_s2.reshaped().end());
  out.push_back(static_cast<double>(rate.source));
}
inline void append_result(const RollingEstimate& pose, std::vector<double>& out) {
  out.push_back(static_cast<double>(pose.time_ns));
  out.insert(out.end(), pose.p_WG_m.begin(), pose.p_WG_m.end());
  out.insert(out.end(), pose.q_WI.coeffs().begin(), pose.q_WI.coeffs().end());
  out.insert(out.end(), pose.covariance.reshaped().begin(), pose.covariance.reshaped().end());
  out.push_back(static_cast<double>(pose.mode));
}

template <class Stream>
class Kept {
 public:
  explicit Kept(const typename Stream::Params& params = params_of_stream<Stream>())
      : params_(params), stream_(params), state_(std::make_unique<typename Stream::State>()) {
    if constexpr (requires { stream_.start(); }) *state_ = stream_.start();
  }

  Status push(const ImuSample& sample) {
    if constexpr (std::same_as<Stream, RollingFilter>) {
      const Status status = stream_.step(sample, *state_);
      if (status.ok()) append_result(RollingFilter::estimate(*state_), results);
      return status;
    } else if constexpr (std::same_as<Stream, RollingSmoother>) {
      std::vector<RollingEstimate> out;
      const Status status = stream_.step(sample, *state_, out);
      for (const RollingEstimate& each : out) append_result(each, results);
      return status;
    } else {
      std::optional<RateState> out;
      const Status status = push(sample, out);
      if (out) append_result(*out, results);
      return status;
    }
  }
  /// Appends the remaining results. The state must not be used afterwards.
  void end() {
    if constexpr (std::same_as<Stream, RollingSmoother>) {
      stream_.finish(*state_, [&](const RollingEstimate& each) { append_result(each, results); });
    } else if constexpr (!kRolls<Stream>) {
      std::vector<RateState> out;
      stream_.flush(*state_, out);
      for (const RateState& each : out) append_result(each, results);
    }
  }

  std::vector<std::byte> save() const { return save_state<Stream>(params_, *state_); }
  Status load(std::span<const std::byte> bytes) { return load_state<Stream>(bytes, params_, *state_); }

  std::vector<double> results;

 private:
  Status push(const ImuSample& sample, std::optional<RateState>& out) {
    if constexpr (std::same_as<Stream, HandHeldStream>) {
      const ClipSigns signs;
      return stream_.push(sample, {Eigen::Matrix3d::Identity(), {&signs, 1}}, *state_, out);
    } else {
      return stream_.push(sample, *state_, out);
    }
  }

  typename Stream::Params params_;
  Stream stream_;
  std::unique_ptr<typename Stream::State> state_;
};

}  // namespace tumble::test
