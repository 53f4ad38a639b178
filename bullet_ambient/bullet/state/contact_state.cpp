#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "bullet_ambient/bullet/state/bullet_state.h"

AMBIENT_BEGIN

namespace {

// Numbers of the objects of a world.
using ObjectNumbers = std::map<const void*, int>;

ObjectNumbers numbersOf(btCollisionWorld& world) {
  ObjectNumbers numbers;
  for (const btCollisionObject* object : objectsOf(world))
    numbers.emplace(object, static_cast<int>(numbers.size()));
  return numbers;
}

// Returns the numbers of two objects; both are -1 if one is not in this world.
PairState pairOf(const ObjectNumbers& numbers, const void* a, const void* b) {
  const auto found_a = numbers.find(a), found_b = numbers.find(b);
  if (found_a == numbers.end() || found_b == numbers.end()) return {-1, -1};
  return {found_a->second, found_b->second};
}
PairState pairOf(const ObjectNumbers& numbers, const btBroadphasePair& pair) {
  return pairOf(numbers, pair.m_pProxy0->m_clientObject, pair.m_pProxy1->m_clientObject);
}
PairState pairOf(const ObjectNumbers& numbers, const btPersistentManifold& manifold) {
  return pairOf(numbers, manifold.getBody0(), manifold.getBody1());
}

// A manifold, Bullet's place for the contact points of a pair or a part of one.
struct PairManifold {
  btPersistentManifold* manifold;
  PairState pair;
  int part;
};

// Places of the contacts of pairs, without predictive contacts, which last for one step.
std::vector<PairManifold> pairManifoldsOf(btCollisionWorld& world) {
  btManifoldArray manifolds;
  btOverlappingPairCache& cache = *world.getPairCache();
  for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
    btCollisionAlgorithm* algorithm = cache.getOverlappingPairArrayPtr()[i].m_algorithm;
    if (algorithm) algorithm->getAllContactManifolds(manifolds);
  }
  const ObjectNumbers numbers = numbersOf(world);
  std::map<std::pair<int, int>, int> parts;
  std::vector<PairManifold> pair_manifolds;
  for (int i = 0; i < manifolds.size(); ++i) {
    const PairState pair = pairOf(numbers, *manifolds[i]);
    if (pair.object_a < 0) continue;
    pair_manifolds.push_back({manifolds[i], pair, parts[{pair.object_a, pair.object_b}]++});
  }
  return pair_manifolds;
}

void fillManifold(btPersistentManifold& manifold, const std::vector<btManifoldPoint>& points) {
  manifold.setNumContacts(static_cast<int>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(static_cast<int>(i));
    point = points[i];
    point.m_userPersistentData = nullptr;  // belonged to the point that it was saved from
  }
}

// Swaps two manifolds in Bullet's array of them.
void swapManifolds(int to, int from, btPersistentManifold** array) {
  std::swap(array[to], array[from]);
  array[to]->m_index1a = to;
  array[from]->m_index1a = from;
}

using Objects = std::vector<btCollisionObject*>;

// Null if there is none of this number.
btCollisionObject* objectAt(const Objects& objects, int number) {
  const auto i = static_cast<std::size_t>(number);
  return i < objects.size() ? objects[i] : nullptr;
}

// btDbvtBroadphase finds a pair once, when its boxes with margins begin to overlap, and drops it
// some steps after they ceased to.
bool isDue(const btBroadphasePair& pair, const btCollisionWorld& world) {
  if (!dynamic_cast<const btDbvtBroadphase*>(world.getBroadphase())) return true;
  const auto& a = *static_cast<const btDbvtProxy*>(pair.m_pProxy0);
  const auto& b = *static_cast<const btDbvtProxy*>(pair.m_pProxy1);
  return Intersect(a.leaf->volume, b.leaf->volume);
}

btDbvtProxy* proxyOf(const btCollisionObject* object) {
  return static_cast<btDbvtProxy*>(const_cast<btBroadphaseProxy*>(object->getBroadphaseHandle()));
}

// Returns the broadphase if it has the boxes of a state; null: it finds pairs anew.
btDbvtBroadphase* broadphaseFor(const WorldState& state, btCollisionWorld& world) {
  const bool fits = state.boxes.size() == static_cast<std::size_t>(world.getNumCollisionObjects());
  return fits ? dynamic_cast<btDbvtBroadphase*>(world.getBroadphase()) : nullptr;
}

