// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "sim/trial/trial.hpp"

/// The certificate's rows with their setups. The defaults are the certificate's; tests modify one number to see the row
/// fail. `stated` values are those of the closed form.
namespace tumble::scenarios {

/// The rig thrown high and rotating near its unstable axis. Euler's equations conserve energy and angular momentum.
struct FreeFlightSetup {
  double duration_s = 5.0;
  double rate_rad_s = 18.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
};
std::vector<CertificateEntry> certify_free_flight(const CertificateInput& input, const FreeFlightSetup& setup = {});

/// An ideal IMU at the centre of mass measures zero force in free flight. `lever_arm_m` is its distance from there.
struct FlightForceSetup {
  double duration_s = 2.0;
  double rate_rad_s = 18.0;
  double lever_arm_m = 0.0;
};
std::vector<CertificateEntry> certify_flight_force(const CertificateInput& input, const FlightForceSetup& setup = {});

/// Time from the sphere's release to its first contact compared with sqrt(2 h / g), within one engine step.
struct FreeFallSetup {
  double height_m = 1.0;
  double stated_height_m = 1.0;
};
std::vector<CertificateEntry> certify_free_fall(const CertificateInput& input, const FreeFallSetup& setup = {});

/// v = r w x n at the sphere's centre in rolling contact: on the plane, and on the ground of each sphere scenario.
struct RollingSetup {
  double stated_radius_m = 0.0;  ///< 0: the sphere's true radius
  bool terrains = true;          ///< also tests the scenarios
};
std::vector<CertificateEntry> certify_rolling(const CertificateInput& input, const RollingSetup& setup = {});

/// A sphere that starts to slide at v0 grips after v0 / (mu g (1 + m r^2 / I)).
struct SlipToGripSetup {
  double speed_m_s = 1.0;
  double friction = 0.1;
  double stated_friction = 0.1;
};
std::vector<CertificateEntry> certify_slip_to_grip(const CertificateInput& input, const SlipToGripSetup& setup = {});

/// First peak of the rig's specific force when dropped on its corners, mean over 2 ms. Measures its change with the
/// engine's step (compared with a quarter step) and with the contact softness (exponent; a spring has -1 in its time
/// constant).
struct ImpactSetup {
  double height_m = 1.0;
  double step_s = 0.0;                  ///< 0: the simulation's step
  double soft_s = 0.05, hard_s = 0.03;  ///< contact time constants: the scenarios' range
};
std::vector<CertificateEntry> certify_impact(const CertificateInput& input, const ImpactSetup& setup = {});

/// Points of a moving lidar without range error, transformed by the true pose at each firing, compared with the planes
/// of a bare room. `added_range_m` is added to every range.
struct LidarRangeSetup {
  double added_range_m = 0.0;
};
std::vector<CertificateEntry> certify_lidar_range(const CertificateInput& input, const LidarRangeSetup& setup = {});

/// The lidar's copy of each world compared with the engine's own rays.
struct LidarRaysSetup {
  int rays = 2000;              ///< per world
  double mirror_shift_m = 0.0;  ///< shifts the copy's rays upward
  int surface_shift = 0;        ///< shifts the surface ids in the copy
};
std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup = {});

/// An hour of each IMU at rest compared with noise and bias of its data sheet. The factors multiply what is simulated.
struct ImuNoiseSetup {
  double duration_s = 3600.0;
  std::uint64_t seed = 1;
  double noise_factor = 1.0;
  double bias_factor = 1.0;
};
std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup = {});

/// Planes fitted to the clipped readings of IMUs with tilted sensing elements compared with the drawn ones.
/// `believed_tilt` is added to one entry of the matrix in the closed form.
struct TiltedRailSetup {
  double misalignment = 0.02;  ///< distribution of the elements; scales use half of it, offsets 0.5 % of the limit
  double believed_tilt = 0.0;
  int devices = 5;
};
std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup = {});

/// Saturation planes measured on real gyros (a hand-held device, a pendulum). Compared with a simulated device that has
/// the corresponding elements, and with the distribution of elements in the data sheets.
struct RealRailsSetup {
  double tilt_factor = 1.0;         ///< factor on the elements' slopes; 0: aligned elements
  double added_tilt = 0.0;          ///< added to each slope
  double rail_factor = 1.0;         ///< factor on the device's limit
  double added_offset_rad_s = 0.0;  ///< added to the middle between the limits of both signs
  double spread_factor = 1.0;       ///< factor on the data sheets' values
  int devices = 500;                ///< number drawn from each data sheet
};
std::vector<CertificateEntry> certify_real_rails(const CertificateInput& input, const RealRailsSetup& setup = {});

/// The pendulum without friction, with large and small swings, compared with Lagrange's equations of three bars.
struct PendulumSetup {
  double duration_s = 5.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
  double stated_segment_m = 0.0;   ///< segment length in the closed forms of energy and periods; 0: the pendulum's
  double lever_arm_error_m = 0.0;  ///< the IMU is this much higher than in the closed form
};
std::vector<CertificateEntry> certify_pendulum(const CertificateInput& input, const PendulumSetup& setup = {});

/// Digest of a draw with other numbers of threads, in another order, and from a new process.
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
