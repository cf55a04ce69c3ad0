// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/sweep_report.hpp"

/// Whether a lidar's metre is that of the IMU.
namespace tumble {

/// By how much ways between sweeps are longer than the IMU has it.
struct SweepScale {
  double scale = 1.0;
  double sigma = std::numeric_limits<double>::infinity();
  std::size_t changes = 0;  ///< of velocity that were compared

  /// Further from 1 than 2 % and than five of its deviations.
  bool is_off() const;
  /// `out_of_range` with the scale and the bound that it broke; `ok` where it is not off.
  Status verdict() const;
};

/// Scale of a run's sweeps. Over two spans of 0.4 s in a row the mean velocities of the sweeps' ends differ by what the
/// IMU has felt meanwhile, whatever velocity was before: gravity in flight, the ground's impacts. The slope of the one
/// over the other, robustly (Huber, 1964), is 1; ranges that are 10 % too long make it 1.1, less what the mapper
/// believes the IMU. Attitudes are those of the run. Where the accelerometer was at its rail, or surfaces did not say
/// where a sweep was, nothing is compared; its deviation is that of residuals as they are spread (White, 1980).
/// `gravity_m_s2`: strength of gravity. Not seen: where the body is not accelerated, and an accelerometer of another
/// scale, which gravity at rest tells. O(N).
SweepScale find_sweep_scale(std::span<const ImuSample> samples, std::span<const SweepReport> sweeps,
                            double gravity_m_s2);

/// The same while samples and sweeps come, by what came before, up to the newest 1000 changes. A sweep's first word
/// counts, so that it is less sure than that of a whole run with the last ones.
class SweepScaleWatch {
 public:
  /// A change of velocity from one span to the next.
  struct Change {
    Eigen::Vector3d by_imu_m_s = Eigen::Vector3d::Zero(), by_sweeps_m_s = Eigen::Vector3d::Zero();
  };

  /// Remembers `samples_max` samples, which should last for two seconds: with more of them between sweeps nothing is
  /// compared.
  SweepScaleWatch(double gravity_m_s2, std::size_t samples_max);

  /// A sample of the IMU, in order of time, with what its rails hide flagged. No allocation.
  void add(const ImuSample& sample);
  /// A sweep that the mapper has been given, as soon as the samples up to its end were added. O(changes).
  void add(const SweepReport& sweep);

  const SweepScale& scale() const { return scale_; }

  /// Visits every member of the state. Defined in the library's sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  double gravity_m_s2_;
  std::size_t samples_max_;
  std::vector<ImuSample> samples_;
  std::deque<SweepReport> sweeps_;  ///< of two spans; pose, attitudes and verdict alone
  std::deque<Change> changes_;
  SweepScale scale_;
};

}  // namespace tumble