void restoreBoxes(const WorldState& state, const Objects& objects, btCollisionWorld& world) {
  btDbvtBroadphase* const broadphase = broadphaseFor(state, world);
  if (!broadphase) return;
  for (std::size_t i = 0; i < state.boxes.size(); ++i) {
    const BoxState& box = state.boxes[i];
    btDbvtProxy* const proxy = proxyOf(objects[i]);
    if (!proxy) continue;
    proxy->m_aabbMin = box.smallest;
    proxy->m_aabbMax = box.largest;
    btDbvtVolume volume = btDbvtVolume::FromMM(box.leaf_smallest, box.leaf_largest);
    const bool is_fixed = proxy->stage == btDbvtBroadphase::STAGECOUNT;
    broadphase->m_sets[is_fixed ? 1 : 0].update(proxy->leaf, volume);
  }
  broadphase->m_cid = state.next_pair;
  broadphase->m_newpairs = state.new_pairs;
  broadphase->m_needcleanup = state.looks_at_pairs;
}

// The saved ones in their order. Without saved boxes then those that the broadphase would not find
// again.
void restorePairs(const WorldState& state, const Objects& objects, btCollisionWorld& world) {
  const bool has_boxes = broadphaseFor(state, world) != nullptr;
  btOverlappingPairCache& cache = *world.getPairCache();
  std::vector<btBroadphasePair> found;
  for (int i = cache.getNumOverlappingPairs() - 1; i >= 0; --i) {
    const btBroadphasePair pair = cache.getOverlappingPairArrayPtr()[i];
    if (!has_boxes && isDue(pair, world)) found.push_back(pair);
    cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, world.getDispatcher());
  }
  for (const PairState& pair : state.pairs) {
    btCollisionObject *a = objectAt(objects, pair.object_a), *b = objectAt(objects, pair.object_b);
    if (a && b && a != b)
      cache.addOverlappingPair(a->getBroadphaseHandle(), b->getBroadphaseHandle());
  }
  for (const btBroadphasePair& pair : found) {
    cache.addOverlappingPair(pair.m_pProxy0, pair.m_pProxy1);
  }
}

// While it lives, a joint does not keep these two from colliding.
class CollisionsAllowed {
 public:
  CollisionsAllowed(btCollisionObject& a, btCollisionObject& b)
      : a_(a), b_(b), removed_from_a_(allow(a, b)), removed_from_b_(allow(b, a)) {}
  ~CollisionsAllowed() {
    for (int i = 0; i < removed_from_a_; ++i) a_.setIgnoreCollisionCheck(&b_, true);
    for (int i = 0; i < removed_from_b_; ++i) b_.setIgnoreCollisionCheck(&a_, true);
  }
  CollisionsAllowed(const CollisionsAllowed&) = delete;
  CollisionsAllowed& operator=(const CollisionsAllowed&) = delete;

 private:
  // Two joints enter an object twice.
  static int allow(btCollisionObject& object, const btCollisionObject& other) {
    const int before = object.getNumObjectsWithoutCollision();
    int now = before, last = before + 1;
    while (now < last && !object.checkCollideWith(&other)) {
      last = now;
      object.setIgnoreCollisionCheck(&other, false);
      now = object.getNumObjectsWithoutCollision();
    }
    return before - now;
  }

  btCollisionObject& a_;
  btCollisionObject& b_;
  int removed_from_a_, removed_from_b_;
};

// Makes places for contacts like Bullet's near callback, but also for pairs that do not collide at
// present: because they sleep, or were joined since, which leaves their last points in force.
// `move_b`: moves the second object for the search.
void makeManifolds(btBroadphasePair& pair, const btVector3& move_b, btCollisionWorld& world) {
  auto& a = *static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
  auto& b = *static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
  const CollisionsAllowed allowed(a, b);
  const btCollisionObjectWrapper of_a(nullptr, a.getCollisionShape(), &a, a.getWorldTransform(), -1,
                                      -1);
  btTransform pose_b = b.getWorldTransform();
  pose_b.getOrigin() += move_b;
  const btCollisionObjectWrapper of_b(nullptr, b.getCollisionShape(), &b, pose_b, -1, -1);
  if (!pair.m_algorithm) {
    pair.m_algorithm =
        world.getDispatcher()->findAlgorithm(&of_a, &of_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  }
  if (!pair.m_algorithm) return;
  btManifoldResult result(&of_a, &of_b);
  pair.m_algorithm->processCollision(&of_a, &of_b, world.getDispatchInfo(), &result);
}

// Some of Bullet's algorithms make no place for a pair of sleeping bodies.
void wakeAll(btCollisionWorld& world) {
  for (btRigidBody* body : rigidBodiesOf(world)) {
    if (!body->isStaticObject()) body->forceActivationState(ACTIVE_TAG);
  }
  for (btMultiBody* body : multiBodiesOf(world)) wakeColliders(*body);
}

// Moves the boxes of all objects to where they are. Bullet leaves out those of sleepers, where a
// world asks for it (setForceUpdateAllAabbs).
void updateBoxes(btCollisionWorld& world) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) world.updateSingleAabb(objects[i]);
}

