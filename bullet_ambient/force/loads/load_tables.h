#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/law/form_law.h"

namespace ambient {

/// Cache of tables, keyed by their source and settings; an entry lives while its table is used.
template <class Source, class Table, class Settings = std::tuple<>>
class SharedTables {
 public:
  /// Returns the table of a source and settings; calls make(), which returns a new one, if none.
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
    std::weak_ptr<const Source> source;  ///< detects a new source at a reused address
    std::weak_ptr<const Table> table;
  };

  // Erases entries of unused tables. The next call comes after the number of entries has doubled.
  void dropUnused() {
    for (auto entry = entries_.begin(); entry != entries_.end();)
      entry = entry->second.table.expired() ? entries_.erase(entry) : std::next(entry);
    most_entries_ = 2 * entries_.size() + 1;
  }

  std::map<std::pair<const Source*, Settings>, Entry> entries_;
  std::size_t most_entries_ = 1;
};

/// A part of a body with wings as the form law sees it: the rest, or a wing. Frame F.
struct BodyPart {
  ShapeFactors shape;
  FaceTable faces;  ///< of FluidBody::form
  LiftedPart lifted;
};

struct BodyTables;
struct Medium;
class SurfaceLoads;
class WettedInertia;

/// Kind of loads: body in one fluid, or body that the surface of the water may cut.
enum class FluidExtent { kUnbounded, kWaterline };

/// Tables of one fluid body, which all bodies of its shape in all worlds of the process share: each
/// is made on first use and kept as long as the fluid body. May be used by several threads; only
/// code that makes loads does, SurfaceLoads never. Results share the ownership of the fluid body.
class LoadTables {
 public:
  using Body = std::shared_ptr<const FluidBody>;
  using Faces = std::shared_ptr<const FaceTable>;
  using Shape = std::shared_ptr<const ShapeFactors>;
  using Loads = std::shared_ptr<const SurfaceLoads>;
  using Parts = std::shared_ptr<const std::vector<BodyPart>>;
  using Wetted = std::shared_ptr<const WettedInertia>;

  explicit LoadTables(const Body& body);

  /// Returns the loads in a medium by these settings; calls make() if nobody uses such loads.
  /// @pre flow.own_law is empty
  Loads loads(const Medium& medium, const FlowSettings& flow, FluidExtent extent,
              const std::function<Loads()>& make) const;
  /// Returns the added mass at the surface of the water; calls make() if nobody uses it.
  Wetted wettedInertia(const std::function<Wetted()>& make) const;

  /// Shape as the form law sees it.
  Shape shape() const;
  /// Faces of the fluid body, of a level of it or of the form law, packed in single precision for
  /// the form law of a shape; null: for the published law. Cost: PackedFaces().
  std::shared_ptr<const PackedFaces> packedFaces(const Faces& faces,
                                                 const ShapeFactors* shape) const;
  /// The rest of a body with wings, then its wings; none: it is one part.
  Parts parts() const;
  /// Returns ownDrag() of faces, of a body with wings of all its parts, along the columns of `axes`
  /// on frontal areas [m^2]. Cost: six sums over the faces.
  Vector3 ownDrag(const Faces& faces, const Matrix3& axes, const Vector3& frontal) const;
  /// Returns ownDrag() along the axes of the fluid body's separation, computed once.
  Vector3 ownDrag(const Faces& faces) const;
  /// Hull for hydrostatics. Cost: PackedHull().
  std::shared_ptr<const PackedHull> hull() const;

 private:
  Body body_;
  BodyTables& tables_;
};

}  // namespace ambient
