#pragma once

#include <memory>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/scene_body_cache.h"

namespace ambient {

/// One body of a scene, ready for the world. The shape's frame S is that of the scene file.
struct PreparedBody {
  Surface surface;                              ///< of the shape, in S [m]
  std::shared_ptr<const FluidBody> fluid_body;  ///< null: the fluid does not act on it
  Vector3 fluid_origin = Vector3::Zero();       ///< origin of the fluid body's frame F in S [m]
  Vector3 centre_of_mass = Vector3::Zero();     ///< in S [m]
  double mass = 0;                              ///< [kg]; 0: static
  Matrix3 inertia = Matrix3::Zero();            ///< about the centre of mass, S's axes [kg m^2]
};

/// The bodies of a scene: the fluid body of every dynamic body, the surface and the mass of all.
/// Cost: the boundary element solutions that the cache does not have.
/// @throws std::runtime_error, one line that names the file or the body and what is wrong.
std::vector<PreparedBody> prepareBodies(const Scene& scene, SceneBodyCache& fluid_bodies);

/// A surface in another place.
Surface moved(Surface surface, const Vector3& by);

}  // namespace ambient
