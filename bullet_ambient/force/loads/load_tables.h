#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/fluid_body/packed/packed_hull.h"
#include "bullet_ambient/fluid_body/packed/packed_parts.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/law/shape_factors.h"
#include "bullet_ambient/force/loads/shared_tables.h"
#include "bullet_ambient/force/loads/sphere_table.h"

namespace ambient {

struct Medium;
class SurfaceLoads;
class WettedInertia;

/// Kind of loads: body in one fluid, or body that the surface of the water may cut.
enum class LoadPlace { kUnbounded, kWaterline };

/// Cache of data that bodies of one shape share. An entry is made on first use and kept while a
/// shared pointer to it exists. Not thread-safe: only code that makes loads uses the cache, and
/// SurfaceLoads never read it.
class LoadTables {
 public:
  using Body = std::shared_ptr<const FluidBody>;
  using Faces = std::shared_ptr<const FaceTable>;
  using Shape = std::shared_ptr<const ShapeFactors>;

  /// Returns the loads of a shape in a medium by these settings; calls make() if there are none.
  /// @pre flow.own_law is empty
  template <class Make>
  std::shared_ptr<const SurfaceLoads> loads(const Body& body, const Medium& medium,
                                            const FlowSettings& flow, LoadPlace place,
                                            const Make& make) {
    return loads_.get(body, keyOf(medium, flow, place), make);
  }
  /// Returns the added mass of a shape at the surface of the water; calls make() if there is
  /// none.
  template <class Make>
  std::shared_ptr<const WettedInertia> wettedInertia(const Body& body, const Make& make) {
    return wetted_.get(body, {}, make);
  }

  /// Faces of the form law, see formLawFaces().
  Faces formFaces(const Body& body);
  /// Shape as the form law sees it. Cost: formShapeOf().
  Shape shape(const Body& body);
  /// Faces packed in single precision for the form law of a shape; null: for the published law.
  /// Cost: PackedFaces().
  std::shared_ptr<const PackedFaces> packedFaces(const Faces& faces, const ShapeFactors* shape);
  /// Hull for hydrostatics. Cost: PackedHull().
  std::shared_ptr<const PackedHull> hull(const Body& body);
  /// Packed parts of the added mass. Cost: PackedParts().
  std::shared_ptr<const PackedParts> addedMassParts(const Body& body);

  /// Table for a separation angle. An unused table is kept until another one is made: a single ball
  /// may be removed and added again. Cost: SphereTable().
  std::shared_ptr<const SphereTable> sphereTable(double separation_cosine);

 private:
  using LoadKey = std::tuple<LoadPlace, double, double, double, bool, LoadPrecision, double,
                             PressureLaw, double>;
  static LoadKey keyOf(const Medium& medium, const FlowSettings& flow, LoadPlace place);

  SharedTables<FluidBody, SurfaceLoads, LoadKey> loads_;
  SharedTables<FluidBody, WettedInertia> wetted_;
  SharedTables<FluidBody, FaceTable> form_faces_;
  SharedTables<FluidBody, ShapeFactors> shapes_;
  SharedTables<FaceTable, PackedFaces, bool> packed_;  ///< by whether the form law is meant
  SharedTables<FluidBody, PackedHull> hulls_;
  SharedTables<FluidBody, PackedParts> parts_;
  std::map<double, std::shared_ptr<const SphereTable>> spheres_;  ///< by separation cosine
};

}  // namespace ambient
