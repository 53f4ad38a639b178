#pragma once

#include <map>
#include <memory>
#include <unordered_map>

#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

/// What loads have in common, made when it is first asked for. Owned by who makes loads; for one
/// thread at a time, and never read by the loads themselves.
class LoadTables {
 public:
  using Body = std::shared_ptr<const FluidBody>;

  /// The faces that a law sums over, in double and in single precision. One for all who use those
  /// of the fluid body at the same time. Cost: formLawFaces() and PackedFaces().
  std::shared_ptr<const FaceTable> faces(const Body& body, PressureLaw law);
  std::shared_ptr<const PackedFaces> packedFaces(const Body& body, PressureLaw law);

  /// The table of a separation angle. Kept until another one is made while nobody uses it: a single
  /// ball may come and go. Cost: SphereTable().
  std::shared_ptr<const SphereTable> sphereTable(double separation_cosine);

 private:
  /// What was made of fluid bodies, as long as it is used.
  template <class Table>
  class MadeOf {
   public:
    template <class Make>
    std::shared_ptr<const Table> get(const Body& body, const Make& make);

   private:
    struct Entry {
      std::weak_ptr<const FluidBody> body;  ///< tells it from another one at its address
      std::weak_ptr<const Table> table;
    };
    std::unordered_map<const FluidBody*, Entry> entries_;
  };

  MadeOf<FaceTable> form_faces_;
  MadeOf<PackedFaces> packed_, packed_form_;
  std::map<double, std::shared_ptr<const SphereTable>> spheres_;  ///< by separation cosine
};

}  // namespace ambient
