// SPDX-License-Identifier: BSD-3-Clause
#include "rolling_window.hpp"

#include <algorithm>

#include "../common/symmetric.hpp"
#include "lost_heading.hpp"
#include "node_rows.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::rolling {

namespace {

constexpr double kMaxSigmas = 5.0;
constexpr double kNoDirection_m = 0.05;  // minimum distance of two positions whose direction is defined

/// A residual beyond kMaxSigmas standard deviations has less weight, because a large linear correction would distort
/// the whole run: rolling.md (R37).
void measure(const Row& H, double measured, double variance, NodeRecord& record, Vector& x, Covariance& P) {
  const auto k = static_cast<std::size_t>(record.rows++);
  const Vector PHt = P * H.transpose();
  record.H[k] = H;
  record.innovation[k] = measured - H.dot(x);
  record.variance[k] = std::max(H.dot(PHt) + variance, squared(record.innovation[k] / kMaxSigmas));
  record.gain[k] = PHt / record.variance[k];
  x += record.gain[k] * record.innovation[k];
  P.noalias() -= PHt * record.gain[k].transpose();
}

void measure(int index, double measured, double variance, NodeRecord& record, Vector& x, Covariance& P) {
  measure(Row(Vector::Unit(index).transpose()), measured, variance, record, x, P);
}

Reported reported(const Vector& x) {
  Reported out;
  out << x.head<9>(), x.segment<3>(kLeverArm);
  return out;
}

/// See rolling.md (R36).
void transform_adjoint(const Vector& turned, Adjoint& adjoint) {
  constexpr int kHeading = kAttitude + 2;
  adjoint.lambda[kHeading] += turned.dot(adjoint.lambda);
  adjoint.Lambda.row(kHeading) += (turned.transpose() * adjoint.Lambda).eval();
  adjoint.Lambda.col(kHeading) += (adjoint.Lambda * turned).eval();
}

}  // namespace

bool Readings::next_piece(double gap_s, Reading& out) {
  const ImuSample& after = samples_[cursor_.next];
  ImuSample before;
  before.angular_velocity_rad_s = cursor_.gap_rate_rad_s;
  const int pieces = gap_pieces(params_, gap_s);
  out.average = gap_step(params_, before, after, gap_s, cursor_.gap_step, out.uncertainty);
  out.in_gap = true;
  ++cursor_.gap_step;
  const bool last = cursor_.gap_step == pieces;
  const double share = static_cast<double>(cursor_.gap_step) / pieces;
  out.end_ns = last ? after.time_ns : cursor_.gap_start_ns + static_cast<TimeNs>(share * gap_s * 1e9);
  if (last) {
    cursor_.gap_step = 0;
    out.end = ++cursor_.next;
  }
  cursor_.time_ns = out.end_ns;
  cursor_.last_rate_rad_s = out.average.mean.angular_velocity_rad_s;
  return true;
}

bool Readings::next(Reading& out) {
  out = {};
  out.first = out.end = cursor_.next;
  if (cursor_.next >= samples_.size()) return false;
  if (cursor_.gap_step > 0) return next_piece(seconds(samples_[cursor_.next].time_ns - cursor_.gap_start_ns), out);
  TimeNs last_ns = cursor_.time_ns;
  for (; out.end < samples_.size(); ++out.end) {
    const ImuSample& sample = samples_[out.end];
    const double dt_s = seconds(sample.time_ns - last_ns);
    if (dt_s > params_.expert.gap.kGapMinDuration_s) {
      if (out.average.readings > 0) break;
      cursor_.gap_rate_rad_s = cursor_.last_rate_rad_s;
      cursor_.gap_start_ns = last_ns;
      return next_piece(dt_s, out);
    }
    out.average.add(sample, dt_s);
    last_ns = sample.time_ns;
    out.whole = out.average.full(params_.expert.reading_s, dt_s) || out.end + 1 < samples_.size();
    if (out.average.full(params_.expert.reading_s, dt_s)) {
      ++out.end;
      break;
    }
  }
  out.end_ns = cursor_.time_ns = last_ns;
  cursor_.last_rate_rad_s = out.average.mean.angular_velocity_rad_s;
  cursor_.next = out.end;
  return true;
}

Eigen::Matrix<double, kReported, kStates> output_covariance_rows(const Covariance& P) {
  Eigen::Matrix<double, kReported, kStates> out;
  out << P.topRows<9>(), P.middleRows<3>(kLeverArm);
  return out;
}

Eigen::Matrix<double, kReported, kReported> reported_covariance(const Eigen::Matrix<double, kReported, kStates>& rows) {
  Eigen::Matrix<double, kReported, kReported> out;
  out << rows.leftCols<9>(), rows.middleCols<3>(kLeverArm);
  return out;
}

Eigen::Matrix3d velocity_covariance_I(const RollingNominal& nominal, const Eigen::Vector3d& w_WI_I_rad_s,
                                      const Eigen::Matrix<double, kReported, kReported>& reported) {
  const Eigen::Matrix3d R_IW = nominal.q_WI.toRotationMatrix().transpose();
  Eigen::Matrix<double, 3, kReported> J;
  J << R_IW * so3::hat(nominal.v_WI_m_s), R_IW, Eigen::Matrix3d::Zero(), -so3::hat(w_WI_I_rad_s);
  return J * reported * J.transpose();
}

