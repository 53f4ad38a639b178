#include "bullet_ambient/fluid_body/content_hash.h"

#include <string>

#include "bullet_ambient/base/fnv1a.h"

namespace ambient {

std::uint64_t contentHash(const FluidBody& body) {
  std::string bytes;
  const auto append = [&bytes](const double* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(double));
  };
  append(body.added_mass.data(), 36);
  append(&body.volume, 1);
  append(&body.area, 1);
  append(body.centre_of_volume.data(), 3);
  const auto appendFaces = [&append](const FaceTable& faces) {
    for (const std::vector<double>* column : faces.columns())
      append(column->data(), column->size());
    append(faces.sharpness.data(), faces.sharpness.size());
  };
  appendFaces(body.faces);
  for (const FormLevel& level : body.form_levels) appendFaces(level.faces);
  if (!body.drag.isZero(0)) append(body.drag.data(), 3);
  if (body.sphere_radius > 0) append(&body.sphere_radius, 1);
  append(body.surface.vertices.data(), body.surface.vertices.size());
  bytes.append(reinterpret_cast<const char*>(body.surface.triangles.data()),
               body.surface.triangles.size() * sizeof(std::int32_t));
  for (const AddedMassPart& part : body.added_mass_parts) {
    append(part.centre.data(), 3);
    append(part.spread.data(), 6);
    append(part.inertia.data(), 36);
  }
  append(body.waterline.immersions.data(), body.waterline.immersions.size());
  for (const Matrix6& correction : body.waterline.corrections) append(correction.data(), 36);
  return fnv1a64(bytes);
}

}  // namespace ambient
