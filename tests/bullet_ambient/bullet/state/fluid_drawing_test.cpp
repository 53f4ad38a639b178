#include <LinearMath/btIDebugDraw.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/drawing.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/spatial/rotation.h"
#include "preprocess/base/surface_form.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/vessel_bodies.h"

namespace ambient::test {
namespace {

struct Line {
  btVector3 from, to, colour;
};

class Recorder : public btIDebugDraw {
 public:
  void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override {
    lines_.push_back({from, to, colour});
  }
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                        const btVector3&) override {}
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return DBG_DrawNormals; }

  std::vector<Line> linesOf(const btVector3& colour) const {
    std::vector<Line> result;
    std::copy_if(lines_.begin(), lines_.end(), std::back_inserter(result),
                 [&](const Line& line) { return line.colour == colour; });
    return result;
  }
  Vector3 sumOf(const btVector3& colour) const {
    Vector3 sum = Vector3::Zero();
    for (const Line& line : linesOf(colour)) sum += toVector3(line.to) - toVector3(line.from);
    return sum;
  }
  std::size_t count() const { return lines_.size(); }
  void clear() { lines_.clear(); }

 private:
  std::vector<Line> lines_;
};

// A turning body in oblique flow, with its fluid frame shifted and turned.
class Drawing : public testing::Test {
 protected:
  Drawing() {
    scene.world.setDebugDrawer(&recorder);
    AttachDef attach;
    auto shape = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.5, 0.3, 0.2), 2));
    shape->centre_of_volume = Vector3(0.05, 0, 0.1);
    attach.fluid_body = shape;
    attach.medium = {900, 1e-3, Vector3(0.3, 0.1, 0), Vector3(0, 0.5, 0)};
    attach.flow.separation_angle = 1.7;
    attach.flow.law = PressureLaw::kPublished;
    attach.fluid_frame = {rotationFromVector(Vector3(0.4, 0.1, -0.3)).toRotationMatrix(),
                          Vector3(0.02, 0.01, 0.03)};
    body = &scene.add({200, Vector3(5, 8, 9),
                       startWith({Vector3(1, -1, 2), Vector3(2, 1, -1)},
                                 rotationFromVector(Vector3(0.1, 0.8, 0.2)))});
    body->setGravity(btVector3(0, 0, btScalar(-kGravity)));
    scene.fluid.add(*body, attach);
    scene.step(1e-3);
    recorder.clear();
  }
  ~Drawing() override { scene.world.setDebugDrawer(nullptr); }

  // Draws lines of these switches alone.
  void draw(const FluidDrawing& what) {
    scene.fluid.drawing = what;
    for (const bool is_drawn : {false, true}) {
      recorder.clear();
      if (!is_drawn) scene.removeAction();
      scene.world.debugDrawWorld();
      if (!is_drawn) {
        lines_of_stock_ = recorder.count();
        scene.addAction();
      }
    }
  }
  std::size_t lines() const { return recorder.count() - lines_of_stock_; }
  const AmbientBody& ambient() { return *ambientBodiesOf(scene.fluid).find(body); }
  Twist relativeTwist() {
    Twist relative = readState(*body).twist;
    relative.linear -= readState(*body).orientation.conjugate() * ambient().def->medium.velocity;
    return relative;
  }
  FaceLoads loads() {
    const AttachDef& def = *ambient().def;
    LoadSettings settings = loadSettings(def.medium, def.flow);
    const ShapeFactors factors(formShapeOf(*def.fluid_body));
    const bool is_form = settings.law == PressureLaw::kForm;
    if (is_form) settings.shape = &factors;
    return computeFaceLoads(
        is_form ? formLawFaces(*def.fluid_body, factors.shape) : def.fluid_body->faces,
        ambient().model().reference_length, def.fluid_frame.toF(relativeTwist()), settings);
  }
  Vector3 fromFluidFrame(const Vector3& vector_F) {
    return readState(*body).orientation * (ambient().def->fluid_frame.rotation * vector_F);
  }
  FluidDrawing unitLengths() const {
    FluidDrawing what;
    what.length_per_face_force = what.length_per_force = what.length_per_torque = 1;
    what.length_per_velocity = 1;
    return what;
  }
  std::size_t faceCount() { return ambient().def->fluid_body->faces.size(); }

  const double tolerance = byPrecision(1e-12, 1e-5);
  Recorder recorder;
  FluidWorld scene;
  btRigidBody* body = nullptr;

 private:
  std::size_t lines_of_stock_ = 0;
};

