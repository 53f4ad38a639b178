#pragma once

#include <filesystem>
#include <optional>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// What is known of a shape in a fluid with viscosity, beside its surface; in its frame.
struct KnownViscousFlow {
  std::optional<Matrix6> resistance;  ///< R about the origin; none: it is solved
  /// None: not known, all of the base counts as made by edges.
  std::optional<Separation> separation;
  bool is_primitive = false;  ///< as ViscousForm::is_primitive
};

/// Makes FluidBody::form and FluidBody::viscous from the other fields, also where they are there
/// already: a program that fills a fluid body by hand, or changes one, calls this before it
/// attaches the body. Spheres get none; without a surface `viscous` stays as it is. Cost O(F log
/// F), 2 us per face, and where R is solved that of computeStokesResistance().
/// @param body filled but for what this makes
/// @param known of its viscous flow; by default nothing
/// @param threads as StokesSettings::threads
/// @throws std::invalid_argument as computeSharpness(), std::runtime_error as
/// computeStokesResistance().
void prepare(FluidBody& body, const KnownViscousFlow& known = {}, int threads = 0);

/// True if nothing is missing that prepare() makes.
bool isComplete(const FluidBody& body);

/// Reads a .ambient file like readFluidBody(), and prepares what was written by earlier versions.
/// @throws std::runtime_error as readFluidBody(), also if the faces are not those of the surface.
FluidBody readPrepared(const std::filesystem::path& file);

}  // namespace ambient
