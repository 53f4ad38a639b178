#include "bullet_ambient/fluid_body/body_parts.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

/// Area of a wing along z, half of that of its faces [m^2].
double planformOf(const Wing& wing, const FaceTable& faces) {
  double area = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    area += faces.area[i] * std::abs(wing.facing.dot(faces.normal(i)));
  return area / 2;
}

/// The matrix with 0 in place of negative eigenvalues.
Matrix3 positivePartOf(const Matrix3& matrix) {
  const SymmetricEigen<3> eigen = symmetricEigen<3>(matrix);
  return eigen.vectors * eigen.values.cwiseMax(0.0).asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

double wingShare(const Wing& wing, double volume, double phi) {
  if (wing.nose != 0) return 1;
  const auto squared = [](double x) { return x * x; };
  const double thick = squared(volume / wing.plateMass());
  const double aside = squared(1.5 * std::max(1 - phi, 0.0));
  return squared(std::max(1 - thick, 0.0)) * std::max(1 - aside, 0.0);
}

FaceTable plateFaces(const Wing& wing) {
  constexpr double kAlong[4][2] = {{-0.8611363115940526, 0.3478548451374538},
                                   {-0.3399810435848563, 0.6521451548625461},
                                   {0.3399810435848563, 0.6521451548625461},
                                   {0.8611363115940526, 0.3478548451374538}};
  const Vector3 &z = wing.facing, &h = wing.span_axis;
  const Vector3 across = std::sqrt(1.0 / 12) * wing.chord * h.cross(z);
  FaceTable faces;
  for (const double side : {1.0, -1.0})
    for (const auto& [place, weight] : kAlong)
      for (const double end : {1.0, -1.0})
        faces.add(side * z, wing.centre + end * across + place * wing.span / 2 * h,
                  weight / 4 * wing.span * wing.chord);
  faces.sharpness.assign(faces.size(), 1);
  return faces;
}

FaceTable facesOfPart(const SurfaceForm& form, std::size_t label) {
  AMBIENT_ASSERT(form.part_of_face.size() == form.faces.size());
  FaceTable faces;
  for (std::size_t i = 0; i < form.faces.size(); ++i) {
    if (form.part_of_face[i] != label) continue;
    faces.add(form.faces.normal(i), form.faces.centroid(i), form.faces.area[i]);
    faces.sharpness.push_back(form.faces.sharpness[i]);
  }
  return faces;
}

std::vector<LiftedPart> liftedPartsOf(const FluidBody& body) {
  constexpr double kLeastRest = 0.02;  // of the volume: below, what is left of K_vv is its error
  const Matrix3 whole = body.added_mass.bottomRightCorner<3, 3>();
  LiftedPart rest{whole, body.volume, 0, body.volume * body.centre_of_volume};
  std::vector<LiftedPart> parts(1);
  for (std::size_t i = 0; i < body.wings.size(); ++i) {
    const Wing& wing = body.wings[i];
    const double area = planformOf(wing, facesOfPart(body.form, i + 1));
    const Matrix3 added_mass = wing.plateMass() * wing.facing * wing.facing.transpose();
    parts.push_back({added_mass, area * wing.thickness, 2 * area, wing.centre});
    rest.added_mass -= added_mass;
    rest.volume -= parts.back().volume;
    rest.centre -= parts.back().volume * wing.centre;
  }
  parts.front().centre = body.centre_of_volume;
  if (!(rest.volume > kLeastRest * body.volume)) return parts;
  for (std::size_t i = 0; i < body.form.faces.size(); ++i)
    if (body.form.part_of_face[i] == 0) rest.area += body.form.faces.area[i];
  rest.centre /= rest.volume;
  rest.added_mass = positivePartOf(rest.added_mass);
  parts.front() = rest;
  return parts;
}

}  // namespace ambient
