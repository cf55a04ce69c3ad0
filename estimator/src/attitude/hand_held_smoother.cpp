// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_smoother.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hand_held_problem.hpp"
#include "revolution_hypotheses.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

using hand_held::Node;

namespace {

Status check(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
             const SensingAxisClipSigns& clipped) {
  if (samples.empty()) return {ErrorCode::empty, "samples", 0.0, 1.0};
  const double count = static_cast<double>(samples.size());
  if (!clipped.clip_signs.empty() && clipped.clip_signs.size() != samples.size())
    return {ErrorCode::out_of_range, "signs", static_cast<double>(clipped.clip_signs.size()), count};
  const auto& recovered = clipped.recovered_covariance_rad2_s2;
  if (!recovered.empty() && recovered.size() != samples.size())
    return {ErrorCode::out_of_range, "recovered rates", static_cast<double>(recovered.size()), count};
  for (const Eigen::Matrix3d& covariance : recovered) {
    const double least = covariance.diagonal().minCoeff();
    if (!covariance.allFinite() || least < 0.0)
      return {ErrorCode::out_of_range, "covariance of a recovered rate", least, 0.0};
  }
  const double determinant = std::abs(clipped.sensing_directions.determinant());
  if (!(determinant > hand_held::kRowsMin)) return {ErrorCode::degenerate, "rows", determinant, hand_held::kRowsMin};
  return check_samples(samples, params.expert.gap_max_s);
}

std::uint8_t clipped_axes(const hand_held::GyroReadings& rates, std::size_t k) {
  const std::size_t reading = rates.reading_index_of_sample[k];
  std::uint8_t axes = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const bool in_part = rates.partial_saturation_sigma_rad_s[reading][static_cast<Eigen::Index>(j)] > 0.0;
    if (rates.clip_signs[reading].gyro[j] != 0 || in_part) axes = static_cast<std::uint8_t>(axes | (1u << j));
  }
  return axes;
}

AngularRateSource source(const AngularRateState& rate, double recovered_sigma) {
  if (rate.clipped_axes == 0) return AngularRateSource::measured;
  const double variance = rate.covariance_rad2_s2.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
  return variance < recovered_sigma * recovered_sigma ? AngularRateSource::recovered_in_contact
                                                      : AngularRateSource::lower_bound_only;
}

/// The gyro's scale error increases the attitude covariance in proportion to the rotation since the last rest:
/// carried.md (C27).
void add_rotation_covariance(const hand_held::NodeData& collected, const std::vector<AngularRateState>& rates,
                             std::vector<AttitudeState>& attitudes) {
  const double share = HandHeldSensorParams::kRecoveredScaleSigma;
  const auto turned_on = [&](std::size_t k, Eigen::Vector3d& turned) {
    if (collected.nodes[collected.samples.node_of[k]].is_stationary) return turned.setZero(), void();
    turned += seconds(rates[k].time_ns - rates[k - 1].time_ns) * rates[k].w_WI_I_rad_s;
  };
  std::vector<double> until_rad2(attitudes.size(), 0.0);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (std::size_t k = attitudes.size(); k-- > 1;) {
    turned_on(k, turned);
    until_rad2[k - 1] = turned.squaredNorm();
  }
  turned.setZero();
  for (std::size_t k = 1; k < attitudes.size(); ++k) {
    turned_on(k, turned);
    attitudes[k].covariance_rad2.diagonal().array() += share * share * std::min(turned.squaredNorm(), until_rad2[k]);
  }
}

}  // namespace

HandHeldSmoother::HandHeldSmoother(const Params& params) : params_(params) {
  require_valid_fields(params);
  RestDetector{params.expert.rest_detector};
}

Status HandHeldSmoother::estimate(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped,
                                  std::vector<AngularRateState>& rates, std::vector<AttitudeState>& attitudes,
                                  Report& report) const {
  rates.clear();
  attitudes.clear();
  report = {};
  if (const Status status = check(params_, samples, clipped); !status.ok()) return status;
  const hand_held::NodeData collected = hand_held::collect_node_data(params_, samples, clipped);
  std::vector<Node> start;
  Status status = hand_held::start_nodes(params_, clipped.sensing_directions, collected, start);
  if (!status.ok()) return status;
  hand_held::HandHeldProblem problem(params_, clipped.sensing_directions, collected, std::move(start));
  status = problem.solve(report);
  if (status.ok()) status = problem.covariances(report);
  if (!status.ok()) return status;
  hand_held::test_revolutions(problem, report);

  rates.resize(samples.size());
  attitudes.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const std::size_t i = collected.samples.node_of[k];
    const Node& node = problem.nodes()[i];
    const Eigen::Matrix<double, 9, 9>& covariance = problem.covariance(i);
    const double at = static_cast<double>(i) * params_.expert.node_s;
    const double centre = collected.samples.window_centre_s[k] - at, end = collected.samples.end_s[k] - at;
    rates[k].time_ns = attitudes[k].time_ns = samples[k].time_ns;
    // A gyro reading is the mean rate over an averaging window, and therefore valid at the window's centre. The
    // reported attitude is valid at the time stamp of the reading.
    rates[k].w_WI_I_rad_s = node.w_WI_I_rad_s + centre * node.angular_acceleration_rad_s2;
    rates[k].covariance_rad2_s2 = covariance.block<3, 3>(hand_held::kRate, hand_held::kRate);
    rates[k].clipped_axes = clipped_axes(collected.rates, k);
    rates[k].source = source(rates[k], HandHeldSensorParams::kRecoveredSigma_rad_s);
    const Eigen::Vector3d turn = end * node.w_WI_I_rad_s + 0.5 * end * end * node.angular_acceleration_rad_s2;
    attitudes[k].orientation_W = node.q_WI * so3::exp(turn);
    const Eigen::Matrix3d R = node.q_WI.toRotationMatrix();
    attitudes[k].covariance_rad2 = R * covariance.topLeftCorner<3, 3>() * R.transpose();
  }
  if (!clipped.recovered_covariance_rad2_s2.empty()) add_rotation_covariance(collected, rates, attitudes);
  return {};
}

}  // namespace tumble
