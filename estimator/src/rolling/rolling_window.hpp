// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rolling_node.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble::rolling {

struct ModePathNode {
  ContactMode mode = ContactMode::grip;
  bool at_rest = false;
  bool spins_in_place = false;  ///< the sphere is at rest, but rotates about the contact point
  bool holds_constant_position = false;
  Eigen::Matrix3d position_spread_m2 = Eigen::Matrix3d::Zero();
};

/// number of error states that determine a pose: attitude, velocity, position, lever arm
inline constexpr int kReported = 12;
using Reported = Eigen::Matrix<double, kReported, 1>;

struct FilterNodeRecord {
  /// maximum number of scalar measurements per filter step: at rest, three velocities and three gyro biases
  static constexpr int kMaxMeasurements = 6;
  Moving moving_jacobian;
  std::array<Row, kMaxMeasurements> measurement_rows;
  std::array<Vector, kMaxMeasurements> gain;
  std::array<double, kMaxMeasurements> innovation{}, variance{};
  int measurement_count = 0;
  bool resets_floor_slope = false;
  bool tilt_reset = false;
  bool heading_lost = false;
  /// rows of the error covariance that belong to the reported states, after the update
  Eigen::Matrix<double, kReported, kStates> covariance_rows;
  Reported correction;
  Vector heading_correction;  ///< heading_component() of the correction, if the heading is lost
  RollingNominalState nominal;
  ModePathNode mode_path_node;
  TimeNs time_ns = 0;
  Reported smoothed;
  Eigen::Matrix<double, kReported, kReported> smoothed_covariance;
};

/// RollingReading is one input of the live filter: an IMU reading, or a part of a data gap.
struct RollingReading {
  ImuSample sample;
  double length_s = 0.0;
  GapUncertainty uncertainty;
  bool in_gap = false, ends_at_sample = true;  ///< in a gap, only the last part ends at a sample
  TimeNs end_ns = 0;
};

/// RollingReadings iterates over stored samples, and returns the same inputs that the live filter received. next()
/// costs O(1) and allocates no memory.
class RollingReadings {
 public:
  RollingReadings(const RollingParams& params, std::span<const ImuSample> samples, const ReadingCursor& from)
      : params_(params), samples_(samples), cursor_(from) {}

  const ReadingCursor& cursor() const { return cursor_; }
  bool next(RollingReading& out);

 private:
  void next_gap_step(double gap_s, RollingReading& out);

  const RollingParams& params_;
  std::span<const ImuSample> samples_;
  ReadingCursor cursor_;
};

struct SampleMotion {
  TimeNs time_ns = 0;
  Eigen::Quaterniond q_WI;
  Eigen::Vector3d v_WI_m_s, p_WI_m;
  Eigen::Vector3d rate_I_rad_s;
  std::size_t node = 0;  ///< index of the first node that is completed after the sample
};

Eigen::Matrix<double, kReported, kStates> output_covariance_rows(const Covariance& P);
Eigen::Matrix<double, kReported, kReported> reported_covariance(const Eigen::Matrix<double, kReported, kStates>& rows);
/// Returns the covariance of the velocity of the sphere's centre in IMU axes. The product of angular velocity error and
/// lever arm is neglected.
Eigen::Matrix3d velocity_covariance_I(const RollingNominalState& nominal, const Eigen::Vector3d& w_WI_I_rad_s,
                                      const Eigen::Matrix<double, kReported, kReported>& reported);

void complete_filter_node(const RollingParams& params, const RollingNodeIntegrals& sums,
                          const Eigen::Vector3d& rate_I_rad_s, const ModePathNode& path, ModePathFilter& filter,
                          FilterNodeRecord& record);

/// Returns the smoothed error at a filter step (node), relative to the nominal trajectory before the update of the
/// filter step.
Reported error_before_update(const FilterNodeRecord& node);

/// Adjoint contains the information that later measurements provide about the error state at a filter step (node).
struct Adjoint {
  Vector adjoint_vector = Vector::Zero();
  Covariance adjoint_matrix = Covariance::Zero();
};

/// Smooths the states of consecutive filter steps (nodes) by the modified Bryson-Frazier smoother. On entry, `adjoint`
/// contains the information from all measurements after the last node. On return, `adjoint` also contains the
/// information from the measurements at `nodes`.
void backward_pass(Adjoint& adjoint, std::span<FilterNodeRecord> nodes);

}  // namespace tumble::rolling
