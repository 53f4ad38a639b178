#include "preprocess/polar/body_loads.h"

namespace ambient {

BodyLoads::BodyLoads(const std::shared_ptr<const FluidBody>& body, const Medium& medium,
                     const FlowSettings& flow) {
  FlowSettings in_double = flow;
  in_double.precision = LoadPrecision::kDouble;
  loads_ = makeSurfaceLoads(body, medium, in_double);
  if (loads_) frame_ = loads_->frame({});
}

FaceLoads BodyLoads::at(const Twist& x) const {
  if (!loads_) return {};
  const FaceLoads loads = loads_->parts(frame_.toF(x));
  return {frame_.toB(loads.pressure), frame_.toB(loads.friction)};
}

}  // namespace ambient
