#include "preprocess/collision_shape/collision_shape_body.h"

#include <cstdio>

#include "bullet_ambient/fluid_body/plain_text.h"
#include "preprocess/collision_shape/form_body.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
CollisionShapeSettings::CollisionShapeSettings()
    : report([](const std::string& text) {
        std::fprintf(stderr, "warning: %s\n", plainLine(text).c_str());
      }) {}

FluidBody makeFluidBody(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  return makeFormBody(readForm(shape, settings), settings);
}

Provenance describeCollisionShape(const btCollisionShape& shape,
                                  const CollisionShapeSettings& settings) {
  return describeForm(readForm(shape, settings), settings);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
