#include "preprocess/collision_shape/shape_refusal.h"

#include "preprocess/mesh/input_error.h"

AMBIENT_BEGIN

void refuseShape(const btCollisionShape& shape, const std::string& name) {
  const std::string kind = shape.getName();
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
      raiseInputError(name, "a plane (", kind, ") is unbounded and cannot move in a fluid");
    case TERRAIN_SHAPE_PROXYTYPE:
      raiseInputError(name, "a height field (", kind,
                      ") encloses no volume and cannot move in a fluid");
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE:
      raiseInputError(name, "a static triangle mesh (", kind,
                      ") cannot move in Bullet: use btGImpactMeshShape or convex hulls");
    case EMPTY_SHAPE_PROXYTYPE:
      raiseInputError(name, "an empty shape (", kind, ") displaces no fluid");
    case SOFTBODY_SHAPE_PROXYTYPE:
      raiseInputError(name, "a soft body (", kind, ") has no rigid shape");
    default:
      raiseInputError(name, "a shape of type ", kind, " (", shape.getShapeType(),
                      ") is not supported: use a convex hull or a btGImpactMeshShape");
  }
}

AMBIENT_END
