#include "bullet_ambient/bullet/members/object_index.h"

#include <gtest/gtest.h>

#include <random>
#include <unordered_map>
#include <vector>

AMBIENT_BEGIN
namespace {

// Addresses of objects that are never read.
const btCollisionObject* addressOf(int i) {
  static std::vector<char> memory(1 << 20);
  return reinterpret_cast<const btCollisionObject*>(&memory[static_cast<std::size_t>(16 * i)]);
}

TEST(ObjectIndex, FindsNothingWhileEmpty) {
  ObjectIndex index;
  EXPECT_EQ(index.find(addressOf(1)), nullptr);
  index.erase(addressOf(1));
  index.clear();
  EXPECT_EQ(index.find(nullptr), nullptr);
}

// Inserts and erases at random; a map of the standard library knows what is to be found.
TEST(ObjectIndex, FindsWhatAMapFinds) {
  constexpr int kObjects = 500;
  std::mt19937 engine(1);
  std::vector<AmbientBody> bodies(kObjects);
  ObjectIndex index;
  std::unordered_map<const btCollisionObject*, AmbientBody*> known;
  for (int round = 0; round < 20000; ++round) {
    const int i = static_cast<int>(engine() % kObjects);
    const btCollisionObject* object = addressOf(i);
    // More insertions than erasures at first, then the other way round.
    const bool inserts = engine() % 100 < (round < 10000 ? 70u : 30u);
    if (inserts && known.count(object) == 0) {
      known[object] = &bodies[static_cast<std::size_t>(i)];
      index.insert({object, known[object], {}});
    } else if (!inserts) {
      known.erase(object);
      index.erase(object);
    }
    if (round % 100 > 0) continue;
    for (int k = 0; k < kObjects; ++k) {
      const auto found = known.find(addressOf(k));
      const ObjectIndex::Entry* entry = index.find(addressOf(k));
      ASSERT_EQ(entry != nullptr, found != known.end()) << round << ' ' << k;
      if (!entry) continue;
      ASSERT_EQ(entry->ambient, found->second);
    }
  }
  index.clear();
  for (int k = 0; k < kObjects; ++k) EXPECT_EQ(index.find(addressOf(k)), nullptr);
}

}  // namespace
AMBIENT_END
