// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "sim/trial/trial.hpp"

/// The rows of the certificate, each with the set-up that it is measured on. The defaults are the certificate's; a test
/// breaks one number and sees the row fail. What a set-up calls `stated` is what the closed form believes.
namespace tumble::scenarios {

/// The rig thrown high and spun near its unstable axis. Euler's equations keep energy and angular momentum.
struct FreeFlightSetup {
  double duration_s = 5.0;
  double rate_rad_s = 18.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
};
std::vector<CertificateEntry> certify_free_flight(const CertificateInput& input, const FreeFlightSetup& setup = {});

/// What an ideal IMU at the centre of mass says in free flight: nothing. `lever_arm_m` is how far off it sits.
struct FlightForceSetup {
  double duration_s = 2.0;
  double rate_rad_s = 18.0;
  double lever_arm_m = 0.0;
};
std::vector<CertificateEntry> certify_flight_force(const CertificateInput& input, const FlightForceSetup& setup = {});

/// Time from the release of the sphere to its first contact against sqrt(2 h / g), to one step of the engine.
struct FreeFallSetup {
  double height_m = 1.0;
  double stated_height_m = 1.0;
};
std::vector<CertificateEntry> certify_free_fall(const CertificateInput& input, const FreeFallSetup& setup = {});

/// v = r w x n at the sphere's centre while it grips: on the plane, and on the ground of each scenario of the sphere.
struct RollingSetup {
  double stated_radius_m = 0.0;  ///< 0: the sphere's own
  bool terrains = true;          ///< the scenarios too
};
std::vector<CertificateEntry> certify_rolling(const CertificateInput& input, const RollingSetup& setup = {});

/// A sphere set sliding at v0 grips after v0 / (mu g (1 + m r^2 / I)).
struct SlipToGripSetup {
  double speed_m_s = 1.0;
  double friction = 0.1;
  double stated_friction = 0.1;
};
std::vector<CertificateEntry> certify_slip_to_grip(const CertificateInput& input, const SlipToGripSetup& setup = {});

/// First peak of specific force of the rig dropped on its corners, mean over 2 ms: how it changes with the engine's
/// step (against a quarter of it) and with the softness of the contact (exponent; a spring has -1 in its time
/// constant).
struct ImpactSetup {
  double height_m = 1.0;
  double step_s = 0.0;                  ///< 0: the simulation's own
  double soft_s = 0.05, hard_s = 0.03;  ///< time constants of contact: the range that scenarios draw from
};
std::vector<CertificateEntry> certify_impact(const CertificateInput& input, const ImpactSetup& setup = {});

/// Points of a moving lidar without errors of range, carried to the world by the true pose at each firing, against the
/// planes of a bare room. `added_range_m` lengthens every range.
struct LidarRangeSetup {
  double added_range_m = 0.0;
};
std::vector<CertificateEntry> certify_lidar_range(const CertificateInput& input, const LidarRangeSetup& setup = {});

/// The lidar's mirror of each world against the engine's own rays.
struct LidarRaysSetup {
  int rays = 2000;              ///< a world
  double mirror_shift_m = 0.0;  ///< lifts the mirror's rays
  int surface_shift = 0;        ///< makes the mirror name other surfaces
};
std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup = {});

/// An hour of each IMU at rest against noise and bias of its data sheet. The factors multiply what is simulated.
struct ImuNoiseSetup {
  double duration_s = 3600.0;
  std::uint64_t seed = 1;
  double noise_factor = 1.0;
  double bias_factor = 1.0;
};
std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup = {});

/// Planes fitted to the clipped readings of IMUs with tilted sensing elements, one at a time, against those drawn.
/// `believed_tilt` is added to one entry of the matrix that the closed form believes.
struct TiltedRailSetup {
  double misalignment = 0.02;  ///< drawn; scales with half of it, offsets of half a per cent of the rail
  double believed_tilt = 0.0;
  int devices = 5;
};
std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup = {});

/// The planes measured at the rails of real gyros (a wand, a pendulum): of a simulated device that is given the
/// elements which belong to them, and against the spread that the sheets of IMUs have elements drawn with.
struct RealRailsSetup {
  double tilt_factor = 1.0;         ///< of the slopes that the elements are given; 0: the rail is level
  double added_tilt = 0.0;          ///< to each of them
  double rail_factor = 1.0;         ///< of the rail that the device is given
  double added_offset_rad_s = 0.0;  ///< to the middle between the rails of the two signs
  double spread_factor = 1.0;       ///< of what the sheets state
  int devices = 500;                ///< drawn of each sheet
};
std::vector<CertificateEntry> certify_real_rails(const CertificateInput& input, const RealRailsSetup& setup = {});

/// The pendulum without friction, swung wildly and gently, against Lagrange's equations of three bars.
struct PendulumSetup {
  double duration_s = 5.0;
  sim::Integrator integrator = sim::Integrator::runge_kutta_4;
  double stated_segment_m = 0.0;   ///< that the closed forms of energy and periods believe; 0: the pendulum's own
  double lever_arm_error_m = 0.0;  ///< the IMU sits so much higher than the closed form believes
};
std::vector<CertificateEntry> certify_pendulum(const CertificateInput& input, const PendulumSetup& setup = {});

/// The digest of a draw with other numbers of threads, in another order, and from a program started anew.
struct DigestSetup {
  std::string scenario = "hill";
  std::string other_scenario = "slip";
  std::uint64_t seed = 1;
  std::uint64_t restart_seed = 1;  ///< what the program started anew simulates
  double duration_s = 3.5;         ///< of the draws that run in this process alone
  double disturbance = 0.0;        ///< added to the duration of every second draw: an error
};
std::vector<CertificateEntry> certify_digests(const CertificateInput& input, const DigestSetup& setup = {});

}  // namespace tumble::scenarios