TEST_F(Drawing, NormalsShowWhereTheFlowIsAttached) {
  FluidDrawing what = unitLengths();
  what.separation = true;
  draw(what);
  EXPECT_EQ(lines(), faceCount());
  const auto attached = recorder.linesOf(fluid_colours::kAttached);
  const auto separated = recorder.linesOf(fluid_colours::kSeparated);
  EXPECT_GT(attached.size(), faceCount() / 4);
  EXPECT_GT(separated.size(), faceCount() / 4);
  EXPECT_EQ(attached.size() + separated.size(), faceCount());
  // Attached flow: angle between normal and velocity of the face below the separation angle.
  for (const Line& line : attached) {
    const btVector3 n = (line.to - line.from).normalized();
    const btVector3 u = body->getVelocityInLocalPoint(line.from - body->getCenterOfMassPosition()) -
                        toBullet(ambient().def->medium.velocity);
    EXPECT_GT(n.dot(u.normalized()), std::cos(1.7) - 1e-4);
  }
}

TEST_F(Drawing, NormalsAndTheCrossAreAsLongAsAskedFor) {
  const double reference_length = std::sqrt(ambient().def->fluid_body->area);
  for (const double normal_length : {0.05, 0.2}) {
    FluidDrawing what = unitLengths();
    what.normal_length = normal_length;
    what.separation = what.centre_of_volume = true;
    draw(what);
    auto drawn = recorder.linesOf(fluid_colours::kAttached);
    for (const btVector3& colour : {fluid_colours::kSeparated, fluid_colours::kBuoyancy}) {
      const auto more = recorder.linesOf(colour);
      drawn.insert(drawn.end(), more.begin(), more.end());
    }
    ASSERT_EQ(drawn.size(), faceCount() + 3);
    for (const Line& line : drawn)
      EXPECT_NEAR((toVector3(line.to) - toVector3(line.from)).norm(),
                  normal_length * reference_length, 10 * tolerance);
  }
}

TEST_F(Drawing, SlipVelocitiesLieInTheirFaces) {
  FluidDrawing what = unitLengths();
  what.slip_velocity = true;
  draw(what);
  const std::size_t drawn = lines();
  EXPECT_EQ(recorder.linesOf(fluid_colours::kSlip).size(), drawn);
  what.separation = true;
  draw(what);
  EXPECT_EQ(recorder.linesOf(fluid_colours::kAttached).size(), drawn);
  for (const Line& slip : recorder.linesOf(fluid_colours::kSlip)) {
    const auto normals = recorder.linesOf(fluid_colours::kAttached);
    const auto face = std::find_if(normals.begin(), normals.end(),
                                   [&](const Line& line) { return line.from == slip.from; });
    ASSERT_NE(face, normals.end());
    const btVector3 n = (face->to - face->from).normalized();
    const btVector3 v = slip.to - slip.from;
    EXPECT_NEAR(n.dot(v), 0, byPrecision(1e-12, 1e-4));
  }
}

TEST_F(Drawing, ArrowsOfFacesSumToTheirForces) {
  draw({});
  EXPECT_EQ(lines(), 0u);
  FluidDrawing what = unitLengths();
  what.pressure = what.friction = true;
  draw(what);
  const Vector3 pressure = fromFluidFrame(loads().pressure.force);
  const Vector3 friction = fromFluidFrame(loads().friction.force);
  EXPECT_GT(friction.norm(), 0.1);
  EXPECT_LT((recorder.sumOf(fluid_colours::kPressure) - pressure).norm(),
            tolerance * pressure.norm());
  EXPECT_LT((recorder.sumOf(fluid_colours::kFriction) - friction).norm(),
            10 * tolerance * friction.norm());
}

