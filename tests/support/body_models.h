#pragma once

#include <memory>

#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/body_model.h"

namespace ambient::test {

/// For programs with one thread.
inline LoadTables& loadTables() {
  static LoadTables tables;
  return tables;
}

struct BodyModelDef {
  FluidBody shape;
  MassProperties mass{1, Matrix3::Identity()};
  Medium medium{1, 0, Vector3::Zero(), Vector3::Zero()};
  FlowSettings flow{};
  FrameOffset frame{};
};

/// A body with all its loads.
inline BodyModel modelOf(const BodyModelDef& def) {
  const auto shape = std::make_shared<const FluidBody>(def.shape);
  return makeBodyModel(*shape, def.frame, def.mass, def.medium,
                       makeSurfaceLoads(shape, def.medium, def.flow, loadTables()));
}

}  // namespace ambient::test
