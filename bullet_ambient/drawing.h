#pragma once

// FluidDrawing: what Bullet's debug drawer shows of a fluid.

#include <LinearMath/btVector3.h>

#include "bullet_ambient/bullet/core/precision_check.h"

class btIDebugDraw;

namespace ambient {

struct AmbientBody;
struct FluidRegion;
struct MotionView;

}  // namespace ambient

AMBIENT_BEGIN

/// Selection of what is drawn for bodies in a fluid, through the world's btIDebugDraw. Vectors are
/// drawn as lines from the point where they act: forces on the body, and velocities of the fluid
/// along its wall.
struct FluidDrawing {
  bool separation = false;        ///< a short normal per face: green attached, red separated
  bool slip_velocity = false;     ///< per attached face, blue
  bool pressure = false;          ///< force per attached face, orange
  bool friction = false;          ///< force per attached face, yellow
  bool buoyancy = false;          ///< at the centre of volume, cyan
  bool total_wrench = false;      ///< force white and torque magenta at the centre of mass
  bool centre_of_volume = false;  ///< a small cross, cyan
  bool water_surface = false;     ///< a net over each region's surface, blue
  /// Edges of the holds and openings of vessels, grey, and where the water in them meets the
  /// walls, blue.
  bool holds = false;
  /// Rectangles of the parts that lift, each in a colour of its own, with a line to a round nose;
  /// of foils at their angles, with a line to the leading edge.
  bool wings = false;
  /// Forces of the last substep at the centre of mass of bodies that Immersed::readWrench() has
  /// asked for: of waves violet, wind grey, added mass green-blue.
  bool read_forces = false;

  double length_per_velocity = 0.1;  ///< [m per m/s]
  double length_per_force = 0.01;    ///< [m per N]; for forces on the whole body
  /// [m per N]; for forces on single faces, which are smaller the more faces there are.
  double length_per_face_force = 1;
  double length_per_torque = 0.1;  ///< [m per N m]
  /// Half size of the net over a region without bounds, about the origin [m].
  double surface_extent = 10;
  double normal_length = 0.05;  ///< length of normals and cross over sqrt(wetted area) [1]

  static FluidDrawing all();
  bool drawsFaces() const { return separation || slip_velocity || pressure || friction; }
  bool drawsAnything() const {
    return drawsFaces() || buoyancy || total_wrench || centre_of_volume || water_surface || holds ||
           wings || read_forces;
  }
};

/// Colours of FluidDrawing: red, green, blue.
namespace fluid_colours {
inline const btVector3 kAttached(0, 1, 0), kSeparated(1, 0, 0),
    kSlip(btScalar(0.2), btScalar(0.4), 1), kPressure(1, btScalar(0.5), 0), kFriction(1, 1, 0),
    kBuoyancy(0, 1, 1), kForce(1, 1, 1), kTorque(1, 0, 1), kWater(0, btScalar(0.3), btScalar(0.8)),
    kWaves(btScalar(0.5), 0, 1), kWind(btScalar(0.7), btScalar(0.7), btScalar(0.7)),
    kHolds(btScalar(0.45), btScalar(0.5), btScalar(0.55)),
    kAddedMass(0, btScalar(0.7), btScalar(0.5)), kFoils(1, btScalar(0.9), btScalar(0.6));
/// Of the parts of a body in turn; the first one again after the last.
inline const btVector3 kWings[] = {{btScalar(0.9), btScalar(0.2), btScalar(0.2)},
                                   {btScalar(0.2), btScalar(0.7), btScalar(0.2)},
                                   {btScalar(0.3), btScalar(0.4), 1},
                                   {btScalar(0.9), btScalar(0.7), 0},
                                   {btScalar(0.7), btScalar(0.3), btScalar(0.9)},
                                   {0, btScalar(0.7), btScalar(0.8)}};
}  // namespace fluid_colours

/// Draws one body for its present motion. The total wrench is that of pressure, friction (after the
/// passivity guard) and buoyancy; the inertia of the fluid, waves and wind are no part of it. @pre
/// the body is in a fluid, alive and dynamic
void drawFluid(const AmbientBody& ambient, const MotionView& now, const FluidDrawing& what,
               btIDebugDraw& drawer);

/// Draws the water surface of a region at a time [s] as a net; nothing without gravity, which says
/// what is up.
void drawSurface(const FluidRegion& region, const btVector3& gravity, double time,
                 const FluidDrawing& what, btIDebugDraw& drawer);

AMBIENT_END
