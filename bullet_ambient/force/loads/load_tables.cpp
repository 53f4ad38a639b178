#include "bullet_ambient/force/loads/load_tables.h"

#include <map>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/medium/medium.h"

namespace ambient {
namespace {

using LoadKey = std::tuple<FluidExtent, double, double, double, double, bool, LoadPrecision, double,
                           PressureLaw, double>;

LoadKey keyOf(const Medium& medium, const FlowSettings& flow, FluidExtent extent) {
  return {extent,         medium.density,          medium.viscosity,
          flow.roughness, flow.separation_angle,   flow.skin_friction,
          flow.precision, flow.maximum_load_error, flow.law,
          flow.stall_lag};
}

/// The rest of a body with wings, then its wings.
std::vector<BodyPart> partsOf(const FluidBody& body) {
  std::vector<BodyPart> parts;
  if (body.wings.empty()) return parts;
  const std::vector<LiftedPart> lifted = liftedPartsOf(body);
  parts.push_back({ShapeFactors(body.form.rest), facesOfPart(body.form, 0), lifted.front()});
  for (std::size_t i = 0; i < body.wings.size(); ++i)
    parts.push_back({ShapeFactors(body.wings[i], body.form.wing_shares[i]),
                     facesOfPart(body.form, i + 1), lifted[i + 1]});
  return parts;
}

using Lock = std::lock_guard<std::recursive_mutex>;

}  // namespace

/// Tables in a fluid body. Loads and added mass at the surface hold the fluid body in turn: they
/// end with their last user.
struct BodyTables {
  std::recursive_mutex mutex;  // loads are made of other tables
  std::unique_ptr<const ShapeFactors> shape;
  std::unique_ptr<const std::vector<BodyPart>> parts;
  std::map<std::pair<const FaceTable*, bool>, std::unique_ptr<const PackedFaces>> packed;
  std::map<const FaceTable*, Vector3> own_drag;
  std::unique_ptr<const PackedHull> hull;
  SharedTables<FluidBody, SurfaceLoads, LoadKey> loads;
  SharedTables<FluidBody, WettedInertia> wetted;

  /// Returns one of the tables; calls make() if it is not there yet.
  template <class Table, class Make>
  std::shared_ptr<const Table> get(const LoadTables::Body& body,
                                   std::unique_ptr<const Table>& table, const Make& make) {
    const Lock lock(mutex);
    if (!table) table = std::make_unique<const Table>(make());
    return {body, table.get()};
  }
};

LoadTables::LoadTables(const Body& body) : body_(body), tables_(body->tables.get<BodyTables>()) {}

LoadTables::Loads LoadTables::loads(const Medium& medium, const FlowSettings& flow,
                                    FluidExtent extent, const std::function<Loads()>& make) const {
  const Lock lock(tables_.mutex);
  return tables_.loads.get(body_, keyOf(medium, flow, extent), make);
}

LoadTables::Wetted LoadTables::wettedInertia(const std::function<Wetted()>& make) const {
  const Lock lock(tables_.mutex);
  return tables_.wetted.get(body_, {}, make);
}

LoadTables::Shape LoadTables::shape() const {
  return tables_.get(body_, tables_.shape, [this] { return ShapeFactors(body_->form.shape); });
}

LoadTables::Parts LoadTables::parts() const {
  return tables_.get(body_, tables_.parts, [this] { return partsOf(*body_); });
}

std::shared_ptr<const PackedFaces> LoadTables::packedFaces(const Faces& faces,
                                                           const ShapeFactors* shape) const {
  const Lock lock(tables_.mutex);
  return tables_.get(body_, tables_.packed[{faces.get(), shape != nullptr}], [&] {
    return shape ? PackedFaces(*faces, shape->shape) : PackedFaces(*faces);
  });
}

Vector3 LoadTables::ownDrag(const Faces& faces, const Matrix3& axes, const Vector3& frontal) const {
  const Parts all = parts();
  const Shape whole = shape();
  Vector3 drag{0, 0, 0};
  for (int j = 0; j < 3; ++j) {
    if (all->empty()) drag[j] = ambient::ownDrag(*faces, *whole, axes.col(j), frontal[j]);
    for (const BodyPart& part : *all)
      drag[j] += ambient::ownDrag(part.faces, part.shape, axes.col(j), frontal[j]);
  }
  return drag;
}

Vector3 LoadTables::ownDrag(const Faces& faces) const {
  const Lock lock(tables_.mutex);
  const auto [entry, is_new] = tables_.own_drag.try_emplace(faces.get());
  if (!is_new) return entry->second;
  const ViscousForm& viscous = body_->viscous;
  entry->second = ownDrag(faces, viscous.separation.axes, viscous.surface.frontal);
  return entry->second;
}

std::shared_ptr<const PackedHull> LoadTables::hull() const {
  return tables_.get(body_, tables_.hull, [this] { return PackedHull(*body_); });
}

}  // namespace ambient
