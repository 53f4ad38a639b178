#include <LinearMath/btIDebugDraw.h>

#include <iterator>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/drawing.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/foils.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/wet_state.h"
#include "bullet_ambient/immersed/wrench_sensor.h"

AMBIENT_BEGIN
namespace {

// Draws an arrow of a body at a pose; in body axes.
void drawArrow(const RigidState& pose, const Vector3& from, const Vector3& arrow,
               const btVector3& colour, btIDebugDraw& drawer) {
  const auto toWorld = [&](const Vector3& point) {
    return toBullet(Vector3(pose.position + pose.orientation * point));
  };
  drawer.drawLine(toWorld(from), toWorld(from + arrow), colour);
}

/// Draws faces of one part of a body by draw(from, arrow, colour); `shape`: by the form law, else
/// null.
template <class Draw>
void drawFaces(const FaceTable& faces, const ShapeFactors* shape, const AmbientBody& ambient,
               const Twist& relative, const FluidDrawing& what, const Draw& draw_arrow) {
  const FrameOffset& frame = ambient.def->fluid_frame;
  LoadSettings settings = loadSettings(ambient.medium, ambient.def->flow);
  settings.shape = shape;
  const double length = ambient.model().reference_length;
  const Twist x_F = frame.toF(relative);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const FaceFlow flow = computeFaceFlow(faces, i, length, x_F, settings);
    const Vector3 at = frame.rotation * faces.centroid(i) + frame.translation;
    const auto draw = [&](double scale, const Vector3& vector_F, const btVector3& colour) {
      draw_arrow(at, scale * (frame.rotation * vector_F), colour);
    };
    if (what.separation)
      draw(what.normal_length * length, faces.normal(i),
           flow.is_attached ? fluid_colours::kAttached : fluid_colours::kSeparated);
    if (what.pressure && (flow.is_attached || shape))
      draw(what.length_per_face_force, flow.pressure, fluid_colours::kPressure);
    if (!flow.is_attached) continue;
    if (what.slip_velocity) draw(what.length_per_velocity, flow.slip, fluid_colours::kSlip);
    if (what.friction) draw(what.length_per_face_force, flow.friction, fluid_colours::kFriction);
  }
}

template <class Draw>
void drawAllFaces(const AmbientBody& ambient, const Twist& relative, const FluidDrawing& what,
                  const Draw& draw) {
  const std::shared_ptr<const FluidBody>& body = ambient.def->fluid_body;
  if (ambient.def->flow.law != PressureLaw::kForm || body->sphere_radius > 0)
    return drawFaces(facesOf(*body), nullptr, ambient, relative, what, draw);
  const LoadTables tables(body);
  const LoadTables::Parts parts = tables.parts();
  for (const BodyPart& part : *parts)
    drawFaces(part.faces, &part.shape, ambient, relative, what, draw);
  if (parts->empty())
    drawFaces(body->form.faces, tables.shape().get(), ambient, relative, what, draw);
}

void drawWrenches(const WrenchSensor& sensor, const Vector3& place, double length_per_force,
                  btIDebugDraw& drawer) {
  const FluidWrench& wrench = sensor.wrench;
  const btVector3 from = toBullet(place);
  const auto draw = [&](const Wrench& part, const btVector3& colour) {
    drawer.drawLine(from, toBullet(Vector3(place + length_per_force * part.force)), colour);
  };
  draw(wrench.waves, fluid_colours::kWaves);
  draw(wrench.wind, fluid_colours::kWind);
  draw(wrench.added_mass, fluid_colours::kAddedMass);
}

// Each edge of the holds' triangles once, and the levels of their water.
void drawHolds(const AmbientBody& ambient, const MotionView& now, btIDebugDraw& drawer) {
  if (!ambient.vessel) return;
  const FrameOffset& frame = ambient.def->fluid_frame;
  for (const Hold& hold : ambient.vessel->shape->holds) {
    const auto corner = [&](std::int32_t vertex) -> Vector3 {
      return frame.rotation * vertexOf(hold.surface, vertex) + frame.translation;
    };
    const std::vector<std::int32_t>& triangles = hold.surface.triangles;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const std::int32_t a = triangles[i], b = triangles[i % 3 == 2 ? i - 2 : i + 1];
      if (a < b)
        drawArrow(now.state, corner(a), corner(b) - corner(a), fluid_colours::kHolds, drawer);
    }
  }
  for (const HoldWater& water : holdsOf(ambient, now))
    for (std::size_t i = 0; i + 1 < water.outline.size(); i += 2)
      drawer.drawLine(toBullet(water.outline[i]), toBullet(water.outline[i + 1]),
                      fluid_colours::kWater);
}

// Draws a rectangle by its middle and the vectors from there to the middles of two sides, and a
// line to the leading edge.
template <class Draw>
void drawPlate(const Vector3& middle, const Vector3& half_span, const Vector3& half_chord,
               const Vector3& nose, const btVector3& colour, const Draw& draw) {
  for (const double side : {-1.0, 1.0}) {
    draw(middle - half_span + side * half_chord, 2 * half_span, colour);
    draw(middle - half_chord + side * half_span, 2 * half_chord, colour);
  }
  if (!nose.isZero(0)) draw(middle, nose, colour);
}

