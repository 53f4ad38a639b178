#include "tests/demos/pybullet/fake_server.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstring>

namespace ambient::pybullet::test {
namespace {

void addBox(btCompoundShape& compound, const btVector3& middle, const btVector3& half) {
  compound.addChildShape(btTransform(btQuaternion::getIdentity(), middle), new btBoxShape(half));
}

}  // namespace

FakeServer::FakeServer() { createWorld(); }

FakeServer::~FakeServer() {  // 2057
  deleteWorld();
  unload();
}

template <class Function>
Function* FakeServer::symbol(const char* name) const {
  return reinterpret_cast<Function*>(dlsym(plugin_, name));
}

Context FakeServer::makeContext() {
  Context context{};
  context.client = this;
  context.user_pointer = user_pointer_;
  return context;
}

bool FakeServer::load(const char* path) {  // b3PluginManager.cpp:227
  plugin_ = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
  if (!plugin_) {
    std::fprintf(stderr, "%s\n", dlerror());
    return false;
  }
  Context context = makeContext();
  context.server = this;
  const int version = symbol<int(Context*)>("initPlugin_ambient")(&context);
  user_pointer_ = context.user_pointer;
  return version == kApiVersion;
}

void FakeServer::unload() {  // b3PluginManager.cpp:340: without a server in the context
  if (!plugin_) return;
  Context context = makeContext();
  symbol<void(Context*)>("exitPlugin_ambient")(&context);
  dlclose(plugin_);
  plugin_ = nullptr;
}

std::string FakeServer::command(const std::string& text) {
  Arguments arguments{};
  // PhysicsClientC_API.cpp: a text that does not fit is left out.
  if (text.size() < sizeof arguments.text)
    std::memcpy(arguments.text, text.c_str(), text.size() + 1);
  Context context = makeContext();
  context.server = this;
  const int result =
      symbol<int(Context*, const Arguments*)>("executePluginCommand_ambient")(&context, &arguments);
  report();
  std::string answer = std::to_string(result) + " ";
  if (context.return_data)
    answer.append(context.return_data->bytes,
                  static_cast<std::size_t>(context.return_data->length));
  return answer;
}

bool FakeServer::connect() {  // PhysicsDirect.cpp:168
  helper_ = &dummy_;
  return true;
}

void FakeServer::setGuiHelper(GuiHelper* helper) {  // 2031
  if (helper) helper->createPhysicsDebugDrawer(world_.get());
  helper_ = helper;
}

void FakeServer::preTick(btDynamicsWorld* world, btScalar) {  // 2082
  auto& server = *static_cast<FakeServer*>(world->getWorldUserInfo());
  if (!server.plugin_) return;
  Context context = server.makeContext();
  server.symbol<int(Context*)>("preTickPluginCallback_ambient")(&context);
}

void FakeServer::notify(NotificationType type, int body) {
  Notification notification{};
  notification.type = type;
  notification.body = body;
  notifications_.push_back(notification);
}

void FakeServer::report() {  // b3PluginManager.cpp:427, after each command
  if (!plugin_ || notifications_.empty()) return;
  Context context = makeContext();
  context.notifications = notifications_.data();
  context.notification_count = static_cast<int>(notifications_.size());
  symbol<int(Context*)>("processNotifications_ambient")(&context);
  notifications_.clear();
}

void FakeServer::createWorld() {  // 2707
  solver_ = new btMultiBodyConstraintSolver;
  world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_, solver_,
                                                      &configuration_);
  if (helper_) helper_->createPhysicsDebugDrawer(world_.get());
  world_->setInternalTickCallback(preTick, this, true);
  world_->setGravity({0, 0, btScalar(-9.81)});
}

void FakeServer::deleteWorld() {  // 2904
  for (btMultiBody*& body : bodies_) destroy(body);
  bodies_.clear();
  world_.reset();
  delete solver_;
  solver_ = nullptr;
}

void FakeServer::reset(bool in_one_round) {  // 15901
  deleteWorld();
  createWorld();
  notify(kSimulationReset, 0);
  if (!in_one_round) report();
}

void FakeServer::changeSolver(bool has_mlcp) {  // 11436
  delete world_->getConstraintSolver();
  static btDantzigSolver dantzig;  // PyBullet makes one, which it never deletes
  solver_ =
      has_mlcp ? new btMultiBodyMLCPConstraintSolver(&dantzig) : new btMultiBodyConstraintSolver;
  world_->setMultiBodyConstraintSolver(solver_);
  report();
}

int FakeServer::add(double half_width, double mass) {
  auto* compound = new btCompoundShape;
  addBox(*compound, {0, 0, 0}, btVector3(1, 1, 1) * static_cast<btScalar>(half_width));
  return add(compound, mass);
}

int FakeServer::addTray(double mass) {
  auto* compound = new btCompoundShape;
  addBox(*compound, {0, 0, 0.01}, {0.5, 0.3, 0.01});
  for (const int side : {-1, 1}) {
    addBox(*compound, {side * 0.49, 0, 0.21}, {0.01, 0.3, 0.19});
    addBox(*compound, {0, side * 0.29, 0.21}, {0.48, 0.01, 0.19});
  }
  return add(compound, mass);
}

int FakeServer::add(btCompoundShape* compound, double mass) {
  btVector3 inertia;
  compound->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  auto* body = new btMultiBody(0, static_cast<btScalar>(mass), inertia, false, false);
  const int number = static_cast<int>(bodies_.size());
  body->setUserIndex2(number);
  body->setBasePos({static_cast<btScalar>(2 * number), 0, -1});
  body->finalizeMultiDof();
  auto* collider = new btMultiBodyLinkCollider(body, -1);
  collider->setCollisionShape(compound);
  collider->setWorldTransform(body->getBaseWorldTransform());
  body->setBaseCollider(collider);
  world_->addCollisionObject(collider, 1, -1);
  world_->addMultiBody(body);
  bodies_.push_back(body);
  notify(kBodyAdded, number);
  report();
  return number;
}

void FakeServer::destroy(btMultiBody*& body) {
  if (!body) return;
  btMultiBodyLinkCollider* collider = body->getBaseCollider();
  auto* compound = static_cast<btCompoundShape*>(collider->getCollisionShape());
  world_->removeCollisionObject(collider);
  delete collider;
  world_->removeMultiBody(body);
  delete body;
  body = nullptr;
  for (int i = 0; i < compound->getNumChildShapes(); ++i) delete compound->getChildShape(i);
  delete compound;
}

void FakeServer::remove(int number) {  // 12640
  destroy(bodies_[static_cast<std::size_t>(number)]);
  notify(kBodyRemoved, number);
  report();
}

void FakeServer::step(int count) {
  for (int i = 0; i < count; ++i) world_->stepSimulation(btScalar(1) / 240, 0);
}

double FakeServer::height(int number) const {
  return bodies_[static_cast<std::size_t>(number)]->getBasePos().z();
}

bool FakeServer::floats() {
  const int number = add(0.1, 4);
  step(60);
  return height(number) > -1;
}

}  // namespace ambient::pybullet::test
