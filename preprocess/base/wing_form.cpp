#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/body_parts.h"
#include "preprocess/base/surface_form.h"

namespace ambient {
namespace {

double squared(double x) { return x * x; }

/// W of eq. (158).
double shareOf(const Wing& wing, const LiftedPart& part, const FaceTable& faces) {
  double facing = 0, area = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    facing += faces.area[i] * squared(wing.facing.dot(faces.normal(i)));
    area += faces.area[i];
  }
  if (!(area > 0)) return 0;
  return wingShare(wing, part.volume, facing / area);
}

}  // namespace

FluidBody partOf(const FluidBody& body, std::size_t label) {
  FluidBody part;
  const std::size_t triangles = body.part_of_triangle.size();
  const std::vector<double> sharpness =
      body.faces.sharpness.empty() ? computeSharpness(body) : body.faces.sharpness;
  AMBIENT_ASSERT(triangles > 0 && body.faces.size() % triangles == 0);
  part.surface.vertices = body.surface.vertices;
  for (std::size_t t = 0; t < triangles; ++t)
    if (body.part_of_triangle[t] == label)
      for (std::size_t k = 3 * t; k < 3 * t + 3; ++k)
        part.surface.triangles.own().push_back(body.surface.triangles[k]);
  for (std::size_t face = 0; face < body.faces.size(); ++face) {
    if (body.part_of_triangle[face % triangles] != label) continue;
    part.faces.add(body.faces.normal(face), body.faces.centroid(face), body.faces.area[face]);
    part.faces.sharpness.push_back(sharpness[face]);
    part.area += body.faces.area[face];
  }
  part.centre_of_volume = label > 0 ? body.wings[label - 1].centre : body.centre_of_volume;
  if (label == 0) part.area = body.area;
  return part;
}

void makeWingForm(FluidBody& body) {
  SurfaceForm& form = body.form;
  form.faces = {};
  form.part_of_face.clear();
  for (std::size_t label = 0; label <= body.wings.size(); ++label) {
    const bool is_round = label > 0 && body.wings[label - 1].nose != 0;
    const FluidBody part = is_round ? FluidBody{} : partOf(body, label);
    if (part.faces.size() == 0 && !is_round) continue;
    const FaceTable faces =
        is_round ? plateFaces(body.wings[label - 1]) : formLawFaces(part, FormShape{});
    for (std::size_t i = 0; i < faces.size(); ++i) {
      form.faces.add(faces.normal(i), faces.centroid(i), faces.area[i]);
      form.faces.sharpness.push_back(faces.sharpness[i]);
      form.part_of_face.push_back(static_cast<std::uint8_t>(label));
    }
  }
  const std::vector<LiftedPart> parts = liftedPartsOf(body);
  FluidBody rest = partOf(body, 0);
  rest.added_mass.bottomRightCorner<3, 3>() = parts.front().added_mass;
  rest.volume = parts.front().volume;
  rest.area = parts.front().area;
  rest.centre_of_volume = parts.front().centre;
  form.rest = formShapeOf(rest, false);
  form.wing_shares.clear();
  for (std::size_t i = 0; i < body.wings.size(); ++i)
    form.wing_shares.push_back(shareOf(body.wings[i], parts[i + 1], facesOfPart(form, i + 1)));
  for (std::size_t i = 0; i < form.faces.size(); ++i) {
    const std::size_t label = form.part_of_face[i];
    const double wing = label > 0 ? form.wing_shares[label - 1] : form.rest.wing;
    double& sharpness = form.faces.sharpness[i];
    if (sharpness < 1) sharpness += wing * (1 - sharpness);
  }
}

}  // namespace ambient
