#pragma once

#include <functional>
#include <memory>

class btDiscreteDynamicsWorld;

namespace ambient::pybullet {

/// Tells when a world is destroyed. Bullet destroys the island manager with its world: one of a
/// derived class, which works alike, takes its place.
class WorldEnd {
 public:
  /// `tell`: called once, while the world still has its actions and solver; may destroy this.
  /// @throws std::invalid_argument, in one sentence, if the world has an island manager of a class
  /// of its own
  WorldEnd(btDiscreteDynamicsWorld& world, std::function<void()> tell);
  /// Gives the world its own island manager back if it is alive.
  ~WorldEnd();
  WorldEnd(const WorldEnd&) = delete;
  WorldEnd& operator=(const WorldEnd&) = delete;

 private:
  struct Watch;
  btDiscreteDynamicsWorld& world_;
  std::shared_ptr<Watch> watch_;
};

}  // namespace ambient::pybullet
