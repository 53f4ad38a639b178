#pragma once

// Fluid::addAll(): a whole world in a fluid.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

class btCollisionObject;
class btCollisionShape;
class btMultiBody;
class btRigidBody;

namespace ambient {

struct FluidBody;

}  // namespace ambient

AMBIENT_BEGIN

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

AMBIENT_END
