#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/wing_plan.h"
#include "preprocess/mesh/holds/hold_search.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {

/// Largest number of faces or panels that a mesh is divided into; a finer mesh keeps its own
/// triangles.
constexpr int kMostDivisions = 1000000;

/// Panels into which the flow around a mesh is divided by default: a box of 12 triangles comes out
/// within 1 % of the largest entry of each block of the added mass, in one to two seconds.
constexpr int kDefaultPanels = 4200;

/// Name of this library with version and revision of the solver, for Provenance::generator.
std::string libraryVersion();

/// Settings for making a fluid body, from a mesh or from a shape.
struct CommonBuildSettings {
  std::string name;  ///< name of the fluid body
  /// Origin of the fluid body frame F in the frame of the mesh or shape [m]; none: the centre of
  /// volume, of a sheet the centre of its area.
  std::optional<Eigen::Vector3d> origin;
  HoldSearch holds;     ///< of meshes and of shapes that are united
  int least_faces = 0;  ///< the mesh is divided into at least so many triangles for the loads
  /// The flow is solved on up to max_panels, finer than the mesh where that helps, and on four
  /// times as many where long triangles need them; the faces remain those of the mesh.
  PotentialFlowSettings flow{false, kDefaultPanels};
  /// Subdivisions of the table for the surface of water, makeWaterlineTable(), 1 to
  /// kMostWaterlineSubdivisions; 0: no table. Neither a sheet nor a sphere can have one.
  int waterline_subdivisions = 0;
  /// Called with the name of each stage of the work when it begins; null: no calls.
  std::function<void(const std::string& stage)> begin = nullptr;
};

/// Settings for making a fluid body from a mesh.
struct BuildSettings : CommonBuildSettings {
  std::string source;     ///< begins every message: the file of the mesh; empty: the name
  TriangleMesh cavities;  ///< closed surfaces inside, as in CheckedMesh: empty in the uniform mass
  std::vector<Hold> found_holds;  ///< of a mesh that is a closed vessel, in its frame: empty, too
  TriangleMesh walls;             ///< with holds: the faces of walls alone, for the mass per area
  WingPlan wings;                 ///< for the triangles of the mesh
  double sphere_radius = 0;       ///< of a mesh that stands for a sphere [m]; 0: any other shape
  /// Added mass per unit density about the mesh's origin, if it is known: the flow is not solved.
  std::optional<Matrix6> added_mass;
  /// Parts of that added mass, about the mesh's origin; may be empty.
  std::vector<AddedMassPart> added_mass_parts;
  /// What is known besides in a fluid with viscosity, about the mesh's origin. Where the flow is
  /// solved, so is the separation; where it is not, what is missing stays unknown.
  KnownViscousFlow viscous_flow;
  Provenance provenance;  ///< copied; an empty generator becomes this library and its version
  /// Receives warnings about the result, one line each; null: no warnings.
  std::function<void(const std::string&)> warn = nullptr;
};

/// Finds the holds of a checked mesh, in place of which the closed vessel comes, adds those that
/// are given, and returns what a user should know about them, a line each.
/// @throws std::runtime_error as addGivenHolds()
std::vector<std::string> takeHolds(TriangleMesh& mesh, BuildSettings& settings);

/// Text of the settings of a search for Provenance::settings; begins with ", ".
std::string holdsText(const HoldSearch& search);

/// Makes a fluid body from a mesh: mass properties, added mass, faces. The axes of F are those of
/// the mesh. Both sides of a sheet are faces, first the front of all triangles, then the back; both
/// count in its area; its volume is 0. Cost: those of
/// solvePotentialFlow() and prepare().
/// @pre the mesh passed checkMesh() as a body or as a sheet.
/// @throws std::runtime_error in one line that begins with the source, if the mesh is smaller than
/// 1e-9 m or larger than 1e9 m or too narrow, the flow cannot be solved or needs more memory
/// than there is, or the waterline table cannot be made.
FluidBody makeFluidBody(const TriangleMesh& mesh, const BuildSettings& settings);

}  // namespace ambient
