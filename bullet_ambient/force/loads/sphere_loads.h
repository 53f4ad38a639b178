#pragma once

#include <array>
#include <memory>

#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Integrals over a smooth sphere that spins, for one separation angle; docs/theory.md eq. (40)
/// to (42). Units: the radius and V + W, with V the speed of the centre and W = R |w|. A vector is
/// stored as its factors of e = v / V, a = w / |w| - (e.w / |w|) e, and
/// b = e x a.
struct SphereIntegrals {
  Vector3 detached;         ///< int |t|^2 n over the detached surface
  Vector3 friction_force;   ///< int |t|^(4/5) t over the attached surface
  Vector3 friction_torque;  ///< int n x |t|^(4/5) t over the attached surface
};

/// Computes one node of a SphereTable. Quadrature over longitude about the velocity: equal steps;
/// over latitude: Gauss's rule between the points of separation. Measured error 1e-5.
SphereIntegrals integrateSphere(double spin_share, double cosine,
                                double separation_cosine) noexcept;

/// Table of SphereIntegrals over the spin share W / (V + W) and the cosine between spin and
/// velocity; cubic interpolation. 60 kB. Measured errors divided by pi: at alpha = 1.5 pi/2 1e-4
/// rms, 6e-4 at most. Closer to pi/2 1e-4 rms, up to 6e-3 near the closing of the detached surface.
/// At 1.01 pi/2 5e-4 rms, 1.4e-2 at most. At pi/2 itself 1e-4.
class SphereTable {
 public:
  /// Cost: 50 ms, 15 ms at alpha = pi/2.
  explicit SphereTable(double separation_cosine);

  /// Interpolates. A negative cosine is the mirror image of a positive one. @pre both in [0, 1]
  SphereIntegrals at(double spin_share, double cosine) const noexcept;

 private:
  // A spin across the velocity closes the detached surface at W |cos(alpha)| = V (closing_share_),
  // like the square root of the distance: nodes are dense there.
  static constexpr int kMiddle = 24, kShares = 2 * kMiddle + 1, kCosines = 17, kValues = 9;
  double shareAt(int node) const noexcept;
  static double cosineAt(int node) noexcept;

  double closing_share_;
  std::array<double, std::size_t{kShares} * kCosines * kValues> values_;
};

/// Returns the table for a separation angle, which all balls of the process share; may be called by
/// several threads. An unused one is kept until another one is made: a single ball may be removed
/// and added again. Cost if it is new: SphereTable().
std::shared_ptr<const SphereTable> sharedSphereTable(double separation_cosine);

/// Returns true if the loads on a sphere need a table: friction, and pressure at separation angles
/// above pi/2, have no closed form for every spin.
bool needsSphereTable(const LoadSettings& settings) noexcept;

/// Pressure and friction on a smooth sphere, about its centre and for the twist at its centre: the
/// limit of computeFaceLoads() for fine meshes. Pressure at alpha = pi/2 is exact; other results
/// have the errors of SphereTable. The power is never positive, up to rounding. docs/theory.md eq.
/// (40) to (42). radius [m]; reference_length [m]: sqrt(area).
/// @pre `table` was made for the separation angle; may be null if needsSphereTable() is false
FaceLoads computeSphereLoads(const SphereTable* table, double radius, double reference_length,
                             const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
