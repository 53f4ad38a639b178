#include "bullet_ambient/bullet/contact_state.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <map>
#include <utility>

#include "bullet_ambient/bullet/world_objects.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// Bullet's array of manifolds, whose order is that of the rows of a solver.
class Manifolds {
 public:
  explicit Manifolds(btDispatcher& dispatcher)
      : first_(dispatcher.getInternalManifoldPointer()), size_(dispatcher.getNumManifolds()) {}

  int size() const { return size_; }
  btPersistentManifold& operator[](int i) const { return *first_[i]; }
  void swap(int i, int j) const {
    std::swap(first_[i], first_[j]);
    first_[i]->m_index1a = i;
    first_[j]->m_index1a = j;
  }
  /// The first from `begin` between these two objects; size() if there is none.
  int find(int begin, const btCollisionObject* a, const btCollisionObject* b) const {
    int i = begin;
    while (i < size_ && (first_[i]->getBody0() != a || first_[i]->getBody1() != b)) ++i;
    return i;
  }

 private:
  btPersistentManifold** first_;
  int size_;
};

void fill(btPersistentManifold& manifold, const std::vector<btManifoldPoint>& points) {
  manifold.setNumContacts(static_cast<int>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(static_cast<int>(i));
    point = points[i];
    point.m_userPersistentData = nullptr;  // belonged to the point that it was saved from
  }
}

// Bullet makes no place for a pair of sleeping bodies.
void wakeAll(btCollisionWorld& world) {
  for (btRigidBody* body : rigidBodiesOf(world)) {
    if (!body->isStaticObject()) body->forceActivationState(ACTIVE_TAG);
  }
}

class ObjectNumbers {
 public:
  explicit ObjectNumbers(btCollisionWorld& world) {
    for (const btCollisionObject* object : objectsOf(world)) {
      numbers_.emplace(object, static_cast<int>(numbers_.size()));
    }
  }
  /// Both are -1 if one is not in this world.
  PairState pair(const void* a, const void* b) const {
    const auto found_a = numbers_.find(a), found_b = numbers_.find(b);
    if (found_a == numbers_.end() || found_b == numbers_.end()) return {-1, -1};
    return {found_a->second, found_b->second};
  }

 private:
  std::map<const void*, int> numbers_;
};

class Objects {
 public:
  explicit Objects(btCollisionWorld& world) : objects_(objectsOf(world)) {}

  /// Null if there is none of this number.
  btCollisionObject* operator[](int number) const {
    const auto i = static_cast<std::size_t>(number);
    return i < objects_.size() ? objects_[i] : nullptr;
  }

 private:
  std::vector<btCollisionObject*> objects_;
};

void restorePairs(const std::vector<PairState>& pairs, const Objects& objects,
                  btCollisionWorld& world) {
  btOverlappingPairCache& cache = *world.getPairCache();
  for (int i = cache.getNumOverlappingPairs() - 1; i >= 0; --i) {
    const btBroadphasePair pair = cache.getOverlappingPairArrayPtr()[i];
    cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, world.getDispatcher());
  }
  for (const PairState& pair : pairs) {
    btCollisionObject* a = objects[pair.object_a];
    btCollisionObject* b = objects[pair.object_b];
    if (a && b && a != b) {
      cache.addOverlappingPair(a->getBroadphaseHandle(), b->getBroadphaseHandle());
    }
  }
}

}  // namespace

std::vector<PairState> savePairs(btCollisionWorld& world) {
  const ObjectNumbers numbers(world);
  std::vector<PairState> pairs;
  btOverlappingPairCache& cache = *world.getPairCache();
  for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
    const btBroadphasePair& pair = cache.getOverlappingPairArrayPtr()[i];
    const PairState saved =
        numbers.pair(pair.m_pProxy0->m_clientObject, pair.m_pProxy1->m_clientObject);
    if (saved.object_a >= 0) pairs.push_back(saved);
  }
  return pairs;
}

std::vector<ContactState> saveContacts(btCollisionWorld& world) {
  const ObjectNumbers numbers(world);
  std::vector<ContactState> contacts;
  const Manifolds manifolds(*world.getDispatcher());
  for (int i = 0; i < manifolds.size(); ++i) {
    const btPersistentManifold& manifold = manifolds[i];
    ContactState contact{numbers.pair(manifold.getBody0(), manifold.getBody1()), {}};
    if (contact.pair.object_a < 0) continue;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      contact.points.push_back(manifold.getContactPoint(p));
      contact.points.back().m_userPersistentData = nullptr;
    }
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

void restoreContacts(const std::vector<PairState>& pairs, const std::vector<ContactState>& contacts,
                     btCollisionWorld& world) {
  const Objects objects(world);
  wakeAll(world);
  world.updateAabbs();
  world.computeOverlappingPairs();
  restorePairs(pairs, objects, world);
  btDispatcher& dispatcher = *world.getDispatcher();
  dispatcher.dispatchAllCollisionPairs(world.getPairCache(), world.getDispatchInfo(), &dispatcher);

  const Manifolds manifolds(dispatcher);
  for (int i = 0; i < manifolds.size(); ++i) manifolds[i].clearManifold();
  int restored = 0;
  for (const ContactState& contact : contacts) {
    const btCollisionObject* a = objects[contact.pair.object_a];
    const btCollisionObject* b = objects[contact.pair.object_b];
    if (!a || !b) continue;
    const int found = manifolds.find(restored, a, b);
    if (found == manifolds.size()) continue;
    fill(manifolds[found], contact.points);
    manifolds.swap(restored++, found);
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
