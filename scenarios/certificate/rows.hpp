// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "sim/trial/trial.hpp"

/// The header rows.hpp declares the measurements of the certificate (checks of the simulation) with their settings. The
/// certificate uses the default settings of each measurement. Tests modify one setting of a measurement and check that
/// the measurement then fails. Members named `stated_*` change the value that the closed form assumes.
namespace tumble::scenarios {

/// The free-flight measurement throws the rig high, with a rotation near its unstable axis. Euler's equations of the
/// free rotation conserve energy and angular momentum.
struct FreeFlightSetup {
  double duration_s = 5.0;
  double rate_rad_s = 18.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
};
std::vector<CertificateEntry> certify_free_flight(const CertificateInput& input, const FreeFlightSetup& setup = {});

/// An ideal IMU at the centre of mass measures zero specific force in free flight. The IMU has the distance
/// `lever_arm_m` from the centre of mass.
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

/// The velocity of the rolling sphere's centre must equal r w x n. The rolling law is measured on a plane and on the
/// ground of each sphere scenario.
struct RollingSetup {
  double stated_radius_m = 0.0;  ///< 0: the sphere's true radius
  bool terrains = true;          ///< also tests the sphere scenarios
};
std::vector<CertificateEntry> certify_rolling(const CertificateInput& input, const RollingSetup& setup = {});

/// In the sliding measurement, a sphere that starts to slide at speed v0 must stop slipping after the time v0 / (mu g
/// (1 + m r^2 / I)).
struct SlipToGripSetup {
  double speed_m_s = 1.0;
  double friction = 0.1;
  double stated_friction = 0.1;
};
std::vector<CertificateEntry> certify_slip_to_grip(const CertificateInput& input, const SlipToGripSetup& setup = {});

/// The impact measurement drops the rig on its corners and records the first peak of the specific force, averaged over
/// 2 ms. The measurement reports the relative change of the peak when the simulation step is reduced to a quarter. The
/// measurement also reports how the peak depends on the contact time constant, as an exponent; an ideal spring has the
/// exponent -1.
struct ImpactSetup {
  double height_m = 1.0;
  double step_s = 0.0;                  ///< 0: the simulation's step
  double soft_s = 0.05, hard_s = 0.03;  ///< contact time constants: the scenarios' range
};
std::vector<CertificateEntry> certify_impact(const CertificateInput& input, const ImpactSetup& setup = {});

/// The range measurement compares the points of a moving lidar without range error with the walls of an empty room. The
/// true pose at each firing transforms the points to world axes. The setting `added_range_m` is added to every range.
struct LidarRangeSetup {
  double added_range_m = 0.0;
};
std::vector<CertificateEntry> certify_lidar_range(const CertificateInput& input, const LidarRangeSetup& setup = {});

/// The ray measurement compares rays in the lidar simulation's copy of each world with rays in the physics engine.
struct LidarRaysSetup {
  int rays = 2000;              ///< per world
  double mirror_shift_m = 0.0;  ///< shifts the copy's rays upward
  int surface_shift = 0;        ///< shifts the surface ids in the copy
};
std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup = {});

/// The noise measurement compares an hour of each IMU at rest with the noise and bias of the data sheet. The factors in
/// ImuNoiseSetup multiply the noise and bias of the simulated IMU.
struct ImuNoiseSetup {
  double duration_s = 3600.0;
  std::uint64_t seed = 1;
  double noise_factor = 1.0;
  double bias_factor = 1.0;
};
std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup = {});

/// The plane measurement fits planes to the clipped readings of IMUs with tilted sensing elements, and compares them
/// with the simulated planes. The setting `assumed_tilt` is added to one entry of the misalignment matrix in the closed
/// form.
struct TiltedRailSetup {
  double misalignment = 0.02;  ///< distribution of the elements; scales use half of it, offsets 0.5 % of the limit
  double assumed_tilt = 0.0;
  int devices = 5;
};
std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup = {});

/// The real-gyro measurement compares the saturation planes of two real gyros (a hand-held device, a pendulum) with the
/// simulation. One simulated device has the sensing elements of the real gyro. Other simulated devices have random
/// sensing elements from the distributions in the data sheets.
struct RealRailsSetup {
  double tilt_factor = 1.0;         ///< factor on the elements' slopes; 0: aligned elements
  double added_tilt = 0.0;          ///< added to each slope
  double rail_factor = 1.0;         ///< factor on the device's limit
  double added_offset_rad_s = 0.0;  ///< added to the midpoint of the two limits
  double spread_factor = 1.0;       ///< factor on the data sheets' values
  int devices = 500;                ///< number drawn from each data sheet
};
std::vector<CertificateEntry> certify_real_rails(const CertificateInput& input, const RealRailsSetup& setup = {});

/// The pendulum measurement compares a frictionless pendulum, with large and small swings, with Lagrange's equations of
/// three bars.
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
  double duration_s = 3.5;         ///< duration of the runs in this process
  double disturbance = 0.0;        ///< error: added to the duration of every second run
};
std::vector<CertificateEntry> certify_digests(const CertificateInput& input, const DigestSetup& setup = {});

}  // namespace tumble::scenarios