void complete_node(const RollingParams& params, const RollingIntegrals& sums, const Eigen::Vector3d& rate_I_rad_s,
                   const PathNode& path, PathFilter& filter, NodeRecord& record) {
  record.path = path;
  record.B = transition(sums);
  Vector x = Vector::Zero();
  predict(params, sums, record.B, x, filter.P);
  record.tilt_reset = reset_tilt(params, sums, path.at_rest, filter.nominal, filter.P);
  record.resets_slope = resets_slope(filter.mode, path.mode);
  update_slope_for_mode(params, filter.mode, path.mode, sums.node_s, filter.nominal, x, filter.P);
  record.heading_lost = heading_lost(filter.P);
  const auto take = [&](const auto& row, double measured, double variance) {
    measure(row, measured, variance, record, x, filter.P);
  };
  if (path.at_rest) {
    rest_rows(params, sums, filter.nominal, path.spins_in_place, take);
  } else {
    Contact c = contact(params, filter.nominal, rate_I_rad_s, sums);
    if (record.heading_lost) remove_heading_effect(c);
    contact_rows(params, c, path.mode, sums.node_s, filter.nominal.v_WI_m_s, x, filter.P, take);
  }
  make_symmetric(filter.P);
  filter.P.block<3, 3>(kPosition, kPosition) += path.position_spread_m2;
  move_linearisation_point(x, filter.nominal);
  if (record.heading_lost) {
    record.turned = heading_effect(x);
    move_errors(record.turned, filter.P);
  }
  filter.mode = path.mode;
  record.correction = reported(x);
  record.P_rows = output_covariance_rows(filter.P);
  record.nominal = filter.nominal;
}

Reported error_before_update(const NodeRecord& node) {
  const Reported error = node.smoothed + node.correction;
  return node.heading_lost ? Reported(error - node.smoothed[kAttitude + 2] * reported(node.turned)) : error;
}

/// See rolling.md (R41).
Reported measure_distance(const RollingParams& params, double distance_m, double sigma_m, NodeRecord& last,
                          PathFilter& filter) {
  const RollingNominal& nominal = filter.nominal;
  const Eigen::Matrix3d R = nominal.q_WI.toRotationMatrix();
  const Eigen::Vector3d arm_W = R * (params.lever_arm_m + nominal.lever_arm_error_m);
  Eigen::Vector3d from_start = nominal.p_WI_m - arm_W;
  from_start.z() = 0.0;
  const double length_m = from_start.norm();
  if (length_m < kNoDirection_m) return Reported::Zero();
  const Eigen::RowVector3d along = (from_start / length_m).transpose();
  Row H = Row::Zero();
  H.segment<3>(kAttitude) = along * so3::hat(arm_W);
  H.segment<3>(kPosition) = along;
  H.segment<3>(kLeverArm) = -along * R;
  Vector x = Vector::Zero();
  measure(H, distance_m - length_m, sigma_m * sigma_m, last, x, filter.P);
  make_symmetric(filter.P);
  move_linearisation_point(x, filter.nominal);
  last.correction += reported(x);
  last.P_rows = output_covariance_rows(filter.P);
  last.nominal = filter.nominal;
  return reported(x);
}

/// See rolling.md (R38), (R39).
void backward_pass(Adjoint& adjoint, std::span<NodeRecord> nodes) {
  auto& [lambda, Lambda] = adjoint;
  for (std::size_t n = nodes.size(); n-- > 0;) {
    NodeRecord& node = nodes[n];
    node.smoothed = -node.P_rows * lambda;
    node.smoothed_P = reported_covariance(node.P_rows) - node.P_rows * Lambda * node.P_rows.transpose();
    if (node.heading_lost) transform_adjoint(node.turned, adjoint);
    for (std::size_t k = static_cast<std::size_t>(node.rows); k-- > 0;) {
      const Row& H = node.H[k];
      const Vector& K = node.gain[k];
      const Vector through = Lambda * K;
      lambda -= H.transpose() * (K.dot(lambda) + node.innovation[k] / node.variance[k]);
      const Row seen = H * (K.dot(through) + 1.0 / node.variance[k]);
      Lambda += H.transpose().lazyProduct(seen) - H.transpose().lazyProduct(through.transpose()) -
                through.lazyProduct(H);  // avoids a temporary matrix of 13 KiB per measurement
    }
    if (node.resets_slope) {
      lambda.segment<2>(kSlope).setZero();
      Lambda.middleRows<2>(kSlope).setZero();
      Lambda.middleCols<2>(kSlope).setZero();
    }
    if (node.tilt_reset) {
      lambda.head<6>().setZero();
      Lambda.topRows<6>().setZero();
      Lambda.leftCols<6>().setZero();
    }
    lambda += (node.B.transpose() * lambda.head<9>()).eval();
    Lambda += (node.B.transpose() * Lambda.topRows<9>()).eval();
    Lambda += (Lambda.leftCols<9>() * node.B).eval();
  }
}

}  // namespace tumble::rolling
