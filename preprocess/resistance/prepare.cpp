#include "preprocess/resistance/prepare.h"

#include <stdexcept>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "preprocess/resistance/surface_numbers.h"

namespace ambient {
namespace {

TriangleMesh meshOf(const Surface& surface) {
  TriangleMesh mesh;
  mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(
      surface.vertices.data(), 3, static_cast<Eigen::Index>(surface.vertices.size() / 3));
  mesh.triangles = Eigen::Map<const Eigen::Matrix3Xi>(
      surface.triangles.data(), 3, static_cast<Eigen::Index>(surface.triangles.size() / 3));
  return mesh;
}

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
  makeSurfaceForm(body);
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

}  // namespace ambient
