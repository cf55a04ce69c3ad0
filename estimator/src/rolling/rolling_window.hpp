// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rolling_node.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::rolling {

/// Mode of a node, decided.
struct PathNode {
  RollingMode mode = RollingMode::grip;
  bool at_rest = false;
  bool spins_in_place = false;  ///< at rest, yet it turns about its contact
  bool stands = false;          ///< quiet, and for so long about it that it may be standing still
  Eigen::Matrix3d spread_m2 = Eigen::Matrix3d::Zero();
};

inline constexpr int kReported = 12;  ///< attitude, velocity, position, lever arm: states that a pose needs
using Reported = Eigen::Matrix<double, kReported, 1>;

/// A node of the last pass, with all that the way back needs.
struct NodeRecord {
  static constexpr int kRowsMax = 7;  ///< at rest, and a known distance
  Moving B;
  std::array<Row, kRowsMax> H;
  std::array<Vector, kRowsMax> gain;
  std::array<double, kRowsMax> innovation{}, variance{};
  int rows = 0;
  bool forgets_slope = false;
  bool tilt_reset = false;
  bool lost_heading = false;
  Eigen::Matrix<double, kReported, kStates> P_rows;  ///< after the update
  Reported correction;                               ///< by which the update moved the nominal
  Vector turned;                                     ///< of a lost heading, by that move: turned_by_heading()
  RollingNominal nominal;                            ///< after the update
  PathNode path;
  TimeNs time_ns = 0;
  // the way back
  Reported smoothed;
  Eigen::Matrix<double, kReported, kReported> smoothed_P;
};

/// What the live filter takes at once: readings averaged, or a piece of a gap.
struct Reading {
  ImuAverage average;
  GapDoubt doubt;
  bool in_gap = false;
  bool whole = true;               ///< false: the last one of the run, not long enough to be taken
  std::size_t first = 0, end = 0;  ///< its samples; of a gap's pieces the last one alone has one
  TimeNs end_ns = 0;
};

/// Stored samples as the live filter takes them. O(1) for each, no allocation.
class Readings {
 public:
  /// Where in the samples: before the next reading.
  struct Cursor {
    TimeNs time_ns = 0;  ///< end of the last reading
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
    std::size_t next = 0;  ///< sample
    // of the gap that it is in
    Eigen::Vector3d gap_rate_rad_s = Eigen::Vector3d::Zero();  ///< before it
    TimeNs gap_start_ns = 0;
    int gap_piece = 0;
    bool operator==(const Cursor&) const = default;
  };

  Readings(const RollingParams& params, std::span<const ImuSample> samples, const Cursor& from)
      : params_(params), samples_(samples), cursor_(from) {}

  const Cursor& cursor() const { return cursor_; }
  /// False at the end.
  bool next(Reading& out);

 private:
  bool next_piece(double gap_s, Reading& out);

  const RollingParams& params_;
  std::span<const ImuSample> samples_;
  Cursor cursor_;
};

/// Nominal trajectory at a sample.
struct SamplePoint {
  TimeNs time_ns = 0;
  Eigen::Quaterniond q_WI;
  Eigen::Vector3d v_WI_m_s, p_WI_m;
  Eigen::Vector3d rate_I_rad_s;
  std::size_t node = 0;  ///< the one that closes after it
};

/// State of the last pass between two nodes.
struct PathFilter {
  RollingNominal nominal;
  Covariance P = Covariance::Zero();
  RollingMode mode = RollingMode::grip;
};

Eigen::Matrix<double, kReported, kStates> reported_rows(const Covariance& P);

/// Closes a node: predicts, measures, rebases. `record` is a blank one.
void close_node(const RollingParams& params, const RollingSums& sums, const Eigen::Vector3d& rate_I_rad_s,
                const PathNode& path, PathFilter& filter, NodeRecord& record);

/// Smoothed error at the node about the nominal before the update.
Reported error_before_update(const NodeRecord& node);

/// The centre of `filter`, at or just after the last node, stands `distance_m` from the start, horizontally. Returns by
/// what the nominal was moved; nothing where start and end are as good as one, and the distance has no direction.
Reported measure_distance(const RollingParams& params, double distance_m, double sigma_m, NodeRecord& last,
                          PathFilter& filter);

/// What the measurements after a node say of the error there.
struct Adjoint {
  Vector lambda = Vector::Zero();
  Covariance Lambda = Covariance::Zero();
};

/// Modified Bryson-Fraser: fills `smoothed` and `smoothed_P` of nodes in a row. `adjoint` is that behind the last one,
/// afterwards that before the first.
void smooth_back(Adjoint& adjoint, std::span<NodeRecord> nodes);

}  // namespace tumble::rolling
