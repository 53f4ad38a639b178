#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/hydrostatics.h"

namespace ambient {

class LoadTables;

/// Where a body is against the surface of the water; all in the frame of the plane.
struct Immersion {
  SurfacePlane plane;
  double low = 0, high = 0;  ///< least and largest s.z over the body [m]
  WetVolume wet;

  double size() const { return high - low; }             ///< H [m]
  double draught() const { return plane.height - low; }  ///< D, of the lowest point [m]
  double cover() const { return plane.height - high; }   ///< water above the highest point [m]
  bool isDry() const { return draught() <= 0; }
  /// So deep that the surface does not matter: the added mass is that of the body alone.
  bool isDeep() const { return cover() >= 2 * size(); }
};

/// Derivatives of an energy of the plane's place.
struct InertiaGradient {
  double by_height = 0;        ///< T_h
  Vector3 by_normal{0, 0, 0};  ///< T_s

  /// F_K, the force along s and the torque that go with the derivatives; docs/theory.md eq. (66).
  Wrench wrench(const SurfacePlane& plane) const {
    return {by_normal.cross(plane.normal), -by_height * plane.normal};
  }
};

/// Added mass of a body that the surface of the water is near of, for fast motions: the potential
/// is 0 on the undisturbed surface. Per unit density, in frame F. Never changes; one for all bodies
/// of a shape.
class WettedInertia {
 public:
  virtual ~WettedInertia() = default;

  /// K_w; symmetric, 0 for a dry body, FluidBody::added_mass of a deep one bit for bit. Eigenvalues
  /// may be negative by a hundredth of the largest. Allocates nothing.
  Matrix6 inertia(const Immersion& immersion) const noexcept;
  /// The same without the raised plane of an entering body, docs/theory.md eq. (65).
  Matrix6 unraisedInertia(const Immersion& immersion) const noexcept;
  /// Of 1/2 x.K_w x, for a twist at rest in F; 0 where K_w does not change.
  InertiaGradient gradient(const Immersion& immersion, const Twist& twist) const noexcept;

 protected:
  explicit WettedInertia(const Matrix6& deep) : deep_(deep) {}
  const Matrix6& deep() const { return deep_; }

 private:
  /// Neither dry nor deep; the plane at the height that the entering body raises it to.
  virtual Matrix6 inertiaAt(const Immersion& raised) const noexcept = 0;
  virtual InertiaGradient gradientAt(const Immersion& raised,
                                     const Twist& twist) const noexcept = 0;

  Matrix6 deep_;
};

/// Share of a body's volume in the water; of its height for a sheet, which has none.
double wetShare(const Immersion& immersion, double volume) noexcept;

/// By the parts of the added mass, docs/theory.md eq. (60), and the waterline table of the body,
/// eq. (61a), if it has one; of a sphere by a table of all spheres; without parts, the added mass
/// times the share of the volume. Cost: O(parts).
std::shared_ptr<const WettedInertia> makeWettedInertia(const std::shared_ptr<const FluidBody>& body,
                                                       LoadTables& tables);

}  // namespace ambient
