#include "demos/simulation/body_surface.h"

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

Surface toSurface(const TriangleMesh& mesh) {
  Surface surface;
  surface.vertices.assign(mesh.vertices.data(), mesh.vertices.data() + mesh.vertices.size());
  surface.triangles.assign(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size());
  return surface;
}

Surface surfaceOf(const ShapeDescription& shape) {
  if (const auto* from_file = std::get_if<FluidBodyShape>(&shape.geometry))
    return readFluidBody(from_file->file).surface;
  return toSurface(makeShapeMesh(shape).mesh);
}

}  // namespace

Surface makeBodySurface(const BodyDef& def, const PreparedBody& prepared) {
  Surface surface = prepared.fluid_body ? prepared.fluid_body->surface : surfaceOf(def.shape);
  const Vector3 shift = prepared.fluid_origin - prepared.centre_of_mass;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    surface.vertices[i] += shift[static_cast<Eigen::Index>(i % 3)];
  return surface;
}

}  // namespace ambient
