#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/builder/shape_builder.h"

namespace ambient {
namespace {

ShapeDescription describe(decltype(ShapeDescription::geometry) geometry) {
  ShapeDescription shape;
  shape.geometry = std::move(geometry);
  shape.faces = 400;
  shape.source = shape.text = "shape";
  return shape;
}

std::string lastSetting(const Provenance& provenance) {
  return provenance.settings.substr(provenance.settings.rfind(", ") + 2);
}

/// A solver would need more memory than that.
ShapeBuildSettings withoutMemory() {
  ShapeBuildSettings settings;
  settings.flow.max_panels = 100000;
  settings.flow.memory_limit = 1;
  return settings;
}

TEST(KnownShape, SimpleShapesAreBuiltWithoutASolver) {
  ShapeBuildSettings settings = withoutMemory();
  settings.scale = 0.5;
  const auto built = [&](auto geometry) { return buildShape(describe(geometry), settings).body; };
  EXPECT_EQ(built(Box{{2, 3, 4}}).added_mass, boxAddedMass({1, 1.5, 2}).value());
  EXPECT_EQ(built(Cylinder{2, 6}).added_mass, cylinderAddedMass(1, 3).value());
  EXPECT_EQ(built(Capsule{2, 6}).added_mass, capsuleAddedMass(1, 3).value());
  const FluidBody cone = built(Cone{2, 6});
  // About the centre of volume, a quarter of the height above the base.
  EXPECT_NEAR(cone.origin.z(), -0.75, 1e-3);
  EXPECT_EQ(cone.added_mass, shiftOrigin(*coneAddedMass(1, 3), cone.origin));
  EXPECT_EQ(cone.added_mass, cone.added_mass.transpose());
  EXPECT_EQ(cone.added_mass(0, 3), 0);
  for (const FluidBody& body : {built(Box{{2, 3, 4}}), cone}) {
    EXPECT_EQ(lastSetting(body.provenance), "added mass tables 1");
    checkFluidBody(body, "known");
  }
}

TEST(KnownShape, AnOriginShiftsTheAddedMass) {
  ShapeBuildSettings settings = withoutMemory();
  settings.origin = Vector3(0.3, -0.2, 0.1);
  const FluidBody body = buildShape(describe(Cone{1, 3}), settings).body;
  EXPECT_EQ(body.added_mass, shiftOrigin(*coneAddedMass(1, 3), *settings.origin));
}

TEST(KnownShape, TheSolverGivesTheSame) {
  ShapeBuildSettings settings;
  settings.flow.max_panels = 2000;
  const ShapeDescription box = describe(Box{{1, 0.6, 0.3}});
  const FluidBody known = buildShape(box, settings).body;
  settings.tables = false;
  const FluidBody solved = buildShape(box, settings).body;
  EXPECT_EQ(lastSetting(solved.provenance), "panels 2000");
  const Vector6 change = (known.added_mass - solved.added_mass).diagonal().cwiseAbs();
  EXPECT_GT(change.maxCoeff(), 0);
  // 2000 panels; the default of 4200 is within 0.3 %.
  EXPECT_LT(change.head<3>().maxCoeff(), 0.01 * known.added_mass.diagonal().head<3>().maxCoeff());
  EXPECT_LT(change.tail<3>().maxCoeff(), 3e-3 * known.added_mass.diagonal().tail<3>().maxCoeff());
}

TEST(KnownShape, ProvenanceTellsTablesFromPanels) {
  const ShapeDescription box = describe(Box{{1, 2, 3}});
  ShapeBuildSettings settings;
  EXPECT_EQ(lastSetting(describeShape(box, settings)), "added mass tables 1");
  EXPECT_EQ(describeShape(box, settings).settings,
            buildShape(box, settings).body.provenance.settings);
  EXPECT_EQ(lastSetting(describeShape(describe(Box{{1, 2, 0.019}}), settings)), "panels 4200");
  settings.flow.solver = FlowSolverKind::Dense;
  EXPECT_EQ(lastSetting(describeShape(box, settings)), "dense");
  settings.flow.solver = FlowSolverKind::Automatic;
  settings.tables = false;
  EXPECT_EQ(lastSetting(describeShape(box, settings)), "panels 4200");
  EXPECT_EQ(lastSetting(describeShape(describe(Sphere{1}), settings)), "closed form");
}

TEST(KnownShape, BeyondTheTablesTheSolverIsAsked) {
  EXPECT_THROW(buildShape(describe(Box{{1, 2, 0.019}}), withoutMemory()), std::runtime_error);
}

}  // namespace
}  // namespace ambient
