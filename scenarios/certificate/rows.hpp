// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "sim/trial/trial.hpp"

/// Declares the certificate's measurements with their setups. The default values are those of the certificate; tests
/// modify one number and check that the measurement fails. Members named `stated_*` change the value that the closed
/// form assumes.
namespace tumble::scenarios {

/// The rig is thrown high and rotates near its unstable axis. Euler's equations conserve energy and angular momentum.
struct FreeFlightSetup {
  double duration_s = 5.0;
  double rate_rad_s = 18.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
};
std::vector<CertificateEntry> certify_free_flight(const CertificateInput& input, const FreeFlightSetup& setup = {});

/// An ideal IMU at the centre of mass measures zero specific force in free flight. `lever_arm_m` is the distance of the
/// IMU from the centre of mass.
struct FlightForceSetup {
  double duration_s = 2.0;
  double rate_rad_s = 18.0;
  double lever_arm_m = 0.0;
};
std::vector<CertificateEntry> certify_flight_force(const CertificateInput& input, const FlightForceSetup& setup = {});

/// The time from the sphere's release to its first contact must equal sqrt(2 h / g) within one engine step.
struct FreeFallSetup {
  double height_m = 1.0;
  double stated_height_m = 1.0;
};
std::vector<CertificateEntry> certify_free_fall(const CertificateInput& input, const FreeFallSetup& setup = {});

/// The velocity of the rolling sphere's centre must equal r w x n, on a plane and on the ground of each sphere
/// scenario.
struct RollingSetup {
  double stated_radius_m = 0.0;  ///< 0: the sphere's true radius
  bool terrains = true;          ///< also tests the scenarios
};
std::vector<CertificateEntry> certify_rolling(const CertificateInput& input, const RollingSetup& setup = {});

/// A sphere that starts to slide at speed v0 must stop slipping after the time v0 / (mu g (1 + m r^2 / I)).
struct SlipToGripSetup {
  double speed_m_s = 1.0;
  double friction = 0.1;
  double stated_friction = 0.1;
};
std::vector<CertificateEntry> certify_slip_to_grip(const CertificateInput& input, const SlipToGripSetup& setup = {});

/// First peak of the rig's specific force, averaged over 2 ms, when the rig drops on its corners. The measurement
/// reports the change of the peak with the engine's step (compared with a quarter step) and with the contact time
/// constant, as an exponent; an ideal spring has exponent -1.
struct ImpactSetup {
  double height_m = 1.0;
  double step_s = 0.0;                  ///< 0: the simulation's step
  double soft_s = 0.05, hard_s = 0.03;  ///< contact time constants: the scenarios' range
};
std::vector<CertificateEntry> certify_impact(const CertificateInput& input, const ImpactSetup& setup = {});

/// The points of a moving lidar without range error, transformed by the true pose at each firing, are compared with the
/// walls of an empty room. `added_range_m` is added to every range.
struct LidarRangeSetup {
  double added_range_m = 0.0;
};
std::vector<CertificateEntry> certify_lidar_range(const CertificateInput& input, const LidarRangeSetup& setup = {});

/// Rays in the lidar's copy of each world are compared with the engine's own rays.
struct LidarRaysSetup {
  int rays = 2000;              ///< per world
  double mirror_shift_m = 0.0;  ///< shifts the copy's rays upward
  int surface_shift = 0;        ///< shifts the surface ids in the copy
};
std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup = {});

/// An hour of each IMU at rest is compared with noise and bias of the data sheet. The factors multiply the noise and
/// bias of the simulated IMU.
struct ImuNoiseSetup {
  double duration_s = 3600.0;
  std::uint64_t seed = 1;
  double noise_factor = 1.0;
  double bias_factor = 1.0;
};
std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup = {});

/// Planes fitted to the clipped readings of IMUs with tilted sensing elements are compared with the simulated planes.
/// `assumed_tilt` is added to one entry of the misalignment matrix in the closed form.
struct TiltedRailSetup {
  double misalignment = 0.02;  ///< distribution of the elements; scales use half of it, offsets 0.5 % of the limit
  double assumed_tilt = 0.0;
  int devices = 5;
};
std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup = {});

/// Saturation planes measured on real gyros (a hand-held device, a pendulum) are compared with the simulation. The
/// simulation uses a device with the measured sensing elements, and devices drawn from the distribution in the data
/// sheets.
struct RealRailsSetup {
  double tilt_factor = 1.0;         ///< factor on the elements' slopes; 0: aligned elements
  double added_tilt = 0.0;          ///< added to each slope
  double rail_factor = 1.0;         ///< factor on the device's limit
  double added_offset_rad_s = 0.0;  ///< added to the middle between the limits of both signs
  double spread_factor = 1.0;       ///< factor on the data sheets' values
  int devices = 500;                ///< number drawn from each data sheet
};
std::vector<CertificateEntry> certify_real_rails(const CertificateInput& input, const RealRailsSetup& setup = {});

/// A frictionless pendulum with large and small swings is compared with Lagrange's equations of three bars.
struct PendulumSetup {
  double duration_s = 5.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
  double stated_segment_m = 0.0;   ///< segment length in the closed forms of energy and periods; 0: the pendulum's
  double lever_arm_error_m = 0.0;  ///< the IMU is this much higher than in the closed form
};
std::vector<CertificateEntry> certify_pendulum(const CertificateInput& input, const PendulumSetup& setup = {});

/// The digest of a simulated run must not depend on the number of threads, the order of runs, or the process.
struct DigestSetup {
  std::string scenario = "hill";
  std::string other_scenario = "slip";
  std::uint64_t seed = 1;
  std::uint64_t restart_seed = 1;  ///< seed for the new process
  double duration_s = 3.5;         ///< duration of the draws in this process
  double disturbance = 0.0;        ///< error: added to the duration of every second draw
};
std::vector<CertificateEntry> certify_digests(const CertificateInput& input, const DigestSetup& setup = {});

}  // namespace tumble::scenarios
