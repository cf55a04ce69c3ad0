// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

enum class AutogainProfile : std::uint8_t {
  paper,     ///< eq 2 of the MFI 2021 paper
  code2021,  ///< code that the paper's authors published in 2021; differs from eq 2
  smooth,    ///< continuous, independent of the mounting
};

struct AutogainGains {
  Eigen::Vector3d factor = Eigen::Vector3d::Zero();  ///< f_x, f_y, f_z (eq 2)
  double beta = 0.0;
  double madgwick_rad_s = 0.0;  ///< gain of the Madgwick step (eq 4)
  double slerp_share = 0.0;     ///< weight of the complementary step (eq 5)
};

/// Autogain estimates attitude with the filter for a rolling sphere (Zevering et al., IEEE MFI 2021, eqs 2-5). Autogain
/// combines Madgwick's correction with a complementary correction. As the angular rate increases, the gain of
/// Madgwick's correction increases, and the weight of the complementary correction decreases. Autogain estimates
/// neither gyro bias nor heading.
class Autogain {
 public:
  struct Params {
    AutogainProfile profile = AutogainProfile::paper;
    double gain_rad_s = 0.2;  ///< gain at full rate
    double tau_s = 0.396;
    double lower_rad_s = 0.1;  ///< unused by code2021
    double upper_rad_s = 2.1;  ///< above lower_rad_s; unused by code2021
    /// If true, Autogain repeats an error in the code of the MFI 2021 paper, which never corrects the roll angle.
    bool roll_error_2021 = false;
    bool tilt_form = false;
    double gap_max_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(
          p.profile,
          {"profile", "1", 0.0, 2.0,
           "dependence of the gain on the rate: 0: eq. 2 of the MFI 2021 paper; 1: the code of its authors; 2: smooth",
           ParameterAudience::common_use});
      visit(p.gain_rad_s, {"gain_rad_s", "rad/s", 0.0, 10.0, "Madgwick gain at full rate (Theta, eq. 4)",
                           ParameterAudience::common_use});
      visit(p.tau_s, {"tau_s", "s", 1e-3, 1e4, "time constant of the complementary step at rest (eq. 5)",
                      ParameterAudience::common_use});
      visit(p.lower_rad_s,
            {"lower_rad_s", "rad/s", 0.0, 100.0, "rate below which the accelerometer has full weight (eq. 2)",
             ParameterAudience::common_use});
      visit(p.upper_rad_s,
            {"upper_rad_s", "rad/s", 1e-9, 100.0,
             "rate above which the gyro has full weight, added to lower_rad_s (eq. 2)", ParameterAudience::common_use});
      visit(
          p.roll_error_2021,
          boolean_parameter("roll_error_2021", "1: never correct the roll angle, as in the code of the MFI 2021 paper",
                            ParameterAudience::common_use));
      visit(p.tilt_form,
            boolean_parameter("tilt_form",
                              "1: the complementary step is the smallest rotation; 0: the step turns towards a "
                              "target in roll, pitch and yaw",
                              ParameterAudience::common_use));
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit Autogain(const Params& params);

  /// If the specific force is below 1e-6 m/s^2, Autogain only integrates the gyro.
  Status step(const ImuSample& sample, State& state) const;

  AutogainGains gains(const Eigen::Vector3d& w_I_rad_s, double dt_s) const;

 private:
  Params params_;
};

}  // namespace tumble::baselines
