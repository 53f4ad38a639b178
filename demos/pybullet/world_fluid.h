#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/saved_state.h"

class btCollisionObject;
class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

namespace ambient::pybullet {

/// The fluid of one world of PyBullet's, with PyBullet's numbers of bodies. Ends with its world.
class WorldFluid {
 public:
  /// Settings that bodies are added with.
  struct Settings {
    FluidBodySource& shapes;
    FlowSettings flow;
  };
  static constexpr int kAllLinks = -2;

  /// @throws std::invalid_argument, in one sentence, if this world carries no fluid
  explicit WorldFluid(btMultiBodyDynamicsWorld& world);

  Fluid& fluid() { return fluid_; }
  /// Before a substep: puts the solver into its place and, `has_news`, adds bodies that have come.
  /// @throws std::invalid_argument, in one sentence, if the world has layouts of another PyBullet
  void prepare(const Settings& settings, bool has_news);
  /// PyBullet has destroyed a body.
  void forget(int body);
  /// Takes a body or link out, and leaves it out.
  void exclude(int body, int link);
  /// @throws std::invalid_argument if there is no such body or link in the fluid
  Immersed require(int body, int link) const;
  /// @throws std::invalid_argument if no multibody has the number
  const btMultiBody& multiBody(int body) const;

  std::size_t save();
  /// @throws std::invalid_argument if there is no such state
  void restore(std::size_t state);
  /// What the fluid has reported, and bodies that it has refused.
  const std::vector<std::string>& said() const { return said_; }

 private:
  using Key = std::pair<int, int>;  // body and link; -1: the base, or a rigid body
  void checkLayouts() const;
  void addAll(const Settings& settings);
  void keepHandles();
  bool isWanted(int body, int link) const;
  void say(const std::string& sentence);

  btMultiBodyDynamicsWorld& world_;
  Fluid fluid_;
  bool follows_ = false;
  std::set<Key> excluded_;
  std::map<Key, Immersed> members_;
  // What keepHandles() looks up.
  std::vector<std::pair<Key, const btMultiBody*>> new_links_;
  std::vector<std::pair<Key, const btRigidBody*>> new_bodies_;
  std::vector<WorldState> states_;
  std::vector<std::string> said_;
};

}  // namespace ambient::pybullet
