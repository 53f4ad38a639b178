#include "preprocess/collision_shape/collision_shape_settings.h"

#include <cstdio>

#include "bullet_ambient/base/plain_text.h"

namespace ambient {

CollisionShapeSettings::CollisionShapeSettings()
    : report([](const std::string& text) {
        std::fprintf(stderr, "warning: %s\n", plainLine(text).c_str());
      }) {}

}  // namespace ambient