template <class Draw>
void drawWings(const AttachDef& def, const Draw& draw) {
  const Matrix3& to_B = def.fluid_frame.rotation;
  const auto inBody = [&](const Vector3& place_F) -> Vector3 {
    return to_B * place_F + def.fluid_frame.translation;
  };
  std::size_t number = 0;
  for (const Wing& wing : def.fluid_body->wings) {
    const Vector3 half_span = to_B * (wing.span / 2 * wing.span_axis);
    const Vector3 half_chord = to_B * (wing.chord / 2 * wing.span_axis.cross(wing.facing));
    drawPlate(inBody(wing.centre), half_span, half_chord, wing.nose * half_chord,
              fluid_colours::kWings[number++ % std::size(fluid_colours::kWings)], draw);
  }
  for (std::size_t i = 0; def.flow.foils && i < def.flow.foils->size(); ++i) {
    const Foil& foil = def.flow.foils->foil(i);
    const Matrix3 axes = to_B * def.flow.foils->axesOf(i);
    const Vector3 half_chord = foil.chord / 2 * axes.col(0);
    drawPlate(inBody(foil.position), foil.span / 2 * axes.col(1), half_chord, half_chord,
              fluid_colours::kFoils, draw);
  }
}

}  // namespace

FluidDrawing FluidDrawing::all() {
  FluidDrawing all;
  all.separation = all.slip_velocity = all.pressure = all.friction = true;
  all.buoyancy = all.total_wrench = all.centre_of_volume = all.water_surface = all.holds =
      all.wings = all.read_forces = true;
  return all;
}

void drawSurface(const FluidRegion& region, const btVector3& gravity, double time,
                 const FluidDrawing& what, btIDebugDraw& drawer) {
  constexpr int kCells = 16;
  if (!region.surface || gravity.isZero()) return;
  const Vector3 up = -toVector3(gravity).normalized();
  Eigen::Index vertical = 0;
  up.cwiseAbs().maxCoeff(&vertical);
  RegionBounds bounds{Vector3::Constant(-what.surface_extent),
                      Vector3::Constant(what.surface_extent)};
  if (region.bounds) {
    bounds.lowest = bounds.lowest.cwiseMax(region.bounds->lowest);
    bounds.highest = bounds.highest.cwiseMin(region.bounds->highest);
  }
  const auto corner = [&](int i, int j) {
    Vector3 point = (bounds.lowest + bounds.highest) / 2;
    const Eigen::Index u = (vertical + 1) % 3, v = (vertical + 2) % 3;
    point[u] = bounds.lowest[u] + (bounds.highest[u] - bounds.lowest[u]) * i / kCells;
    point[v] = bounds.lowest[v] + (bounds.highest[v] - bounds.lowest[v]) * j / kCells;
    // Straight above or below that point.
    return toBullet(Vector3(point + region.surface->sample(point, time).height * up));
  };
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      drawer.drawLine(corner(i, j), corner(i, j + 1), fluid_colours::kWater);
      drawer.drawLine(corner(j, i), corner(j + 1, i), fluid_colours::kWater);
    }
}

void drawFluid(const AmbientBody& ambient, const MotionView& now, const FluidDrawing& what,
               btIDebugDraw& drawer) {
  AMBIENT_ASSERT(ambient.isInFluid());
  const BodyModel model = modelNow(ambient, now);
  const RigidState& state = now.state;
  Surroundings s = surroundingsOf(ambient, now.gravity, {});
  addFlowAlong(ambient, state.orientation, s);
  const Quaternion to_body = state.orientation.conjugate();
  const auto draw = [&](const Vector3& from, const Vector3& arrow, const btVector3& colour) {
    drawArrow(state, from, arrow, colour, drawer);
  };
  Twist relative = state.twist;
  relative.linear -= to_body * s.ambient_velocity;
  if (what.drawsFaces()) drawAllFaces(ambient, relative, what, draw);
  if (what.holds) drawHolds(ambient, now, drawer);
  if (what.wings) drawWings(*ambient.def, draw);

  const Vector3& centre = model.centre_of_volume;
  const Wrench lift =
      buoyancy(model.displaced_mass, centre, to_body * (s.gravity - s.ambient_acceleration));
  if (what.buoyancy) {
    draw(centre, what.length_per_force * lift.force, fluid_colours::kBuoyancy);
  }
  if (what.total_wrench) {
    Wrench total = lift;
    if (model.loads)
      total += wholeLoad(computeSurfaceLoad(model, relative, s), model.resistance.get(), relative);
    draw(Vector3::Zero(), what.length_per_force * total.force, fluid_colours::kForce);
    draw(Vector3::Zero(), what.length_per_torque * total.torque, fluid_colours::kTorque);
  }
  if (what.read_forces && ambient.sensor)
    drawWrenches(*ambient.sensor, state.position, what.length_per_force, drawer);
  for (int axis = 0; axis < 3 && what.centre_of_volume; ++axis) {
    const Vector3 arm = what.normal_length * model.reference_length / 2 * Vector3::Unit(axis);
    draw(centre - arm, 2 * arm, fluid_colours::kBuoyancy);
  }
}

AMBIENT_END
