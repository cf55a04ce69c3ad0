// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "sim/trial/trial.hpp"

/// Each struct in rows.hpp contains the settings of one simulation check. A member named `stated_*` falsifies the
/// expected result of a check, so that a test can make the check fail.
namespace tumble::scenarios {

/// The free-flight check throws the rig with a rotation near its unstable axis. During the flight, the kinetic energy
/// and the angular momentum of the rig must be constant.
struct FreeFlightSetup {
  double duration_s = 5.0;
  double rate_rad_s = 18.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
};
std::vector<CertificateEntry> certify_free_flight(const CertificateInput& input, const FreeFlightSetup& setup = {});

struct FlightForceSetup {
  double duration_s = 2.0;
  double rate_rad_s = 18.0;
  double lever_arm_m = 0.0;
};
std::vector<CertificateEntry> certify_flight_force(const CertificateInput& input, const FlightForceSetup& setup = {});

/// The time from the sphere's release to its first contact must equal sqrt(2 h / g) within one engine step (height h,
/// gravity g).
struct FreeFallSetup {
  double height_m = 1.0;
  double stated_height_m = 1.0;
};
std::vector<CertificateEntry> certify_free_fall(const CertificateInput& input, const FreeFallSetup& setup = {});

/// In the rolling check, the velocity of a rolling sphere's centre must equal r w x n (radius r, angular velocity w,
/// contact normal n).
struct RollingSetup {
  double stated_radius_m = 0.0;  ///< 0: the sphere's true radius
  bool terrains = true;          ///< also tests the ground of the sphere scenarios
};
std::vector<CertificateEntry> certify_rolling(const CertificateInput& input, const RollingSetup& setup = {});

/// In the slip check, a sphere starts to slide at speed v0. The sphere must stop slipping after the time v0 / (mu g (1
/// + m r^2 / I)), for friction coefficient mu, gravity g, mass m, radius r and moment of inertia I.
struct SlipToGripSetup {
  double speed_m_s = 1.0;
  double friction = 0.1;
  double stated_friction = 0.1;
};
std::vector<CertificateEntry> certify_slip_to_grip(const CertificateInput& input, const SlipToGripSetup& setup = {});

/// The impact check drops the rig on its corners and computes the first peak of the specific force, averaged over 2 ms.
/// The impact check also reports the exponent of the power law between the peak and the contact time constant. For an
/// ideal spring, the exponent is -1: the peak is inversely proportional to the contact time constant.
struct ImpactSetup {
  double height_m = 1.0;
  double step_s = 0.0;                  ///< 0: the simulation's step
  double soft_s = 0.05, hard_s = 0.03;  ///< contact time constants: limits of the scenarios
};
std::vector<CertificateEntry> certify_impact(const CertificateInput& input, const ImpactSetup& setup = {});

/// The lidar range check compares the points of a moving lidar without range error with the walls of an empty room.
struct LidarRangeSetup {
  double added_range_m = 0.0;
};
std::vector<CertificateEntry> certify_lidar_range(const CertificateInput& input, const LidarRangeSetup& setup = {});

struct LidarRaysSetup {
  int rays = 2000;              ///< rays per world
  double mirror_shift_m = 0.0;  ///< deliberate error of the ray origin
  int surface_shift = 0;        ///< deliberate error of the surface ids
};
std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup = {});

/// The noise check simulates one hour of each IMU at rest, and compares noise and bias with the data sheet.
struct ImuNoiseSetup {
  double duration_s = 3600.0;
  std::uint64_t seed = 1;
  double noise_factor = 1.0;
  double bias_factor = 1.0;
};
std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup = {});

/// The saturation check fits planes to the clipped readings of simulated IMUs with tilted sensing elements, and
/// compares the fitted planes with the saturation planes of the sensor model.
struct TiltedRailSetup {
  double misalignment = 0.02;  ///< standard deviation
  double assumed_tilt = 0.0;
  int devices = 5;
};
std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup = {});

/// The real-gyro check compares the saturation limits of two real gyros with the saturation limits of simulated gyros.
struct RealRailsSetup {
  double tilt_factor = 1.0;         ///< factor on the slopes; 0: aligned elements
  double added_tilt = 0.0;          ///< added to each slope
  double rail_factor = 1.0;         ///< factor on the saturation limit
  double added_offset_rad_s = 0.0;  ///< added to the midpoint of the two limits
  double spread_factor = 1.0;       ///< factor on the tolerances in the data sheets
  int devices = 500;                ///< number of random devices per data sheet
};
std::vector<CertificateEntry> certify_real_rails(const CertificateInput& input, const RealRailsSetup& setup = {});

/// The pendulum check compares a simulated frictionless pendulum with the solution of Lagrange's equations for three
/// bars.
struct PendulumSetup {
  double duration_s = 5.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
  double stated_segment_m = 0.0;   ///< assumed bar length; 0: true length
  double lever_arm_error_m = 0.0;  ///< deliberate height error of the IMU
};
std::vector<CertificateEntry> certify_pendulum(const CertificateInput& input, const PendulumSetup& setup = {});

/// The digest check computes the digest (hash) of a simulated run several times. The digest must not depend on the
/// number of threads, the order of runs, or the process.
struct DigestSetup {
  std::string scenario = "hill";
  std::string other_scenario = "slip";
  std::uint64_t seed = 1;
  std::uint64_t restart_seed = 1;  ///< seed for the new process
  double duration_s = 3.5;         ///< duration of the runs in this process
  double disturbance = 0.0;        ///< deliberate error of the duration
};
std::vector<CertificateEntry> certify_digests(const CertificateInput& input, const DigestSetup& setup = {});

}  // namespace tumble::scenarios
