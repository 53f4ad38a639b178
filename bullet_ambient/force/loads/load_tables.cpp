#include "bullet_ambient/force/loads/load_tables.h"

#include "bullet_ambient/fluid_body/sharpness.h"
#include "bullet_ambient/force/medium/medium.h"

namespace ambient {

LoadTables::LoadKey LoadTables::keyOf(const Medium& medium, const FlowSettings& flow,
                                      LoadPlace place) {
  return {place,
          medium.density,
          medium.viscosity,
          flow.separation_angle,
          flow.skin_friction,
          flow.precision,
          flow.maximum_load_error,
          flow.law,
          flow.stall_lag};
}

LoadTables::Faces LoadTables::formFaces(const Body& body) {
  return form_faces_.get(body, {}, [&] {
    return std::make_shared<const FaceTable>(formLawFaces(*body, shape(body)->shape));
  });
}

LoadTables::Shape LoadTables::shape(const Body& body) {
  return shapes_.get(body, {},
                     [&] { return std::make_shared<const ShapeFactors>(formShapeOf(*body)); });
}

std::shared_ptr<const PackedFaces> LoadTables::packedFaces(const Faces& faces,
                                                           const ShapeFactors* shape) {
  return packed_.get(faces, shape != nullptr, [&] {
    return shape ? std::make_shared<const PackedFaces>(*faces, shape->shape)
                 : std::make_shared<const PackedFaces>(*faces);
  });
}

std::shared_ptr<const PackedHull> LoadTables::hull(const Body& body) {
  return hulls_.get(body, {}, [&] { return std::make_shared<const PackedHull>(*body); });
}

std::shared_ptr<const PackedParts> LoadTables::addedMassParts(const Body& body) {
  return parts_.get(body, {},
                    [&] { return std::make_shared<const PackedParts>(body->added_mass_parts); });
}

std::shared_ptr<const SphereTable> LoadTables::sphereTable(double separation_cosine) {
  if (const auto found = spheres_.find(separation_cosine); found != spheres_.end())
    return found->second;
  for (auto entry = spheres_.begin(); entry != spheres_.end();)
    entry = entry->second.use_count() == 1 ? spheres_.erase(entry) : std::next(entry);
  return spheres_[separation_cosine] = std::make_shared<const SphereTable>(separation_cosine);
}

}  // namespace ambient