std::pair<int, int> inOrder(const PairState& pair) {
  return {std::min(pair.object_a, pair.object_b), std::max(pair.object_a, pair.object_b)};
}

// Name of a place that is the same before and after: the pair, and the parts of compounds that
// touch, which Bullet writes in the points; without points, or parts, the number of the place.
using ManifoldKey = std::tuple<int, int, int, int, int>;
using ManifoldsByKey = std::map<ManifoldKey, btPersistentManifold*>;
using PartKeys = std::map<const btPersistentManifold*, ManifoldKey>;

bool hasParts(const btManifoldPoint& point) {
  return point.m_partId0 == -1 && point.m_partId1 == -1 &&
         (point.m_index0 >= 0 || point.m_index1 >= 0);
}

ManifoldKey keyOf(const PairState& pair, int part, const btManifoldPoint* point) {
  if (!point || !hasParts(*point)) return {pair.object_a, pair.object_b, -1, -1, part};
  return {pair.object_a, pair.object_b, point->m_index0, point->m_index1, 0};
}

ManifoldKey keyOf(const ContactState& contact) {
  return keyOf(contact.pair, contact.part,
               contact.points.empty() ? nullptr : &contact.points.front());
}

// Finds or makes the places of saved contacts.
class ManifoldMaker {
 public:
  explicit ManifoldMaker(btCollisionWorld& world)
      : world_(world), objects_(objectsOf(world)), numbers_(numbersOf(world)) {}

  ManifoldsByKey manifoldsFor(const std::vector<ContactState>& contacts) {
    std::map<std::pair<int, int>, std::vector<const ContactState*>> touching;
    for (const ContactState& contact : contacts)
      touching[inOrder(contact.pair)].push_back(&contact);
    btOverlappingPairCache& cache = *world_.getPairCache();
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
      btBroadphasePair& pair = cache.getOverlappingPairArrayPtr()[i];
      const auto saved = touching.find(inOrder(pairOf(numbers_, pair)));
      if (saved != touching.end()) makeFor(pair, saved->second);
    }
    ManifoldsByKey pair_manifolds;
    for (const PairManifold& of_pair : pairManifoldsOf(world_)) {
      const auto known = keys_.find(of_pair.manifold);
      pair_manifolds.emplace(
          known != keys_.end() ? known->second : keyOf(of_pair.pair, of_pair.part, nullptr),
          of_pair.manifold);
    }
    return pair_manifolds;
  }

 private:
  // Bullet keeps a contact of two parts of compounds across gaps at which it would not find it
  // anew, and along faces that slide: then the second object is moved until the points meet, and on
  // along the normal, which tells the parts, too. A move may cost others their place: two rounds.
  void makeFor(btBroadphasePair& pair, const std::vector<const ContactState*>& contacts) {
    PartKeys keys;
    makeManifolds(pair, btVector3(0, 0, 0), world_);
    noteParts(pair, keys);
    for (int round = 0; round < 2; ++round) {
      for (const ContactState* contact : contacts) {
        if (contact->points.empty() || isThere(pair, *contact, keys)) continue;
        const btManifoldPoint& point = contact->points.front();
        const btCollisionObject& first = *objectAt(objects_, contact->pair.object_a);
        const btVector3 gap =
            first.getWorldTransform() * point.m_localPointA -
            objectAt(objects_, contact->pair.object_b)->getWorldTransform() * point.m_localPointB;
        const btVector3 way = gap + gap.length() * point.m_normalWorldOnB;
        makeManifolds(pair, pair.m_pProxy0->m_clientObject == &first ? way : -way, world_);
        noteParts(pair, keys);
      }
    }
    keys_.insert(keys.begin(), keys.end());
  }

  static btManifoldArray manifoldsOf(const btBroadphasePair& pair) {
    btManifoldArray manifolds;
    if (pair.m_algorithm) pair.m_algorithm->getAllContactManifolds(manifolds);
    return manifolds;
  }

  // Forgets places that are gone: Bullet uses their memory again.
  void noteParts(const btBroadphasePair& pair, PartKeys& keys) const {
    PartKeys now;
    const btManifoldArray manifolds = manifoldsOf(pair);
    for (int i = 0; i < manifolds.size(); ++i) {
      btPersistentManifold& manifold = *manifolds[i];
      const auto known = keys.find(&manifold);
      if (manifold.getNumContacts() > 0 && hasParts(manifold.getContactPoint(0)))
        now[&manifold] = keyOf(pairOf(numbers_, manifold), 0, &manifold.getContactPoint(0));
      else if (known != keys.end())
        now.insert(*known);
    }
    keys = std::move(now);
  }

  static bool isThere(const btBroadphasePair& pair, const ContactState& contact,
                      const PartKeys& keys) {
    if (!hasParts(contact.points.front())) return manifoldsOf(pair).size() > contact.part;
    return std::any_of(keys.begin(), keys.end(),
                       [&](const auto& known) { return known.second == keyOf(contact); });
  }

  btCollisionWorld& world_;
  const Objects objects_;
  const ObjectNumbers numbers_;
  PartKeys keys_;
};

}  // namespace

