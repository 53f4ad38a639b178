#pragma once

#include "bullet_ambient/motion/lanes/flight_lanes.h"

namespace ambient {

// Arithmetic of bodies at a water surface, several at once. Plain data only, as in flight_lanes.h.

/// Positions of bodies relative to the water surface: input and output of SurfaceKernel::stand();
/// in B.
struct alignas(64) StandLanes {
  FlightLane active;  ///< 1: stand() treats the body

  // Input.
  FlightLane normal[3], height;           ///< of the plane
  FlightLane gravity;                     ///< SurfacePlane::gravity
  FlightLane pull;                        ///< SurfacePlane::density times gravity
  FlightLane volume, moment[3];           ///< WetVolume
  FlightLane depth_integral;              ///< WetVolume
  FlightLane area, centroid[3];           ///< Waterplane
  FlightLane spread[6];                   ///< Waterplane: xx, yy, zz, xy, xz, yz
  FlightLane heave_inertia, damping;      ///< WaveSource
  FlightLane inertia[kSymmetricEntries];  ///< K

  // Results.
  FlightLane inverse[kSymmetricEntries];     ///< K^-1
  FlightLane is_indefinite;                  ///< 1: K is not positive definite; K^-1 is undefined
  FlightLane heave[6], tilt[2][3];           ///< RestoringMode::motion; of a tilt its angular part
  FlightLane stiffness[3];                   ///< of heave and tilts
  FlightLane second_moment[2];               ///< of tilts
  FlightLane strength[3], loss[3], rate[3];  ///< WaveMode, of heave and tilts
  FlightLane swing;                          ///< largest natural frequency [1/s]
};

/// Bodies in flight near a surface. `flight` has pose, motion, forces and loads; its inertia is
/// that of the last stand. Each kernel treats the bodies that are active in `flight`.
struct alignas(64) SurfaceLanes {
  FlightLanes flight;
  StandLanes stand;

  FlightLane normal_W[3], height_W;  ///< plane of the surface at the start of the step, in W
  FlightLane is_stiff;               ///< 1: fall() includes the stiffness of buoyancy
  FlightLane wind_W[3];  ///< velocity of the water minus that of the fluid above, in W [m/s]

  FlightLane gradient[6];     ///< F_K of docs/theory.md eq. (66) at the start of the flow
  FlightLane draught, cover;  ///< depth of the lowest and of the highest point [m]
  FlightLane centre_of_buoyancy[3];

  FlightLane wave_heave[2], heave_energy, wave_tilt_W[2][3], tilt_energy;  ///< WaveMemory

  FlightLane kinetic2, potential;  ///< results of measure(): x.K x, and eq. (64) without T [J]
};

/// Kernels of one instruction set; bits as those of FlightKernel. Kicks are halves of
/// flight.kick_time.
struct SurfaceKernel {
  /// Computes K^-1, restoring modes, waves and swing of the bodies that are active in the stand.
  void (*stand)(StandLanes&) noexcept;
  /// Sets normal and height of the stand: the plane seen from the present pose.
  void (*see)(SurfaceLanes&) noexcept;
  /// Applies the passage from the inertia of the flight to that of the stand, over flow_time; eq.
  /// (66) to (68).
  void (*pass)(SurfaceLanes&) noexcept;
  /// Applies weight, applied forces and buoyancy for half a kick. Sets flight.momentum_B.
  void (*fall)(SurfaceLanes&) noexcept;
  /// Converts the waves to the modes of the stand, and lets them act for half a kick; eq. (71),
  /// (72).
  void (*exchangeWaves)(SurfaceLanes&) noexcept;
  /// Applies the load of the last kick, flight.load_W; eq. (23).
  void (*keepLoad)(SurfaceLanes&) noexcept;
  /// Predicts the motion in the middle of the kick from the last load: sets flight.sample_twist and
  /// guess_B.
  void (*sampleLoad)(SurfaceLanes&) noexcept;
  /// Applies flight.load_B, evaluated at flight.sample_twist; sets load_W and error; eq. (23) to
  /// (25).
  void (*takeLoad)(SurfaceLanes&) noexcept;
  /// Sets flight.sample_twist to the twist relative to the fluid above.
  void (*meetWind)(SurfaceLanes&) noexcept;
  /// Applies flight.load_B, the load of the fluid above at flight.sample_twist.
  void (*takeWind)(SurfaceLanes&) noexcept;
  /// Sets kinetic2 and potential.
  void (*measure)(SurfaceLanes&) noexcept;
};

extern const SurfaceKernel kSurfaceKernelBaseline, kSurfaceKernelAvx2, kSurfaceKernelAvx512;

}  // namespace ambient
