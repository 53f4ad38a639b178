#pragma once

#include <functional>
#include <memory>

#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/fluid_body/packed/packed_hull.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/law/form_law.h"

namespace ambient {

struct BodyTables;
struct Medium;
class SurfaceLoads;
class WettedInertia;

/// Kind of loads: body in one fluid, or body that the surface of the water may cut.
enum class LoadPlace { kUnbounded, kWaterline };

/// Tables of one fluid body, which all bodies of its shape in all worlds of the process share: each
/// is made on first use and kept as long as the fluid body. May be used by several threads; only
/// code that makes loads does, SurfaceLoads never. Results share the ownership of the fluid body.
class LoadTables {
 public:
  using Body = std::shared_ptr<const FluidBody>;
  using Faces = std::shared_ptr<const FaceTable>;
  using Shape = std::shared_ptr<const ShapeFactors>;
  using Loads = std::shared_ptr<const SurfaceLoads>;
  using Wetted = std::shared_ptr<const WettedInertia>;

  explicit LoadTables(const Body& body);

  /// Returns the loads in a medium by these settings; calls make() if nobody uses such loads.
  /// @pre flow.own_law is empty
  Loads loads(const Medium& medium, const FlowSettings& flow, LoadPlace place,
              const std::function<Loads()>& make) const;
  /// Returns the added mass at the surface of the water; calls make() if nobody uses it.
  Wetted wettedInertia(const std::function<Wetted()>& make) const;

  /// Shape as the form law sees it.
  Shape shape() const;
  /// Faces of the fluid body, of a level of it or of the form law, packed in single precision for
  /// the form law of a shape; null: for the published law. Cost: PackedFaces().
  std::shared_ptr<const PackedFaces> packedFaces(const Faces& faces,
                                                 const ShapeFactors* shape) const;
  /// Returns ownDrag() of faces along the axes of the fluid body's separation. Cost: six sums over
  /// the faces.
  Vector3 ownDrag(const Faces& faces) const;
  /// Hull for hydrostatics. Cost: PackedHull().
  std::shared_ptr<const PackedHull> hull() const;

 private:
  Body body_;
  BodyTables& tables_;
};

}  // namespace ambient
