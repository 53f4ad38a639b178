#include <BulletWorldImporter/btBulletWorldImporter.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "bullet_ambient/bullet/world/ambient_serializer.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"

namespace ambient::test {
namespace {

// Steps before and after loading; pairs of the loaded broadphase stay equal during kAfter.
constexpr int kBefore = 60, kAfter = 120;

std::string save(StateScene& scene) {
  AmbientSerializer serializer(scene.scene.fluid);
  scene.scene.world.serialize(&serializer);
  return {reinterpret_cast<const char*>(serializer.getBufferPointer()),
          static_cast<std::size_t>(serializer.getCurrentBufferSize())};
}

// A world with no input but the file and a lookup of fluid bodies.
struct LoadedWorld {
  FluidWorld scene;
  btBulletWorldImporter importer{&scene.world};

  LoadedWorld(std::string file, const FluidBodyLookup& lookup) {
    scene.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    const WorldState state = readAmbientChunk(file, "pile.bullet", lookup);
    if (!importer.loadFileFromMemory(file.data(), static_cast<int>(file.size()))) {
      throw std::runtime_error("Bullet does not load the file");
    }
    scene.fluid.restore(state);
  }
  ~LoadedWorld() { importer.deleteAllData(); }

  std::string motion() const {
    WorldState state = scene.fluid.save();
    state.pairs.clear();
    state.contacts.clear();
    return encodeState(state);
  }
};

TEST(BulletFile, BringsBackBodiesInTheirFluids) {
  StateScene scene;
  scene.step(kBefore);
  const LoadedWorld loaded(save(scene), scene.lookup());
  EXPECT_EQ(loaded.scene.fluid.size(), scene.scene.fluid.size());
  EXPECT_EQ(loaded.motion() == scene.motion(), true);
}

// Sizes, margins and joint frames survive a .bullet file exactly in this scene, so that contacts
// have equal bits, too.
TEST(BulletFile, ALoadedWorldGoesOnBitForBit) {
  StateScene scene;
  scene.step(kBefore);
  LoadedWorld loaded(save(scene), scene.lookup());
  for (int i = 0; i < kAfter; ++i) {
    scene.step(1);
    loaded.scene.step(kSceneStep, 1);
    ASSERT_EQ(loaded.motion() == scene.motion(), true) << "bits differ after step " << i + 1;
  }
}

TEST(BulletFile, StockLoadersPassTheChunkBy) {
  StateScene scene;
  std::string file = save(scene);
  btBulletWorldImporter importer(nullptr);
  ASSERT_TRUE(importer.loadFileFromMemory(file.data(), static_cast<int>(file.size())));
  EXPECT_EQ(importer.getNumRigidBodies(), scene.scene.world.getNumCollisionObjects());
  EXPECT_EQ(importer.getNumConstraints(), scene.scene.world.getNumConstraints());
  importer.deleteAllData();
}

std::string refusal(const std::string& file, const FluidBodyLookup& lookup) {
  try {
    readAmbientChunk(file, "pile.bullet", lookup);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST(BulletFile, SaysWhatIsWrongWithIt) {
  StateScene scene;
  const std::string file = save(scene);
  btDefaultSerializer stock;
  scene.scene.world.serialize(&stock);
  const std::string without(reinterpret_cast<const char*>(stock.getBufferPointer()),
                            static_cast<std::size_t>(stock.getCurrentBufferSize()));
  EXPECT_EQ(refusal(without, scene.lookup()),
            "pile.bullet: there is no saved state of ambient bodies in this file");
  EXPECT_EQ(refusal("solid cube", scene.lookup()),
            "pile.bullet: this is no .bullet file of this kind of machine");
  EXPECT_NE(refusal(file, {}).find("needs the fluid body 'box'"), std::string::npos);
  const std::size_t chunk = file.find("AMBSTATE");
  for (std::size_t size = chunk; size < chunk + 300; ++size) {
    ASSERT_NE(refusal(file.substr(0, size), scene.lookup()), "");
  }
}

}  // namespace
}  // namespace ambient::test
