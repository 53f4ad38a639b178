#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/collision_shape/shape_form.h"
#include "preprocess/collision_shape/solids.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Settings for making a fluid body from a collision shape.
struct CollisionShapeSettings {
  std::string name;  ///< name of the body, begins every message; empty: the shape's name
  int faces = 0;     ///< triangles aimed at, where the shape has no mesh of its own; 0: 1300; where
                     ///< the added mass is known 500, for a box 350, which makes 336, for a
                     ///< sphere 80
  PotentialFlowSettings flow{false, kDefaultPanels};  ///< as in BuildSettings
  /// Allowed error of the few faces that carry the loads by the form law in place of all,
  /// FormLevel::p99_error; 0: there are none. Bodies take them as far as
  /// FlowSettings::maximum_load_error allows.
  double load_error = 0.01;
  /// Subdivisions of the waterline table, BuildSettings; spheres, whose table all share, have none
  /// of their own.
  int waterline_subdivisions = 0;
  bool tables = true;  ///< true: tables of the added mass are used as far as they reach; false: the
                       ///< flow is solved
  bool holds = true;   ///< true: rooms of meshes and of united shapes stay dry, findHolds()
  /// True: triangles of a btGImpactMeshShape that are not a closed body are refused; false: they
  /// are wrapped, with a warning.
  bool strict = false;
  /// Called with the name of each stage of the work that may take long; null: no calls.
  std::function<void(const std::string& stage)> begin = nullptr;
  /// Receives one line for everything a user should know about a body that was made, or read from a
  /// folder: triangles that were turned round, children that could not be united. Default: standard
  /// error; null: nobody.
  BodyMaker::Report report = printReport;
};

/// Makes the fluid body of a form at size 1, in the shape's frame. What settings.report should be
/// told stands in provenance.said.
/// @throws std::runtime_error as makeFluidBody() of a collision shape.
FluidBody makeFormBody(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Returns the provenance that makeFormBody() gives its result; the same provenance means the same
/// result.
Provenance describeForm(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Returns true if the added mass of a form has a closed form or a table: its fluid body is made in
/// about a millisecond.
bool isSoonMade(const ShapeForm& form, const CollisionShapeSettings& settings);

/// Checks the settings. @throws std::runtime_error in one line that begins with `name`, if a value
/// is out of range
void requireUsable(const CollisionShapeSettings& settings, const std::string& name);

}  // namespace ambient
