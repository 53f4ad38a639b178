#pragma once

#include <map>
#include <memory>
#include <unordered_map>

#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/fluid_body/packed_hull.h"
#include "bullet_ambient/fluid_body/packed_parts.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

/// What loads have in common, made when it is first asked for. Owned by who makes loads; for one
/// thread at a time, and never read by the loads themselves.
class LoadTables {
 public:
  using Body = std::shared_ptr<const FluidBody>;

  using Faces = std::shared_ptr<const FaceTable>;

  /// formLawFaces(). One for all who use it at the same time, as below.
  Faces formFaces(const Body& body);
  /// Faces as `law` reads them in single precision. Cost: PackedFaces().
  std::shared_ptr<const PackedFaces> packedFaces(const Faces& faces, PressureLaw law);
  /// The triangles of a body that floats. Cost: PackedHull().
  std::shared_ptr<const PackedHull> hull(const Body& body);
  /// The parts of its added mass. Cost: PackedParts().
  std::shared_ptr<const PackedParts> addedMassParts(const Body& body);

  /// The table of a separation angle. Kept until another one is made while nobody uses it: a single
  /// ball may come and go. Cost: SphereTable().
  std::shared_ptr<const SphereTable> sphereTable(double separation_cosine);

 private:
  /// What was made of something, as long as it is used.
  template <class Source, class Table>
  class Made {
   public:
    template <class Make>
    std::shared_ptr<const Table> get(const std::shared_ptr<const Source>& source, const Make& make);

   private:
    struct Entry {
      std::weak_ptr<const Source> source;  ///< tells it from another one at its address
      std::weak_ptr<const Table> table;
    };
    std::unordered_map<const Source*, Entry> entries_;
  };

  Made<FluidBody, FaceTable> form_faces_;
  Made<FaceTable, PackedFaces> packed_, packed_form_;
  Made<FluidBody, PackedHull> hulls_;
  Made<FluidBody, PackedParts> parts_;
  std::map<double, std::shared_ptr<const SphereTable>> spheres_;  ///< by separation cosine
};

}  // namespace ambient
