#pragma once

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/tasks/task_runner.h"

class btDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Which bodies are in which fluid. Shared by one AmbientSolver (or several, with a multithreaded
/// world) and one AmbientAction. Change it between steps only; it uses neither user pointers nor
/// callbacks of the world.
class AmbientRegistry {
 public:
  AmbientRegistry();
  AmbientRegistry(const AmbientRegistry&) = delete;
  AmbientRegistry& operator=(const AmbientRegistry&) = delete;

  /// Puts a dynamic body of this world into a fluid; it may be added to the world before or after.
  /// @throws std::invalid_argument, saying what and the limit: a kind of world that cannot carry
  /// the fluid, static body, attached twice, no fluid body, mass, inertia, medium or flow settings
  /// that are not physical.
  void attach(const btDynamicsWorld& world, btRigidBody& body, AttachDef def);
  /// The same for a solver that is used without a world, which then cannot be checked.
  void attach(btRigidBody& body, AttachDef def);
  /// Takes the body out of its fluid; it then moves as in stock Bullet. False if nothing was
  /// attached at this address. It looks at nothing else, so that a body may be detached after it
  /// was destroyed, too; a body that is destroyed without leaves an entry that nothing reads and
  /// that the next body at its address replaces.
  bool detach(const btRigidBody& body);
  bool isAttached(const btRigidBody& body) const { return find(&body) != nullptr; }

  /// Changes the fluid around an attached body; its velocity stays, and it wakes up if anything
  /// did change. Cheap where density and viscosity stay: a current may be given in every step.
  /// @throws std::invalid_argument if the body is not attached or the medium is not physical.
  void setMedium(const btRigidBody& body, const Medium& medium);
  const Medium& medium(const btRigidBody& body) const;

  /// Changes the shape of an attached body, say to scaled() of the old one after setLocalScaling()
  /// of its collision shape. `fluid_frame` as in AttachDef; without it, it stays. Set new mass
  /// properties before.
  /// @throws std::invalid_argument as attach(); the body then keeps its shape.
  void setFluidBody(const btRigidBody& body, std::shared_ptr<const FluidBody> fluid_body,
                    const FrameOffset& fluid_frame);
  void setFluidBody(const btRigidBody& body, std::shared_ptr<const FluidBody> fluid_body);

  /// Total inertia K in the body frame; docs/theory.md eq. (3). @throws as medium().
  const Matrix6& inertia(const btRigidBody& body) const;

  std::size_t size() const { return bodies_.size(); }
  AmbientCounters counters(const btRigidBody& body) const;
  AmbientCounters counters() const;

  /// Receives one sentence the first time something cannot be right: the action or the solver is
  /// missing from the world, a step's result was not finite, a step was too long for a motion, a
  /// body was attached whose moments of inertia no rigid body has, or whose fluid body is empty.
  /// Default: standard error.
  void setReport(std::function<void(const std::string&)> report);

  /// Flies the bodies of one group of the solver on the runner's threads; they end with the same
  /// bits. Null (default): on the solver's thread. The runner must outlive its use here.
  void setTaskRunner(TaskRunner* runner) { task_runner_ = runner; }
  TaskRunner* taskRunner() const { return task_runner_; }

  // For solver, action and saved states. Finds the body that was attached, never another one at its
  // address.
  // @pre the body is alive, or nothing was attached at its address.
  AmbientBody* find(const btCollisionObject* body);
  const AmbientBody* find(const btCollisionObject* body) const;
  const std::vector<std::unique_ptr<AmbientBody>>& bodies() const { return bodies_; }
  /// Takes over a body with a model, in place of what is attached at its address.
  void insert(std::unique_ptr<AmbientBody> ambient);
  enum class Complaint {
    kNoAction,
    kNoSolver,
    kNotFinite,
    kNotPhysical,
    kCoarse,
    kInertia,
    kEmpty,
    kCount
  };
  void complain(Complaint complaint) noexcept;
  /// What the loads of its bodies share.
  LoadTables& loadTables() { return load_tables_; }

 private:
  AmbientBody& require(const btRigidBody& body) const;
  void replaceDef(AmbientBody& ambient, AttachDef def);
  void complainOfOddities(const AmbientBody& ambient);
  void complain(Complaint complaint, const char* text) noexcept;

  std::vector<std::unique_ptr<AmbientBody>> bodies_;  // in the order of attachment
  std::unordered_map<const btCollisionObject*, AmbientBody*> by_object_;
  LoadTables load_tables_;
  TaskRunner* task_runner_ = nullptr;
  std::function<void(const std::string&)> report_;
  bool complained_[static_cast<int>(Complaint::kCount)] = {};
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