TEST_F(Drawing, PressureOfTheFormLawIsDrawnInTheLeeAsWell) {
  AttachDef def = *ambient().def;
  auto shape = std::make_shared<FluidBody>(*def.fluid_body);
  shape->faces.sharpness.assign(shape->faces.size(), 0.5);
  makeSurfaceForm(*shape);
  def.fluid_body = shape;
  def.flow.law = PressureLaw::kForm;
  scene.of(*body).remove();
  scene.fluid.add(*body, def);
  FluidDrawing what = unitLengths();
  what.pressure = true;
  draw(what);
  EXPECT_EQ(lines(), faceCount());
  const Vector3 expected = fromFluidFrame(loads().pressure.force);
  EXPECT_LT((recorder.sumOf(fluid_colours::kPressure) - expected).norm(),
            tolerance * expected.norm());
}

TEST_F(Drawing, BuoyancyActsAtTheCentreOfVolume) {
  FluidDrawing what = unitLengths();
  what.buoyancy = true;
  what.centre_of_volume = true;
  draw(what);
  EXPECT_EQ(lines(), 1u + 3u);
  const auto drawn = recorder.linesOf(fluid_colours::kBuoyancy);
  const RigidState state = readState(*body);
  const Vector3 centre = state.position + state.orientation * ambient().model().centre_of_volume;
  const Vector3 up(0, 0.5, kGravity);  // acceleration of the medium less gravity
  const Vector3 expected = 900 * ambient().def->fluid_body->volume * up;
  EXPECT_LT((toVector3(drawn[0].to - drawn[0].from) - expected).norm(),
            tolerance * expected.norm());
  for (const Line& line : drawn) {
    const btVector3 at = &line == &drawn[0] ? line.from : (line.from + line.to) / 2;
    EXPECT_LT((toVector3(at) - centre).norm(), tolerance * 1);
  }
}

TEST_F(Drawing, TheTotalIsTheWrenchThatTheFlightSees) {
  FluidDrawing what = unitLengths();
  what.total_wrench = true;
  draw(what);
  EXPECT_EQ(lines(), 2u);
  const RigidState state = readState(*body);
  Surroundings s = readSurroundings(ambient());
  s.applied = {Vector3::Zero(), ambient().model().mass * s.ambient_acceleration};  // buoyancy alone
  const BodyModel& model = ambient().model();
  const Twist x = relativeTwist();
  const Wrench total = wholeLoad(computeSurfaceLoad(model, x), model.resistance.get(), x) +
                       externalWrench(ambient().model(), s, state.orientation.toRotationMatrix());
  const Vector3 force = state.orientation * total.force;
  const Vector3 torque = state.orientation * total.torque;
  EXPECT_LT((recorder.sumOf(fluid_colours::kForce) - force).norm(), tolerance * force.norm());
  EXPECT_LT((recorder.sumOf(fluid_colours::kTorque) - torque).norm(), tolerance * torque.norm());
}

TEST_F(Drawing, ForcesThatAreReadAreThoseOfTheHandle) {
  FluidDrawing what = unitLengths();
  what.read_forces = true;
  draw(what);
  EXPECT_EQ(lines(), 0u);  // nobody has asked
  scene.of(*body).readWrench(true);
  scene.step(1.0 / 60);
  draw(what);
  EXPECT_EQ(lines(), 3u);
  const Vector3 force = scene.of(*body).wrench().added_mass.force;
  EXPECT_GT(force.norm(), 0.1);
  EXPECT_LT((recorder.sumOf(fluid_colours::kAddedMass) - force).norm(), tolerance * force.norm());
  EXPECT_EQ(recorder.linesOf(fluid_colours::kWaves).size(), 1u);
  EXPECT_EQ(recorder.linesOf(fluid_colours::kWind).size(), 1u);
}

TEST_F(Drawing, LeavesOutBodiesWithoutAFluidAndRemovedOnes) {
  draw(FluidDrawing::all());
  EXPECT_GT(lines(), 2 * faceCount());
  scene.of(*body).setMedium(Medium{});
  draw(FluidDrawing::all());
  EXPECT_EQ(lines(), 0u);
  scene.of(*body).setMedium(water());
  scene.world.removeRigidBody(body);
  draw(FluidDrawing::all());
  EXPECT_EQ(lines(), 0u);
}

class DrawingOfWater : public testing::Test {
 protected:
  DrawingOfWater() {
    scene.world.setDebugDrawer(&recorder);
    scene.world.setGravity(btVector3(0, 0, btScalar(-kGravity)));
  }
  ~DrawingOfWater() override { scene.world.setDebugDrawer(nullptr); }
  void draw() {
    recorder.clear();
    scene.world.debugDrawWorld();
  }

