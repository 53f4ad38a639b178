#pragma once

#include <filesystem>
#include <optional>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// What is known of a shape in a fluid with viscosity, beside its surface; in its frame.
struct KnownViscousFlow {
  std::optional<Matrix6> resistance;  ///< R about the origin; none: it is solved
  /// None: not known, all of the base counts as made by edges.
  std::optional<Separation> separation;
  bool is_primitive = false;       ///< as ViscousForm::is_primitive
  FormFaces form_faces = nullptr;  ///< as of makeSurfaceForm()
};

/// Makes FluidBody::form and FluidBody::viscous from the other fields, also where they are there
/// already: a program that fills a fluid body by hand, or changes one, calls this before it
/// attaches the body. Spheres get none; without a surface `viscous` stays as it is. Cost O(F log
/// F), 2 us per face, and where R is solved that of computeStokesResistance().
/// @param body filled but for what this makes
/// @param known of its viscous flow and faces; by default nothing
/// @param threads as StokesSettings::threads
/// @throws std::invalid_argument as computeSharpness(), std::runtime_error as
/// computeStokesResistance().
void prepare(FluidBody& body, const KnownViscousFlow& known = {}, int threads = 0);

/// True if nothing is missing that prepare() makes.
bool isComplete(const FluidBody& body);

/// Reads a .ambient file like readFluidBody(), and prepares what was written by earlier versions.
/// @throws std::runtime_error as readFluidBody(), also if the faces are not those of the surface.
FluidBody readPrepared(const std::filesystem::path& file);

/// Centres of a body in the frame of its mesh [m].
struct BodyCentres {
  Vector3 volume{0, 0, 0}, reaction{0, 0, 0};
};

/// Computes the sizes of a surface, exact integrals over its triangles. Cost O(T).
/// @param mesh of the body
/// @param sheet its triangles are a sheet, not a closed surface
/// @param centres of volume and of reaction, in the same frame
/// @param axes columns q_j
/// @pre the mesh has an area
SurfaceNumbers computeSurfaceNumbers(const TriangleMesh& mesh, bool sheet,
                                     const BodyCentres& centres, const Matrix3& axes);

/// Returns eps' in [0, 1], how far edges and thin plates fix where the flow leaves: eps + W (1 -
/// eps) with eps of eq. (51d), W of (45a). 0 of a ball, 1 of a box or plate.
double sharpShare(const FormShape& shape);

}  // namespace ambient
