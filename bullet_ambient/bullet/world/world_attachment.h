#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/world/fluid_body_source.h"
#include "bullet_ambient/immersed/attach_def.h"

class btCollisionObject;
class btCollisionShape;
class btCollisionWorld;
class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

AMBIENT_BEGIN

struct AmbientBody;
class AmbientBodies;

/// Settings of addAll(): how the bodies of a world meet the fluid.
struct AttachSettings {
  FlowSettings flow = {};
  FlightSettings flight = {};
  /// Chooses among the dynamic rigid bodies; empty: all.
  std::function<bool(const btRigidBody&)> filter = nullptr;
  /// Changes what a body is attached with: another medium, law or fluid body, or none, and then it
  /// is left out.
  std::function<void(const btRigidBody&, AttachDef&)> adjust = nullptr;
  /// Chooses among links of multibodies that have a collider, by their number; -1: the base.
  std::function<bool(const btMultiBody&, int)> filter_link = nullptr;
  std::function<void(const btMultiBody&, int, AttachDef&)> adjust_link = nullptr;
  /// Attaches bodies that are added to the world later, at the end of the first substep that they
  /// are in; in that one they move as in stock Bullet.
  bool later_bodies = false;
};

/// Result of addAll() for the bodies of a world. Bodies are numbered as in its array of objects.
struct AttachReport {
  struct Refusal {
    int body = 0;
    std::string reason;  ///< one line
  };
  struct LightBody {
    int body = 0;
    double mass = 0;            ///< [kg]
    double displaced_mass = 0;  ///< of the medium [kg]
  };

  int attached = 0;
  int fluid_bodies = 0;     ///< distinct ones, which these share
  int attached_before = 0;  ///< left as they are
  std::vector<Refusal> refused;
  std::vector<LightBody> light;  ///< lighter than the medium that they displace

  /// One line of numbers, and one for each body that was refused: "body 3 (Box): ...".
  std::string text() const;
};

/// Attaches the dynamic rigid bodies of a world, and the links of its multibodies that have a
/// collider and a mass, whatever it is, each with the fluid body that a source has for its
/// collision shape, in its frame.
class WorldAttachment {
 public:
  /// Bodies and source must outlive it.
  WorldAttachment(AmbientBodies& bodies, FluidBodySource& source, const Medium& medium,
                  AttachSettings settings);

  /// Attaches those that it has not met. Cost: that of fluid bodies that the source has to make.
  AttachReport attachNew(btCollisionWorld& world);

  /// Between two steps: attaches bodies that have come since, and gives all of them what the source
  /// has come to know better. Without news it allocates nothing, takes no lock and costs a
  /// comparison for each object of the world. What cannot be attached is told to the fluid's
  /// report.
  void update(btCollisionWorld& world) noexcept;

 private:
  // An object as it was met, and the fluid body that it was given.
  struct Met {
    const btCollisionObject* object = nullptr;
    int instance = -1;
    const FluidBody* given = nullptr;
  };

  bool hasMetAll(const btCollisionWorld& world) const noexcept;
  // The objects that it has not met before, null in place of all others.
  std::vector<btCollisionObject*> meetAll(const btCollisionWorld& world);
  const AmbientBody* attach(btCollisionObject& object, Met& met, AttachReport& report);
  const AmbientBody* attachBody(btRigidBody& body, Met& met, AttachReport& report);
  const AmbientBody* attachLink(btMultiBody& multi_body, int link, Met& met, AttachReport& report);
  AttachDef makeDef(const btCollisionShape* shape, Met& met) const;
  void replaceFluidBodies(btCollisionWorld& world);
  void tell(const std::string& sentence) const;

  AmbientBodies& bodies_;
  FluidBodySource& source_;
  Medium medium_;
  AttachSettings settings_;
  btMultiBodyDynamicsWorld* multibody_world_ = nullptr;  // of attachNew(), while it runs
  std::vector<Met> met_;                                 // in the order of the world
  unsigned revision_;
};

AMBIENT_END
