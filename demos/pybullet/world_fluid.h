#pragma once

#include <LinearMath/btVector3.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/saved_state.h"
#include "demos/analysis/motion_sample.h"
#include "demos/pybullet/command.h"
#include "demos/pybullet/pybullet_interface.h"
#include "demos/pybullet/world_end.h"
#include "preprocess/collision_shape/fluid_body_cache.h"

namespace ambient::pybullet {

/// Returns the world of a server; null: it has none. Gives the server another helper for the time
/// of the call, and then its own again. Takes less than 16 us. `client`: Context::client.
btDiscreteDynamicsWorld* findWorld(Server& server, Client& client);

/// True if the members of PyBullet's class are where the plugin's Bullet has them. PyBullet builds
/// with the same API number differ: btMultiBody has other members before 3.1.7, and Bullet may be
/// built in single precision. Compares members that PyBullet never changes with their known values,
/// and counts of freedoms with their sums.
bool hasOurLayout(btDynamicsWorld& world);
bool hasOurLayout(const btMultiBody& multi_body);

/// Fluid body of a link that the user has chosen, with all that the command `body` says of it.
struct ChosenBody {
  std::string file;         ///< .ambient file; empty: the link's collision shape
  FrameOffset fluid_frame;  ///< F in the frame of the link's centre of mass
  double density = 0;       ///< mass of the link over its displaced volume [kg/m^3]; 0: any
  Vector3 drag{0, 0, 0};    ///< FluidBody::drag; 0: that of the file or shape
  std::string medium = "";  ///< water, air; empty: that of the region alone
  FlowSettings flow;
};

/// Reads a command `body`. `flow`: settings of all bodies.
/// @throws std::invalid_argument with one line
ChosenBody readChosenBody(const Command& command, const FlowSettings& flow);

/// Returns the definition of a link. `shape`: fluid body of its collision shape, in the frame of
/// its centre of mass; used without a file. A density scales the body about its centre of volume.
/// @throws std::exception with one line
AttachDef definitionOf(const ChosenBody& chosen, std::shared_ptr<const FluidBody> shape,
                       double mass);

/// Fluid of one world of a PyBullet server. Finds bodies and links by PyBullet's numbers.
class WorldFluid {
 public:
  /// Settings of all bodies that are added.
  struct Settings {
    FluidBodyCache& shapes;
    FlowSettings flow;
  };
  static constexpr int kAllLinks = -2;  ///< in place of a link's number

  /// Connects a fluid with the world. @throws std::invalid_argument, in one sentence, if the
  /// world's classes have other layouts than the plugin's, or Fluid refuses the world
  /// `printed`: sentences that need not be printed again, as of worlds before a reset. `at_end`:
  /// called when the world is destroyed; has to destroy this.
  WorldFluid(btMultiBodyDynamicsWorld& world, std::set<std::string>& printed,
             std::function<void()> at_end);

  Fluid& fluid() { return fluid_; }
  /// Length of the last substep [s]; before the first, Bullet's default.
  double timeStep() const;
  /// True once bodies have met the settings.
  bool hasBodies() const { return was_added_ || fluid_.size() > 0; }
  /// Call before each substep. Puts the fluid's solver into the place of the world's present one.
  /// With `has_news`, also adds all bodies that are in the world and not yet in the fluid. @throws
  /// std::invalid_argument, in one sentence, if a multibody has another layout than the plugin's
  void prepare(const Settings& settings, bool has_news);
  /// Checks settings on the collision shapes of all that moves in the world.
  /// @throws std::invalid_argument, in one line that names the first body that cannot have them
  void check(const FlowSettings& flow, FluidBodyCache& shapes) const;
  /// Removes a body that PyBullet has destroyed. Its number may be given to a new body.
  void forget(int body);
  /// Gives a body or link a fluid body that the user has chosen, in place of the one that it has.
  /// @throws std::exception, in one line, if there is no such body or link, if it cannot have it,
  /// or if it has foils
  void choose(int body, int link, const ChosenBody& chosen, FluidBodyCache& shapes);
  /// Gives a body or link in the fluid these foils, in place of those that it has, and adds it
  /// anew. @throws std::exception in one line
  void giveFoils(int body, int link, std::shared_ptr<const Foils> foils, const Settings& settings);
  /// Returns the pose of the fluid body's frame F in that of a body or link.
  FrameOffset frameOf(int body, int link) const;
  /// Returns the motion of a body or link: its centre of mass, axes of F.
  MotionSample motionInF(int body, int link) const;
  /// Total force and torque on a body or link after a push.
  struct Push {
    Wrench wrench;
    btVector3 force{0, 0, 0}, torque{0, 0, 0};
  };
  /// Pushes a body or link about its centre of mass, world axes. `last`: its push of the substep
  /// before, which is taken back where Bullet has kept the forces.
  void push(int body, int link, const Wrench& wrench, Push& last) const;
  /// Removes a body or link from the fluid, and never adds it again.
  void exclude(int body, int link);
  /// Returns the handle of a body or link; link -1: the base, or a rigid body. @throws
  /// std::invalid_argument if it is not in the fluid
  Immersed require(int body, int link) const;
  /// Returns the multibody with PyBullet's number `body`. @throws std::invalid_argument if there is
  /// none
  const btMultiBody& multiBody(int body) const;

  /// Calls visit(body, link, mass [kg], fluid body) for all that is in the fluid.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const auto& [key, member] : members_)
      if (member.isValid())
        visit(key.first, key.second, find(key.first, key.second).mass, *member.fluidBody());
  }

  /// Saves the state of the world in memory. Returns its number, from 0 on.
  std::size_t save();
  /// Restores a saved state by its number. @throws std::invalid_argument if there is no such state
  void restore(std::size_t state);
  /// Returns the first 100 reports of the fluid, among them reasons why bodies were refused and
  /// what was said of fluid bodies while they were made.
  const std::vector<std::string>& said() const { return said_; }

 private:
  using Key = std::pair<int, int>;  // numbers of body and link; link -1: base, or a rigid body
  // A rigid body, or a link of a multibody.
  struct Found {
    btRigidBody* rigid = nullptr;
    btMultiBody* multi_body = nullptr;
    const btCollisionObject* collider = nullptr;  // null: it has no collision shape
    double mass = 0;
  };
  Found find(int body, int link) const;
  void checkLayouts() const;
  void sayHulls();
  void attach(const Found& found, const Key& key, ChosenBody chosen, FluidBodyCache& shapes);
  void addAll(const Settings& settings);
  void storeHandles(const FluidBodyCache& shapes);
  void store(const Key& key, const Immersed& member, const FluidBodyCache& shapes);
  bool isWanted(int body, int link) const;
  void say(const std::string& sentence);
  void sayOnce(const std::string& sentence);

  btMultiBodyDynamicsWorld& world_;
  std::set<std::string>& printed_;
  WorldEnd end_;
  Fluid fluid_;
  bool was_added_ = false;  // true after addAll(): the fluid adds later bodies with its settings
  std::set<Key> excluded_;
  std::map<Key, Immersed> members_;
  /// Of members that were attached one by one, with their foils and where F is.
  std::map<Key, std::pair<ChosenBody, FrameOffset>> chosen_;
  // Links and bodies that passed the filters since the last storeHandles(), which looks them up.
  std::vector<std::pair<Key, const btMultiBody*>> new_links_;
  std::vector<std::pair<Key, const btRigidBody*>> new_bodies_;
  std::vector<WorldState> states_;
  std::vector<std::string> said_;
};

}  // namespace ambient::pybullet
