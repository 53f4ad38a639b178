#include "preprocess/resistance/prepare.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"

namespace ambient {
namespace {

ViscousForm viscousFormOf(const FluidBody& body, const KnownViscousFlow& known, int threads) {
  const TriangleMesh mesh = meshOf(body.surface);
  const bool sheet = body.volume == 0;
  ViscousForm form;
  form.resistance = known.resistance
                        ? *known.resistance
                        : computeStokesResistance(mesh, {sheet, StokesSettings().panels, threads});
  form.centre_of_reaction = centreOfReaction(form.resistance);
  if (known.separation) {
    form.separation = *known.separation;
  } else {
    form.separation.axes = translationAxes(body.added_mass);
  }
  form.surface = computeSurfaceNumbers(
      mesh, sheet, {body.centre_of_volume, form.centre_of_reaction}, form.separation.axes);
  form.sharp_share = sharpShare(body.form.shape);
  form.is_primitive = known.is_primitive;
  return form;
}

}  // namespace

void prepare(FluidBody& body, const KnownViscousFlow& known, int threads) {
  makeSurfaceForm(body, known.form_faces);
  if (body.sphere_radius > 0) {
    body.viscous = {};
  } else if (!body.surface.triangles.empty()) {
    body.viscous = viscousFormOf(body, known, threads);
  }
}

bool isComplete(const FluidBody& body) {
  return isPrepared(body) &&
         (body.sphere_radius > 0 || body.surface.triangles.empty() || body.viscous.isKnown());
}

FluidBody readPrepared(const std::filesystem::path& file) {
  FluidBody body = readFluidBody(file);
  try {
    if (!isComplete(body)) prepare(body);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  return body;
}

namespace {

/// Mean of z z^T over a surface, z from a centre [m^2].
Matrix3 meanSquares(const TriangleMesh& mesh, double area, const Vector3& centre) {
  Matrix3 sum = Matrix3::Zero();
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3 c = Vector3(mesh.barycentre(t)) - centre;
    Matrix3 mean = c * c.transpose();
    for (int k = 0; k < 3; ++k) {
      const Vector3 r = Vector3(mesh.corner(t, k) - mesh.barycentre(t));
      mean += r * r.transpose() / 12;
    }
    sum += areaOf(mesh, t) * mean;
  }
  return sum / area;
}

}  // namespace

SurfaceNumbers computeSurfaceNumbers(const TriangleMesh& mesh, bool sheet,
                                     const BodyCentres& centres, const Matrix3& axes) {
  const double area = areaOf(mesh), sides = sheet ? 2 : 1;
  AMBIENT_ASSERT(area > 0);
  SurfaceNumbers numbers;
  numbers.diameter = std::sqrt(sides * area / kPi);
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    numbers.frontal += sides / 4 * (axes.transpose() * Vector3(mesh.twiceArea(t))).cwiseAbs();
  numbers.moments = (axes.transpose() * meanSquares(mesh, area, centres.volume) * axes).diagonal();
  const Matrix3 squares = meanSquares(mesh, area, centres.reaction);
  numbers.gyration = squares.trace() * Matrix3::Identity() - squares;
  return numbers;
}

double sharpShare(const FormShape& shape) {
  constexpr double kAllEdges = 0.9;
  const double eps = std::min(1.0, shape.edges / kAllEdges);
  return eps + shape.wing * (1 - eps);
}

}  // namespace ambient
