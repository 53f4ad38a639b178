#include <LinearMath/btIDebugDraw.h>

#include <stdexcept>

#include "bullet_ambient/bullet/core/conversions.h"
#include "tests/fuzz/fuzz_scene.h"

namespace ambient::test {
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
  step(count);
  const std::string expected = motion();
  const std::vector<int> pairs = overlappingPairs();
  fluid_.restore(state);
  step(count);
  // Bullet drops pairs late, by margins of older boxes: docs/bullet_step.md.
  if (is_repeatable_ && motion() != expected && overlappingPairs() == pairs) {
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
