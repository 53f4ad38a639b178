#pragma once

#include <array>
#include <memory>

#include "bullet_ambient/force/loads/sphere_quadrature.h"

namespace ambient {

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

}  // namespace ambient