  Recorder recorder;
  FluidWorld scene;
};

TEST_F(DrawingOfWater, IsANetOnTheSurfaceWithinTheBounds) {
  FluidRegion pool;
  pool.bounds = RegionBounds{{-1, -2, -3}, {1, 2, 3}};
  pool.below = water();
  pool.surface = std::make_shared<WaterSurfaceFunction>([](const Vector3& at, double time) {
    return WaterSample{0.5 + 0.1 * at.x() + time - at.z(), {0, 0, 0}, {0, 0, 0}};
  });
  scene.fluid.addRegion(pool);
  scene.step(0.25);
  scene.fluid.drawing.water_surface = true;
  draw();
  const auto lines = recorder.linesOf(fluid_colours::kWater);
  EXPECT_EQ(lines.size(), 2U * 17 * 16);
  for (const Line& line : lines) {
    const Vector3 from = toVector3(line.from);
    EXPECT_NEAR(from.z(), 0.75 + 0.1 * from.x(), 1e-6);
    EXPECT_LE(std::abs(from.x()), 1 + 1e-6);
    EXPECT_LE(std::abs(from.y()), 2 + 1e-6);
  }
}

TEST_F(DrawingOfWater, OfHoldsIsTheirEdgesAndTheLevelOfTheirWater) {
  scene.fluid.addRegion(waterBelow(0));
  BodyDef def{200, Vector3(26, 84, 100)};
  def.start.orientation = rotationFromVector(Vector3(0.1, 0.05, 0.3));
  btRigidBody& body = scene.add(def);
  AttachDef attach{std::make_shared<FluidBody>(openBarge({}))};
  attach.fluid_frame.translation.z() = 0.12;
  attach.holds.water = {0.2};
  const Immersed afloat = scene.fluid.add(body, attach);
  scene.step(1e-3);
  draw();
  EXPECT_TRUE(recorder.linesOf(fluid_colours::kHolds).empty());
  scene.fluid.drawing.holds = true;
  draw();
  EXPECT_EQ(recorder.linesOf(fluid_colours::kHolds).size(), 18u);  // of 12 triangles
  const double tolerance = byPrecision(1e-12, 1e-5);
  const HoldWater water = afloat.holds()[0];
  Vector3 area = Vector3::Zero();
  for (const Line& line : recorder.linesOf(fluid_colours::kWater)) {
    const Vector3 from = toVector3(line.from) - water.level, to = toVector3(line.to) - water.level;
    EXPECT_NEAR(from.dot(water.normal), 0, tolerance);
    area += from.cross(to) / 2;
  }
  EXPECT_LT((area - area.norm() * water.normal).norm(), tolerance);
  EXPECT_NEAR(area.z(), water.area, 1e-6);  // of the level, and of the surface as it sloshes
  EXPECT_GT(water.area, 1.96 * 0.96);
  EXPECT_LT(recorder.sumOf(fluid_colours::kWater).norm(), tolerance);
  afloat.setWater(0, water.capacity);
  draw();
  EXPECT_TRUE(recorder.linesOf(fluid_colours::kWater).empty());
}

TEST_F(DrawingOfWater, WithoutBoundsReachesAsFarAsAskedFor) {
  scene.fluid.addRegion(waterBelow(0.5));
  scene.step(1e-3);
  scene.fluid.drawing.water_surface = true;
  for (const double extent : {10.0, 3.0}) {
    scene.fluid.drawing.surface_extent = extent;
    draw();
    Vector3 lowest = Vector3::Zero(), highest = Vector3::Zero();
    for (const Line& line : recorder.linesOf(fluid_colours::kWater)) {
      lowest = lowest.cwiseMin(toVector3(line.from));
      highest = highest.cwiseMax(toVector3(line.to));
    }
    EXPECT_LT((lowest - Vector3(-extent, -extent, 0)).norm(), 1e-6 * extent) << extent;
    EXPECT_LT((highest - Vector3(extent, extent, 0.5)).norm(), 1e-6 * extent) << extent;
  }
}

}  // namespace
}  // namespace ambient::test
