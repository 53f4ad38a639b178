#pragma once

#include <memory>
#include <optional>

#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/law/surface_load.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Load as a step takes it up: a wrench that is given for the motion, and how the resistance in
/// creeping flow has grown, which the step solves for.
struct SplitLoad {
  Wrench wrench;
  Growth growth;
};

/// Loads of a fluid on the surface of one body: a law for a given shape and fluid. Immutable; owns
/// or shares all data it reads. Derive from this class for other laws than those of docs/theory.md,
/// such as a rival model or a measured polar.
class SurfaceLoads {
 public:
  virtual ~SurfaceLoads() = default;

  /// Load on the body for a twist relative to the ambient flow, both in frame(). Called from all
  /// threads that move bodies; must not allocate.
  virtual Wrench load(const Twist& relative_twist) const noexcept = 0;
  /// Load if only a part of the body is in the fluid. The default serves laws that do not sum over
  /// the surface: the load on the whole body times the share of its volume.
  virtual Wrench wetLoad(const Twist& relative_twist, const WetPart& wet) const noexcept {
    return wet.share * load(relative_twist);
  }
  /// load(), or with `wet` wetLoad(), without what resistance() makes of it: the sum is wrench +
  /// resistance()->load(growth, relative_twist). Default: all is in the wrench.
  virtual SplitLoad split(const Twist& relative_twist,
                          const WetPart* wet = nullptr) const noexcept {
    return {wet ? wetLoad(relative_twist, *wet) : load(relative_twist), {}};
  }
  /// Resistance in creeping flow, in frame(); null: none.
  virtual const Resistance* resistance() const noexcept { return nullptr; }
  /// Load split into pressure and friction, for drawing and reading. Default: all of it is
  /// pressure.
  virtual FaceLoads parts(const Twist& relative_twist) const noexcept {
    return {load(relative_twist), {}};
  }
  /// wetLoad() split likewise. The default serves laws that do not override that.
  virtual FaceLoads wetParts(const Twist& relative_twist, const WetPart& wet) const noexcept {
    const FaceLoads whole = parts(relative_twist);
    return {wet.share * whole.pressure, wet.share * whole.friction};
  }
  /// Number of faces that one evaluation sums.
  virtual int faces() const noexcept { return 0; }
  /// True if a load may feed energy to the body; docs/theory.md eq. (20) then removes this power.
  virtual bool needsGuard() const noexcept { return true; }
  /// Share of the load that grows with the way of the body until its wake has developed,
  /// docs/theory.md eq. (51d), of a smooth body by the form law. Default: none.
  virtual double wakeShare() const noexcept { return 0; }
  /// Pose in B of the frame of twists and wrenches, given that of F. Default: F; sphere: centre.
  virtual FrameOffset frame(const FrameOffset& fluid_frame) const { return fluid_frame; }
};

/// Combines medium and flow settings.
LoadSettings loadSettings(const Medium& medium, const FlowSettings& flow);

/// Finds the first fault of settings on whatever body: a number outside of its limits.
std::optional<NumberFault> faultOf(const FlowSettings& flow) noexcept;
/// Checks the settings for a body, on which the roughness is at most the root of its area.
/// @throws std::invalid_argument in one line, naming body, value and limit
void checkFlow(const FluidBody& body, const FlowSettings& flow);

/// Makes the loads by the law of the settings, evaluated in the cheapest way that body, medium and
/// settings allow; null if the body has no surface or the density is 0. docs/theory.md eq. (13) to
/// (17), spheres (40) to (42), form law (43) to (51). Cost: O(F); more
/// if a table is made.
/// @throws std::invalid_argument, naming value and limit, if faces or settings are not physical.
std::shared_ptr<const SurfaceLoads> makeSurfaceLoads(const std::shared_ptr<const FluidBody>& body,
                                                     const Medium& medium,
                                                     const FlowSettings& flow);

/// Makes the loads of a body that the surface of its fluid may cut. Sums over faces even if
/// makeSurfaceLoads() has a closed form. Without faces, or with flow.own_law, returns
/// the loads of makeSurfaceLoads().
std::shared_ptr<const SurfaceLoads> makeWaterlineLoads(const std::shared_ptr<const FluidBody>& body,
                                                       const Medium& medium,
                                                       const FlowSettings& flow);

}  // namespace ambient