std::vector<PairState> savePairs(btCollisionWorld& world) {
  const ObjectNumbers numbers = numbersOf(world);
  std::vector<PairState> pairs;
  btOverlappingPairCache& cache = *world.getPairCache();
  for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
    const btBroadphasePair& pair = cache.getOverlappingPairArrayPtr()[i];
    const PairState saved = pairOf(numbers, pair);
    if (saved.object_a >= 0) pairs.push_back(saved);
  }
  return pairs;
}

// In the order of Bullet's array of manifolds, which is that of the rows of a solver.
std::vector<ContactState> saveContacts(btCollisionWorld& world) {
  std::vector<PairManifold> pair_manifolds = pairManifoldsOf(world);
  std::sort(pair_manifolds.begin(), pair_manifolds.end(),
            [](const PairManifold& a, const PairManifold& b) {
              return a.manifold->m_index1a < b.manifold->m_index1a;
            });
  std::vector<ContactState> contacts;
  for (const PairManifold& of_pair : pair_manifolds) {
    ContactState contact{of_pair.pair, of_pair.part, {}};
    for (int p = 0; p < of_pair.manifold->getNumContacts(); ++p) {
      contact.points.push_back(of_pair.manifold->getContactPoint(p));
      contact.points.back().m_userPersistentData = nullptr;
    }
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

void saveBoxes(btCollisionWorld& world, WorldState& state) {
  const auto* const broadphase = dynamic_cast<const btDbvtBroadphase*>(world.getBroadphase());
  if (!broadphase) return;
  for (const btCollisionObject* object : objectsOf(world)) {
    BoxState& box = state.boxes.emplace_back();
    if (const btDbvtProxy* const proxy = proxyOf(object))
      box = {proxy->m_aabbMin, proxy->m_aabbMax, proxy->leaf->volume.Mins(),
             proxy->leaf->volume.Maxs()};
  }
  state.next_pair = broadphase->m_cid;
  state.new_pairs = broadphase->m_newpairs;
  state.looks_at_pairs = broadphase->m_needcleanup;
}

void restoreContacts(const WorldState& state, btCollisionWorld& world) {
  updateBoxes(world);
  world.computeOverlappingPairs();
  restorePairs(state, objectsOf(world), world);
  wakeAll(world);
  ManifoldsByKey pair_manifolds = ManifoldMaker(world).manifoldsFor(state.contacts);
  for (const auto& [name, manifold] : pair_manifolds) manifold->clearManifold();
  btPersistentManifold** array = world.getDispatcher()->getInternalManifoldPointer();
  int restored = 0;
  for (const ContactState& contact : state.contacts) {
    const auto found = pair_manifolds.find(keyOf(contact));
    if (found == pair_manifolds.end()) continue;
    fillManifold(*found->second, contact.points);
    swapManifolds(restored++, found->second->m_index1a, array);
    pair_manifolds.erase(found);
  }
  restoreBoxes(state, objectsOf(world), world);
}

AMBIENT_END
