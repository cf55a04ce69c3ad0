// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "belief.hpp"
#include "motion_prior.hpp"

namespace tumble::mapping {

/// What a sweep leaves to the next: all that is carried over the border between the two.
struct Border {
  Belief belief;                                                         ///< there
  Registration::Matrix end_by_start = Registration::Matrix::Identity();  ///< of its unknowns by those of the last sweep
  /// Magnitude of the saturation deficit's share there, on axes on the rail; 0 where the last sweep was not aligned.
  Eigen::Vector3d deficit_share = Eigen::Vector3d::Zero();
  Eigen::Matrix3d railed_velocity_m2_s2 = Eigen::Matrix3d::Zero();  ///< variance from the last sweep's rails, W
  bool held = false;  ///< the last sweep's surfaces held the sensor in all directions

  TimeNs time_ns() const { return belief.mean.state.time_ns; }
};

/// The motion from the border to a sweep's end, as the IMU tells it.
struct MotionWindow {
  std::span<const MotionSample> samples;  ///< from the border on, past the end too
  TimeNs end_ns = 0;
  int resting_sweeps = 0;  ///< in a row, by the IMU, up to this one
};

/// What the sweeps so far say of the next one's unknowns.
struct Prediction {
  Registration::Prior prior;
  Registration::Matrix by_last = Registration::Matrix::Identity();  ///< of its means by the unknowns at the border
  Registration::Matrix noise = Registration::Matrix::Zero();        ///< that arises in between
  Registration::Matrix errors = Registration::Matrix::Zero();       ///< covariance of the means' errors, as reported

  /// From the weight and the errors of what is believed at the border, once all else is known.
  void compose(const Belief& at_border);
  /// Known to be at rest: velocity zero, and no longer correlated with the rest. Before compose().
  void zero_velocity_update(double sigma_m_s);
};

/// Predicts the unknowns of a sweep; `trajectory` is what the IMU makes of the belief at the border.
Prediction predict(const LidarInertialOdometry::Params& params, const Border& border, const MotionWindow& window,
                   const SweepTrajectory& trajectory, const MotionPrior& known);

/// Of a lost sensor whose IMU rests: that it has not moved, which stops the drift of its velocity.
void predict_rest(const LidarInertialOdometry::Params& params, const Border& border, Prediction& prediction);

/// Whether the prior alone is sure enough to draw by; clipped axes count in full, also where their deficit is
/// estimated.
bool prior_is_trusted(const LidarInertialOdometry::Params& params, const Border& border, const MotionWindow& window,
                      const SweepTrajectory& trajectory);

/// What stands for a sweep that was not aligned: the prediction.
Belief posterior(const Prediction& prediction);
/// What stands for one that was: mapping.md (R41).
Belief posterior(const Prediction& prediction, const Registration::Result& aligned);

/// See SweepReport::innovation; mapping.md (R51).
double innovation(const Prediction& prediction, const Registration::Estimate& aligned);

/// Whether a place is where the prediction has it: within its covariance, and no further off than surfaces are matched,
/// beyond which whichever is nearest fits. `innovation` is that of above. mapping.md (R120).
bool is_expected(const LidarInertialOdometry::Params& params, const Prediction& prediction,
                 const Registration::Estimate& aligned, double innovation);

/// The border at the end of a sweep that moved along `trajectory`, by what stands for it at its start. `alignment`
/// is null where there is none.
void border_after(const LidarInertialOdometry::Params& params, const Belief& start, const MotionWindow& window,
                  const SweepTrajectory& trajectory, const Registration::Result* alignment, Border& border);

/// Of the saturation deficit from knot to knot: mapping.md (R36).
double knot_correlation(const LidarInertialOdometry::Params& params, const SweepTrajectory& trajectory);

}  // namespace tumble::mapping
