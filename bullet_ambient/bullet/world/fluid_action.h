#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/drawing.h"

class btCollisionObject;
class btCollisionShape;
class btCollisionWorld;
class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

AMBIENT_BEGIN

class AmbientBodies;

/// Implements Fluid::addAll(): adds the dynamic rigid bodies of a world, and the links of its
/// multibodies that have a collider and a mass, each with the fluid body that a source has for its
/// collision shape.
class WorldAttachment {
 public:
  /// `bodies` and `source` must outlive this object.
  WorldAttachment(AmbientBodies& bodies, FluidBodySource& source, const Medium& medium,
                  AttachSettings settings);

  /// Adds the objects that this attachment has not seen before. Cost: that of the fluid bodies that
  /// the source has to make.
  AttachReport attachNew(btCollisionWorld& world);

  /// Adds bodies that have come since. Call between two steps. Without news it allocates nothing,
  /// takes no lock and costs one comparison per object of the world. Refusals go to the fluid's
  /// report function.
  void update(btCollisionWorld& world) noexcept;

 private:
  bool hasSeenAll(const btCollisionWorld& world) const noexcept;
  // Returns the objects that were not seen before; null in place of all others.
  std::vector<btCollisionObject*> seeAll(const btCollisionWorld& world);
  // A new object that is to be added.
  struct Candidate {
    int index = 0;   // in the world
    int number = 0;  // among the new ones
    btCollisionObject* object = nullptr;
    std::shared_ptr<const btCollisionShape> shape;
  };

  bool isToAdd(const btCollisionObject& object, AttachReport& report) const;
  bool isToAdd(const btRigidBody& body, AttachReport& report) const;
  bool isToAdd(const btMultiBody& multi_body, int link, AttachReport& report) const;
  const AmbientBody* attach(const Candidate& candidate, const std::function<std::string()>& whose);
  // Calls add(); what it throws becomes a refusal of the object.
  template <class Add>
  void addOr(const btCollisionObject& object, int index, AttachReport& report,
             const Add& add) const;
  // Returns the collision shape of an object; that of a link includes those of the links without
  // mass that it carries.
  std::shared_ptr<const btCollisionShape> shapeOf(const btCollisionObject& object) const;
  bool isWanted(const btMultiBody& multi_body, int link) const;

  AmbientBodies& bodies_;
  FluidBodySource& source_;
  Medium medium_;
  AttachSettings settings_;
  // Objects that were seen, in the order of the world, and their instance numbers.
  std::vector<std::pair<const btCollisionObject*, int>> seen_;
  btMultiBodyDynamicsWorld* multibody_world_ = nullptr;  // of attachNew() while it runs
};

/// Completes free flight after Bullet has moved the bodies, and draws. Forces are not applied here:
/// an action runs after the solver, its forces would be a substep late and lost in the last.
class FluidAction : public btActionInterface {
 public:
  /// Both must outlive the action. `drawing`: what debugDraw() draws.
  FluidAction(AmbientBodies& bodies, const FluidDrawing& drawing)
      : bodies_(bodies), drawing_(drawing) {}

  void updateAction(btCollisionWorld* world, btScalar time_step) override;
  void debugDraw(btIDebugDraw* drawer) override;

  /// Calls WorldAttachment::update() at the end of every substep from now on.
  void follow(std::unique_ptr<WorldAttachment> attachment);
  /// Adds bodies that have come to the world, as updateAction() does at its end.
  void attachLater(btCollisionWorld& world);
  /// Ends all follow().
  void followNothing() { followed_.clear(); }

 private:
  bool isSolverMissing(const btCollisionWorld& world);

  AmbientBodies& bodies_;
  const FluidDrawing& drawing_;
  std::vector<std::unique_ptr<WorldAttachment>> followed_;
  unsigned solved_ = 0;  // AmbientBodies::solved at the last step
  bool was_missing_ = false;
  const btCollisionWorld* world_ = nullptr;  // world of the last step
};

/// Finds which bodies and links of a world have their centre of mass in a hold of a vessel at a
/// surface of water, and the level there with what they displace: AmbientBody::in_hold of these,
/// and HoldState::displaced of the vessels, for the next substep. A body is in no hold that it is
/// larger than, and in the smallest vessel of several. Wakes what floats in a vessel that is awake.
/// Cost: 10 ns a body where none is smaller than the largest hold at a surface. Else a look at each
/// in the world, and the poses of links; the order from west to east of the smaller ones and of
/// vessels; for a body near a vessel the triangles of its holds; for a hold with bodies and water
/// some clips of all of them. Allocates nothing but for bodies that are new.
void findBodiesInHolds(btCollisionWorld& world, AmbientBodies& bodies) noexcept;

AMBIENT_END
