#pragma once

#include <memory>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "preprocess/base/surface_form.h"

namespace ambient::test {

/// Flow by the published law, whose loads on ellipsoids have closed forms and are smooth.
inline FlowSettings publishedFlow() {
  FlowSettings flow;
  flow.law = PressureLaw::kPublished;
  return flow;
}

struct BodyModelDef {
  FluidBody shape;
  MassProperties mass{1, Matrix3::Identity()};
  Medium medium{1, 0, Vector3::Zero(), Vector3::Zero()};
  FlowSettings flow = publishedFlow();
  FrameOffset frame{};
};

/// Returns the model of a body with all loads; prepares the shape.
inline BodyModel modelOf(const BodyModelDef& def) {
  const auto shape = std::make_shared<FluidBody>(def.shape);
  if (def.flow.law == PressureLaw::kForm) makeSurfaceForm(*shape);
  return makeBodyModel(*shape, def.frame, def.mass, def.medium,
                       makeSurfaceLoads(shape, def.medium, def.flow));
}

}  // namespace ambient::test
