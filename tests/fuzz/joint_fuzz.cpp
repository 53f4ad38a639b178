#include <LinearMath/btIDebugDraw.h>

#include <stdexcept>

#include "bullet_ambient/bullet/core/conversions.h"
#include "tests/fuzz/fuzz_scene.h"

namespace ambient::test {
namespace {

// Joint frames that fit the present poses of the bodies.
struct JointFrames {
  btTransform in_a, in_b;

  JointFrames(const btRigidBody& a, const btRigidBody& b) {
    btTransform middle(a.getWorldTransform());
    middle.setOrigin((a.getWorldTransform().getOrigin() + b.getWorldTransform().getOrigin()) / 2);
    in_a = a.getWorldTransform().inverse() * middle;
    in_b = b.getWorldTransform().inverse() * middle;
  }
};

std::unique_ptr<btTypedConstraint> makeJoint(int kind, btRigidBody& a, btRigidBody& b) {
  const JointFrames frames(a, b);
  switch (kind) {
    case 0:
      return std::make_unique<btPoint2PointConstraint>(a, b, frames.in_a.getOrigin(),
                                                       frames.in_b.getOrigin());
    case 1: {
      auto hinge = std::make_unique<btHingeConstraint>(a, b, frames.in_a, frames.in_b);
      hinge->enableAngularMotor(true, 2, 5);
      hinge->setLimit(btScalar(-0.5), btScalar(0.5));
      return hinge;
    }
    case 2: {
      auto slider = std::make_unique<btSliderConstraint>(a, b, frames.in_a, frames.in_b, true);
      slider->setLowerLinLimit(btScalar(-0.2));
      slider->setUpperLinLimit(btScalar(0.2));
      return slider;
    }
    case 3:
      return std::make_unique<btConeTwistConstraint>(a, b, frames.in_a, frames.in_b);
    case 4: {
      auto spring =
          std::make_unique<btGeneric6DofSpring2Constraint>(a, b, frames.in_a, frames.in_b);
      spring->setLinearLowerLimit(btVector3(-1, -1, -1));
      spring->setLinearUpperLimit(btVector3(1, 1, 1));
      spring->enableSpring(0, true);
      spring->setStiffness(0, 50);
      spring->setDamping(0, 1);
      return spring;
    }
    default:
      return std::make_unique<btFixedConstraint>(a, b, frames.in_a, frames.in_b);
  }
}

}  // namespace

void FuzzScene::addJoint() {
  FuzzBody* a = anyBody();
  FuzzBody* b = anyBody();
  if (!a || a == b || !a->is_in_world || !b->is_in_world || joints_.size() >= 12) return;
  btRigidBody& other = chance(0.2) ? *floor_ : *b->body;
  if (a->body->getInvMass() == 0 && other.getInvMass() == 0) return;
  const btVector3 distance = a->body->getCenterOfMassPosition() - other.getCenterOfMassPosition();
  if (distance.length() > btScalar(1.5))
    return;  // long levers on light bodies gain speed in stock Bullet
  joints_.push_back(makeJoint(below(6), *a->body, other));
  if (chance(0.2)) joints_.back()->setBreakingImpulseThreshold(5);
  world_.addConstraint(joints_.back().get(), chance(0.7));
}

void FuzzScene::removeJoint() {
  if (joints_.empty()) return;
  world_.removeConstraint(joints_.back().get());
  joints_.pop_back();
}

void FuzzScene::removeJointsOf(const btRigidBody& body) {
  for (std::size_t i = joints_.size(); i-- > 0;) {
    btTypedConstraint& joint = *joints_[i];
    if (&joint.getRigidBodyA() != &body && &joint.getRigidBodyB() != &body) continue;
    world_.removeConstraint(&joint);
    joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

namespace {

class LineCounter : public btIDebugDraw {
 public:
  void drawLine(const btVector3& from, const btVector3& to, const btVector3&) override {
    if (!toVector3(from).allFinite() || !toVector3(to).allFinite()) {
      throw std::logic_error("a line that is not finite was drawn");
    }
  }
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                        const btVector3&) override {}
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return DBG_DrawNormals; }
};

}  // namespace

std::shared_ptr<const FluidBody> FuzzScene::findShape(const std::string& name) const {
  for (const auto& shape : fluid_bodies_) {
    if (shape->name == name) return shape;
  }
  return nullptr;
}

// Encodes the state without Bullet's pairs and contacts.
std::string FuzzScene::motion() const {
  WorldState state = fluid_.save();
  state.pairs.clear();
  state.contacts.clear();
  return encodeState(state);
}

std::vector<int> FuzzScene::overlappingPairs() const {
  std::vector<int> objects;
  for (const PairState& pair : fluid_.save().pairs)
    objects.insert(objects.end(), {pair.object_a, pair.object_b});
  return objects;
}

// Steps, restores, repeats the steps, and compares the bits.
void FuzzScene::saveAndRestore() {
  WorldState state = fluid_.save();
  if (chance(0.5)) {
    bool are_known = true;
    for (const BodyState& body : state.bodies) {
      are_known = are_known && (!body.ambient || findShape(body.ambient->def.fluid_body->name));
    }
    const auto lookup = [this](const std::string& name) { return findShape(name); };
    if (are_known) state = decodeState(encodeState(state), "fuzz", lookup);
  }
  const int count = 1 + below(8);
  // Bullet drops pairs late, by margins of older boxes: docs/bullet_step.md.
  const auto pairsOfSteps = [&] {
    std::vector<std::vector<int>> pairs;
    for (int i = 0; i < count; ++i) {
      step(1);
      pairs.push_back(overlappingPairs());
    }
    return pairs;
  };
  const std::vector<std::vector<int>> pairs = pairsOfSteps();
  const std::string expected = motion();
  fluid_.restore(state);
  if (pairsOfSteps() == pairs && is_repeatable_ && motion() != expected) {
    throw std::logic_error("a restored world went another way");
  }
}

void FuzzScene::damageBytes() {
  std::string bytes = encodeState(fluid_.save());
  for (int i = below(4); i >= 0; --i) {
    bytes[static_cast<std::size_t>(below(static_cast<int>(bytes.size())))] ^=
        static_cast<char>(1 << below(8));
  }
  if (chance(0.3)) {
    bytes.resize(static_cast<std::size_t>(below(static_cast<int>(bytes.size()))));
  }
  try {
    decodeState(bytes, "fuzz", [this](const std::string& name) { return findShape(name); });
  } catch (const std::runtime_error&) {
    return;
  }
  throw std::logic_error("damaged bytes were taken for a state");
}

void FuzzScene::draw() {
  LineCounter counter;
  world_.setDebugDrawer(&counter);
  fluid_.drawing = FluidDrawing::all();
  world_.debugDrawWorld();
  fluid_.drawing = {};
  world_.setDebugDrawer(nullptr);
}

}  // namespace ambient::test
