#pragma once

#include <map>
#include <memory>
#include <unordered_map>

#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

/// What loads have in common, made when it is first asked for. Owned by who makes loads; for one
/// thread at a time, and never read by the loads themselves.
class LoadTables {
 public:
  /// One for all who use those of the fluid body at the same time. Cost: PackedFaces().
  std::shared_ptr<const PackedFaces> packedFaces(const std::shared_ptr<const FluidBody>& body);

  /// The table of a separation angle. Kept until another one is made while nobody uses it: a single
  /// ball may come and go. Cost: SphereTable().
  std::shared_ptr<const SphereTable> sphereTable(double separation_cosine);

 private:
  struct Packed {
    std::weak_ptr<const FluidBody> body;  ///< tells it from another one at its address
    std::weak_ptr<const PackedFaces> faces;
  };
  std::unordered_map<const FluidBody*, Packed> packed_;
  std::map<double, std::shared_ptr<const SphereTable>> spheres_;  ///< by separation cosine
};

}  // namespace ambient
