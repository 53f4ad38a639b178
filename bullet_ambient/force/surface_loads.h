#pragma once

#include <memory>

#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/medium.h"
#include "bullet_ambient/force/surface_plane.h"
#include "bullet_ambient/spatial/frame_offset.h"

namespace ambient {

class LoadTables;

/// How much of a body is in the fluid.
struct WetPart {
  SurfacePlane plane;  ///< of the fluid, in the frame of the loads
  double share = 1;    ///< of its volume
};

/// What the fluid does to the surface of one body: a law, bound to a shape and a fluid. Never
/// changes, and owns or shares all that it reads. Derive from it for another law than those of
/// docs/theory.md, to compare with: a rival model, a measured polar.
class SurfaceLoads {
 public:
  virtual ~SurfaceLoads() = default;

  /// The load on the body for a twist relative to the ambient flow, both in frame(). Called from
  /// every thread that flies a body; allocates nothing.
  virtual Wrench load(const Twist& relative_twist) const noexcept = 0;
  /// The same where only a part of the body is in the fluid. A law that knows no places takes the
  /// share of the load on all of it.
  virtual Wrench wetLoad(const Twist& relative_twist, const WetPart& wet) const noexcept {
    return wet.share * load(relative_twist);
  }
  /// The same, split by origin, to be shown. A law that knows no parts has pressure alone.
  virtual FaceLoads parts(const Twist& relative_twist) const noexcept {
    return {load(relative_twist), {}};
  }
  /// Faces or clusters that one evaluation sums.
  virtual int faces() const noexcept { return 0; }
  /// Whether a load may feed energy to the body: then docs/theory.md eq. (20) takes it away.
  virtual bool needsGuard() const noexcept { return true; }
  /// The frame of twists and wrenches, given F: F, but for shapes that know a better one.
  virtual FrameOffset frame(const FrameOffset& fluid_frame) const { return fluid_frame; }
};

/// The settings in a medium.
LoadSettings loadSettings(const Medium& medium, const FlowSettings& flow);

/// The law of the settings, evaluated in the cheapest way that body, medium and settings allow;
/// null where there is nothing to load, or no fluid. This library's: docs/theory.md eq. (13) to
/// (17), reduced (36) to (39), on a sphere (40) to (42), by the form law (43) to (51). Cost: O(F);
/// more where a table is made.
/// @throws std::invalid_argument, naming value and limit, if faces or settings are not physical.
std::shared_ptr<const SurfaceLoads> makeSurfaceLoads(const std::shared_ptr<const FluidBody>& body,
                                                     const Medium& medium, const FlowSettings& flow,
                                                     LoadTables& tables);

/// The same for a body that the surface of its fluid may cut: by places, on faces even where
/// makeSurfaceLoads() knows a closed form or clusters. The loads are those of a body in the fluid
/// if there is no other way, times its share.
std::shared_ptr<const SurfaceLoads> makeWaterlineLoads(const std::shared_ptr<const FluidBody>& body,
                                                       const Medium& medium,
                                                       const FlowSettings& flow,
                                                       LoadTables& tables);

}  // namespace ambient
