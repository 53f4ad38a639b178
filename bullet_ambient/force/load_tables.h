#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/fluid_body/packed_hull.h"
#include "bullet_ambient/fluid_body/packed_parts.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

struct Medium;
class SurfaceLoads;
class WettedInertia;

/// Whether loads are those of a body in one fluid, or of one that the surface may cut.
enum class LoadPlace { kUnbounded, kWaterline };

/// Data that bodies of one shape have in common: made when first asked for, and kept as long as
/// somebody uses them. Owned by who makes loads; for one thread at a time, and never read by the
/// loads themselves.
class LoadTables {
 public:
  using Body = std::shared_ptr<const FluidBody>;
  using Faces = std::shared_ptr<const FaceTable>;

  /// Calls `make()` once for all bodies of a shape in a fluid, by settings without a law of their
  /// own, and returns its result.
  template <class Make>
  std::shared_ptr<const SurfaceLoads> loads(const Body& body, const Medium& medium,
                                            const FlowSettings& flow, LoadPlace place,
                                            const Make& make) {
    return loads_.get(body, keyOf(medium, flow, place), make);
  }
  /// Calls `make()` once for all bodies of a shape and returns their added mass at the surface of
  /// water.
  template <class Make>
  std::shared_ptr<const WettedInertia> wettedInertia(const Body& body, const Make& make) {
    return wetted_.get(body, {}, make);
  }

  /// formLawFaces().
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
  /// Tables made of a source by some settings, kept as long as they are used.
  template <class Source, class Table, class Settings = std::tuple<>>
  class Made {
   public:
    /// `make()` returns a shared table.
    template <class Make>
    std::shared_ptr<const Table> get(const std::shared_ptr<const Source>& source,
                                     const Settings& settings, const Make& make) {
      const std::pair<const Source*, Settings> key{source.get(), settings};
      if (const auto found = entries_.find(key); found != entries_.end())
        if (auto table = found->second.table.lock(); table && found->second.source.lock() == source)
          return table;
      if (entries_.size() >= most_entries_) dropUnused();
      std::shared_ptr<const Table> table = make();
      entries_[key] = {source, table};
      return table;
    }

   private:
    struct Entry {
      std::weak_ptr<const Source> source;  ///< tells it from another one at its address
      std::weak_ptr<const Table> table;
    };

    // Until the next time the number of entries may double: the cost per entry stays bounded.
    void dropUnused() {
      for (auto entry = entries_.begin(); entry != entries_.end();)
        entry = entry->second.table.expired() ? entries_.erase(entry) : std::next(entry);
      most_entries_ = 2 * entries_.size() + 1;
    }

    std::map<std::pair<const Source*, Settings>, Entry> entries_;
    std::size_t most_entries_ = 1;
  };

  using LoadKey = std::tuple<LoadPlace, double, double, double, bool, LoadPrecision, double,
                             PressureLaw, double>;
  static LoadKey keyOf(const Medium& medium, const FlowSettings& flow, LoadPlace place);

  Made<FluidBody, SurfaceLoads, LoadKey> loads_;
  Made<FluidBody, WettedInertia> wetted_;
  Made<FluidBody, FaceTable> form_faces_;
  Made<FaceTable, PackedFaces, PressureLaw> packed_;
  Made<FluidBody, PackedHull> hulls_;
  Made<FluidBody, PackedParts> parts_;
  std::map<double, std::shared_ptr<const SphereTable>> spheres_;  ///< by separation cosine
};

}  // namespace ambient
