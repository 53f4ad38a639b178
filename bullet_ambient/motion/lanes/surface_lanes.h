#pragma once

#include "bullet_ambient/motion/lanes/flight_lanes.h"

namespace ambient {

// Data and kernels of flight at a water surface, docs/theory.md section 12, for several bodies side
// by side. Plain data only, see flight_lanes.h.

/// Motions of a body that buoyancy acts against like springs: heave of the waterplane's centroid,
/// then tilts about its two principal axes. Each has an oscillator that stands for the waves that
/// it makes, eq. (69), (70). All zero without a waterplane. `Real`: double, one number per lane, or
/// FlightLane.
template <class Real>
struct FloatingModesOf {
  SpatialsOf<Real> heave;   ///< N: the velocity of the motion is N.x for a twist x
  VectorsOf<Real> tilt[2];  ///< angular part of N; its linear part is 0
  Real second_moment[2];    ///< I_i of the waterplane about the axes of the tilts [m^4]
  Real stiffness[3];        ///< k: rho g A_w for heave [N/m], rho g V GM_i for tilts [N m]
  Real strength[3];         ///< G [N/m, N m]
  Real loss[3], rate[3];    ///< a, b [1/s]
};
using FloatingModes = FloatingModesOf<double>;

/// States s_1 and s_2 of one mode of waves, eq. (70).
template <class Real>
struct OscillationOf {
  Real first = {}, second = {};
};

/// Waves that a floating body has made, as far as they act on it; eq. (69). `Real`: as above.
template <class Real>
struct WavesOf {
  OscillationOf<Real> heave;       ///< [m]
  VectorsOf<Real> tilt_W[2] = {};  ///< s_1 and s_2 of the tilt about the horizontal axes [rad]
  Real heave_energy = {}, tilt_energy = {};  ///< [J]

  auto energy() const { return heave_energy + tilt_energy; }
};
using WaveMemory = WavesOf<double>;

namespace {

// Call act(to, from) with each number of `to` and the same one of `from`.

template <class To, class From, class Act>
inline void forEachNumber(VectorsOf<To>& to, const VectorsOf<From>& from, const Act& act) {
  act(to.x, from.x);
  act(to.y, from.y);
  act(to.z, from.z);
}
template <class To, class From, class Act>
inline void forEachNumber(WavesOf<To>& to, const WavesOf<From>& from, const Act& act) {
  act(to.heave.first, from.heave.first);
  act(to.heave.second, from.heave.second);
  for (int i = 0; i < 2; ++i) forEachNumber(to.tilt_W[i], from.tilt_W[i], act);
  act(to.heave_energy, from.heave_energy);
  act(to.tilt_energy, from.tilt_energy);
}
template <class To, class From, class Act>
inline void forEachNumber(FloatingModesOf<To>& to, const FloatingModesOf<From>& from,
                          const Act& act) {
  forEachNumber(to.heave.angular, from.heave.angular, act);
  forEachNumber(to.heave.linear, from.heave.linear, act);
  for (int i = 0; i < 2; ++i) {
    forEachNumber(to.tilt[i], from.tilt[i], act);
    act(to.second_moment[i], from.second_moment[i]);
  }
  for (int i = 0; i < 3; ++i) {
    act(to.stiffness[i], from.stiffness[i]);
    act(to.strength[i], from.strength[i]);
    act(to.loss[i], from.loss[i]);
    act(to.rate[i], from.rate[i]);
  }
}

}  // namespace

/// Bodies at given positions relative to the water surface: input and output of
/// SurfaceKernel::computeFlotations(). Vectors in B.
struct alignas(64) FlotationLanes {
  FlightLane active;  ///< 1: computeFlotations() treats the body

