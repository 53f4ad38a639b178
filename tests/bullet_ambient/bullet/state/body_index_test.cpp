#include <gtest/gtest.h>

#include <cstdint>
#include <iterator>
#include <list>
#include <map>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Addresses at the distance of Bullet's bodies, none of which is read.
const btCollisionObject* addressOf(int number) {
  return reinterpret_cast<const btCollisionObject*>(std::uintptr_t{704} * number + 4096);
}

TEST(BodyIndex, FindsWhatWasInsertedAndNotErased) {
  constexpr int kAddresses = 300;
  Arbitrary arbitrary(1);
  std::list<AmbientBody> bodies;
  std::map<int, BodyIndex::Place> known;
  BodyIndex index;
  EXPECT_FALSE(index.find(addressOf(0)));
  for (int i = 0; i < 5000; ++i) {
    const int number = static_cast<int>(arbitrary.between(0, kAddresses));
    const auto found = known.find(number);
    if (found == known.end()) {
      bodies.emplace_back();
      index.insert(addressOf(number), std::prev(bodies.end()));
      known[number] = std::prev(bodies.end());
    } else {
      index.erase(addressOf(number));
      bodies.erase(found->second);
      known.erase(found);
    }
    if (i % 50 != 0) continue;
    for (int other = 0; other < kAddresses; ++other) {
      const auto place = index.find(addressOf(other));
      const auto expected = known.find(other);
      ASSERT_EQ(place.has_value(), expected != known.end()) << i << ' ' << other;
      if (place) {
        ASSERT_EQ(*place, expected->second) << i << ' ' << other;
      }
    }
  }
  EXPECT_GT(known.size(), 100U);
  index.clear();
  EXPECT_FALSE(index.find(addressOf(1)));
}

}  // namespace
}  // namespace ambient::test
