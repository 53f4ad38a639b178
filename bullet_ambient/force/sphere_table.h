#pragma once

#include <array>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// What the flow leaves on a smooth sphere that spins, for one separation angle; docs/theory.md eq.
/// (40) to (42). In units of the radius and of V + W, V the speed of the centre and W that of the
/// equator. Each vector is given by its factors of e = v / V, a = w / |w| - (e.w / |w|) e and e x
/// a.
struct SphereIntegrals {
  Vector3 detached;         ///< of |t|^2 n over the detached surface
  Vector3 friction_force;   ///< of |t|^(4/5) t over the attached surface
  Vector3 friction_torque;  ///< of n x |t|^(4/5) t over the attached surface
};

/// Those integrals over the share of spin W / (V + W) and the cosine between spin and velocity, by
/// cubic interpolation between nodes of quadrature. Errors over pi, measured: 1e-4 rms, 6e-4 at
/// most for alpha of 1.5 pi/2; at angles closer to pi/2 (but for pi/2 itself: 1e-4) 1e-4 rms and up
/// to 6e-3 where the detached surface closes, 5e-4 and 1.4e-2 at 1.01 pi/2. 60 kB.
class SphereTable {
 public:
  /// Cost: 50 ms, 15 ms at alpha = pi/2.
  explicit SphereTable(double separation_cosine);

  /// @pre both are in [0, 1]; a negative cosine is the mirror image of a positive one.
  SphereIntegrals at(double spin_share, double cosine) const noexcept;

 private:
  // A spin across the velocity closes the detached surface where W |cos(alpha)| reaches V, with a
  // square root of the distance: nodes are dense there.
  static constexpr int kMiddle = 24, kShares = 2 * kMiddle + 1, kCosines = 17, kValues = 9;
  double shareAt(int node) const noexcept;
  static double cosineAt(int node) noexcept;

  double closing_share_;
  std::array<double, std::size_t{kShares} * kCosines * kValues> values_;
};

}  // namespace ambient
