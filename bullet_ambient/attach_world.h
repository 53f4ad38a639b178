#pragma once

// Fluid::addAll(): a whole world in a fluid.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

class btCollisionObject;
class btCollisionShape;
class btCollisionWorld;
class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

namespace ambient {

struct AmbientBody;
struct FluidBody;

}  // namespace ambient

AMBIENT_BEGIN

class AmbientBodies;

/// Interface for finding the fluid body of a collision shape. FluidBodyCache makes fluid bodies by
/// the preprocessor, which the runtime does not link; a program may derive from this class and use
/// its own table.
class FluidBodySource {
 public:
  virtual ~FluidBodySource() = default;

  /// Returns the fluid body of a shape, in the frame of the shape, which is also that of a
  /// btRigidBody with this shape. @throws std::exception with one line that says why there is none.
  virtual std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) = 0;

  /// Returns fluidBody() for a body of a world. `whose` names the body and says how many more there
  /// are, for lines about work that takes long: "body 'crane', 3 of 14".
  virtual std::shared_ptr<const FluidBody> fluidBodyOf(const std::function<std::string()>& whose,
                                                       const btCollisionShape& shape) {
    static_cast<void>(whose);
    return fluidBody(shape);
  }

  /// Shapes of bodies that are about to be added.
  struct Expected {
    std::vector<const btCollisionShape*> shapes;         ///< null: a body without one
    std::function<std::string(std::size_t)> whose = {};  ///< of each, as in fluidBodyOf()
  };

  /// Is told what the calling thread will ask fluidBodyOf() for next, so that fluid bodies may be
  /// made side by side; null: nothing more. `expected` stays until then. A shape that has no fluid
  /// body is no failure here: fluidBodyOf() says why.
  virtual void expect(const Expected* expected) noexcept { static_cast<void>(expected); }
};

/// Tells a source what is expected of it while this object exists.
class Expecting {
 public:
  Expecting(FluidBodySource& source, const FluidBodySource::Expected& expected) noexcept
      : source_(source) {
    source_.expect(&expected);
  }
  Expecting(const Expecting&) = delete;
  Expecting& operator=(const Expecting&) = delete;
  ~Expecting() { source_.expect(nullptr); }

 private:
  FluidBodySource& source_;
};

/// Settings of addAll(): how the bodies of a world meet the fluid.
struct AttachSettings {
  FlowSettings flow = {};
  FlightSettings flight = {};
  /// Chooses among the dynamic rigid bodies; empty: all.
  std::function<bool(const btRigidBody&)> filter = nullptr;
  /// Changes the definition of a body: another medium, law or fluid body. A body whose fluid body
  /// is set to null is left out.
  std::function<void(const btRigidBody&, AttachDef&)> adjust = nullptr;
  /// Chooses among links with a collider, by Bullet's number; -1: the base. Empty: all.
  std::function<bool(const btMultiBody&, int)> filter_link = nullptr;
  std::function<void(const btMultiBody&, int, AttachDef&)> adjust_link = nullptr;
  /// True: bodies that come to the world later are added, too, at the end of their first substep;
  /// in that substep they move as in stock Bullet.
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
  int fluid_bodies = 0;     ///< number of distinct fluid bodies of these
  int attached_before = 0;  ///< bodies that were in the fluid before; unchanged
  std::vector<Refusal> refused;
  std::vector<LightBody> light;  ///< lighter than the medium that they displace

  /// Returns one line of numbers, and one line for each refused body: "body 3 (Box): ...".
  std::string text() const;
};

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

AMBIENT_END
