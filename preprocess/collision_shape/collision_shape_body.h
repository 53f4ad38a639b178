#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <functional>
#include <string>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/fluid_body_builder.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// How much a fluid body may cost.
enum class Quality {
  kInstant,   ///< milliseconds: few faces, added mass of the ellipsoid with the second moments
  kStandard,  ///< seconds: the flow is solved
};

/// What stands for children of a compound that touch or overlap and cannot be united.
enum class CompoundFallback {
  kHull,    ///< their convex hull: the flow around it, more volume
  kSum,     ///< the sum of what each has alone: the right volume where they only touch, no flow
            ///< between them
  kRefuse,  ///< nothing: an exception
};

constexpr int kInstantFaces = 400;

/// How a fluid body is made from a collision shape.
struct CollisionShapeSettings {
  CollisionShapeSettings();

  std::string name;     ///< of the body, begins every message; empty: the shape's name
  bool margins = true;  ///< convex hulls and cones are as large as Bullet collides with them,
                        ///< margin included; false: as they were given
  int faces = 1300;     ///< triangles aimed at, where the shape has no mesh of its own
  PotentialFlowSettings flow{false, kDefaultPanels};  ///< as in BuildSettings
  /// Of the few faces that carry the loads by the form law in place of all, FormLevel::p99_error;
  /// 0: there are none. Bodies take them as far as FlowSettings::maximum_load_error allows.
  double load_error = 0.01;
  /// Subdivisions of the waterline table, BuildSettings, where the quality is kStandard; spheres,
  /// whose table all share, have none of their own.
  int waterline_subdivisions = 0;
  bool tables = true;  ///< of the added mass, as far as they reach; false: the flow is solved
  CompoundFallback fallback = CompoundFallback::kHull;
  /// kInstant: at most kInstantFaces faces; closed forms stay. A FluidBodyCache then goes on to
  /// kStandard in the background.
  Quality quality = Quality::kStandard;
  /// Receives one line for everything a user should know about a body that was made: margins that
  /// add more than a tenth to its volume, triangles that were turned round, children that could not
  /// be united. Default: standard error; null: nobody.
  std::function<void(const std::string&)> report;
};

/// The fluid body of a collision shape, whose frame F is that of the shape: a btRigidBody with the
/// shape needs no offset. Spheres and ellipsoids have closed forms; boxes, cylinders, capsules and
/// cones tables, as far as these reach; all else is solved.
///
/// Takes spheres, boxes, cylinders, capsules, cones, convex hulls, tetrahedra, multi-spheres,
/// btGImpactMeshShape (a closed mesh), btUniformScalingShape, and btCompoundShape of these, nested;
/// children that touch or overlap are united. Local scalings count. docs/preprocessor.md says what
/// margins do. Added mass is within 0.5 % of the largest entry of its block, for convex hulls
/// within 1 % and, where a margin rounds them, 3 %; docs/preprocessor.md has the table.
/// @throws std::runtime_error in one line that begins with the name: a plane, a height field, a
/// static triangle mesh, an empty or flat shape, a size that is not positive and finite, a mesh
/// that is not closed, settings that cannot be.
FluidBody makeFluidBody(const btCollisionShape& shape, const CollisionShapeSettings& settings = {});

/// Where makeFluidBody() says that its result came from: the kind of the shape, a hash of its
/// numbers, and the settings. Costs next to nothing; the same provenance means the same result.
/// @throws std::runtime_error for shapes and settings of a kind that makeFluidBody() refuses.
Provenance describeCollisionShape(const btCollisionShape& shape,
                                  const CollisionShapeSettings& settings = {});

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