  // Input.
  FlightLane normal[3], height;           ///< plane of the surface: s and h of docs/theory.md
  FlightLane gravity;                     ///< SurfacePlane::gravity
  FlightLane specific_weight;             ///< SurfacePlane::density times gravity
  FlightLane volume, moment[3];           ///< WetVolume
  FlightLane depth_integral;              ///< WetVolume
  FlightLane area, centroid[3];           ///< Waterplane
  FlightLane spread[6];                   ///< Waterplane: xx, yy, zz, xy, xz, yz
  FlightLane heave_inertia, damping;      ///< WaveSource
  FlightLane inertia[kSymmetricEntries];  ///< K
  FlightLane least[kSymmetricEntries];    ///< smallest K that is allowed, half of K_above

  // Results.
  FlightLane inverse[kSymmetricEntries];  ///< K^-1
  FlightLane is_indefinite;               ///< 1: K less `least` is not positive definite
  FloatingModesOf<FlightLane> modes;
  FlightLane frequency;  ///< largest natural frequency [1/s]
};

/// Bodies in flight near a surface. `flight` holds pose, motion, forces, loads, and the inertia of
/// the last computeFlotations(). Kernels compute the bodies that are active in `flight`.
struct alignas(64) SurfaceLanes {
  FlightLanes flight;
  FlotationLanes flotation;

  FlightLane normal_W[3], height_W;  ///< plane of the surface at the start of the step, in W
  FlightLane is_stiff;               ///< 1: kickByGravity() includes the stiffness of buoyancy
  FlightLane wind_W[3];  ///< velocity of the water minus that of the fluid above, in W [m/s]

  FlightLane gradient[6];           ///< F_K of docs/theory.md eq. (66) at the start of the flow
  FlightLane draught, submergence;  ///< MeanDepths of the flow [m]
  FlightLane centre_of_buoyancy[3];
  FlightLane change_error;  ///< result of changeInertia(), eq. (68b) [1]

  WavesOf<FlightLane> waves;

  FlightLane slosh_energy;  ///< of the water in the holds [J]

  FlightLane kinetic2, potential;  ///< results of measure(): x.K x, and eq. (64) without T [J]
};

/// Kernels of one instruction set; all sets give the same bits, see FlightKernel. A kick by one of
/// them lasts half of flight.kick_time.
struct SurfaceKernel {
  /// Computes K^-1, restoring modes, waves and frequencies of the bodies that are active in the
  /// flotation.
  void (*computeFlotations)(FlotationLanes&) noexcept;
  /// Sets normal and height of the flotation to the plane of the surface in B at the present pose.
  void (*see)(SurfaceLanes&) noexcept;
  /// Changes the inertia from that of the flight to that of the flotation, and the twist by the
  /// change of added mass over drift_time; eq. (66) to (68b).
  void (*changeInertia)(SurfaceLanes&) noexcept;
  /// Applies weight, applied forces and buoyancy for half a kick. Sets flight.momentum_B.
  void (*kickByGravity)(SurfaceLanes&) noexcept;
  /// Projects the states of the waves on the modes of the flotation, eq. (72), and applies the
  /// waves for half a kick, eq. (71).
  void (*exchangeWaves)(SurfaceLanes&) noexcept;
  /// Applies the load of the last kick, flight.load_W; eq. (23).
  void (*applyLastLoad)(SurfaceLanes&) noexcept;
  /// Predicts the motion in the middle of the kick from the last load: sets flight.sample_twist and
  /// predicted_load_B.
  void (*sampleLoad)(SurfaceLanes&) noexcept;
  /// Applies flight.load_B, evaluated at flight.sample_twist; sets load_W and error; eq. (23) to
  /// (25).
  void (*applyLoad)(SurfaceLanes&) noexcept;
  /// Sets flight.sample_twist to the twist relative to the fluid above.
  void (*sampleWind)(SurfaceLanes&) noexcept;
  /// Applies flight.load_B, the load of the fluid above at flight.sample_twist.
  void (*kickByWind)(SurfaceLanes&) noexcept;
  /// Sets kinetic2 and potential.
  void (*measure)(SurfaceLanes&) noexcept;
};

extern const SurfaceKernel kSurfaceKernelBaseline, kSurfaceKernelAvx2, kSurfaceKernelAvx512;

}  // namespace ambient
