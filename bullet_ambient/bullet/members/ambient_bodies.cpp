#include "bullet_ambient/bullet/members/ambient_bodies.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/immersed/fluid_regions.h"

AMBIENT_BEGIN

void BodyIndex::reserveOne() {
  if (3 * (count_ + 1) > 2 * entries_.size()) grow();
}

void BodyIndex::insert(const btCollisionObject* object, Place place) {
  reserveOne();
  Entry& entry = entries_[placeOf(object)];
  AMBIENT_ASSERT(!entry.object);
  entry = {object, place};
  ++count_;
}

void BodyIndex::erase(const btCollisionObject* object) noexcept {
  std::size_t gap = placeOf(object);
  AMBIENT_ASSERT(entries_[gap].object == object);
  // Moves later entries into the gap, so that no search ends there too early.
  const std::size_t mask = entries_.size() - 1;
  for (std::size_t at = next(gap); entries_[at].object; at = next(at)) {
    const std::size_t way = (at - homeOf(entries_[at].object)) & mask;
    if (way < ((at - gap) & mask)) continue;
    entries_[gap] = entries_[at];
    gap = at;
  }
  entries_[gap] = {};
  --count_;
}

void BodyIndex::clear() noexcept {
  entries_.clear();
  count_ = 0;
}

void BodyIndex::grow() {
  std::vector<Entry> known(entries_.empty() ? 8 : 2 * entries_.size());
  known.swap(entries_);
  for (const Entry& entry : known)
    if (entry.object) entries_[placeOf(entry.object)] = entry;
}

namespace {

int readNumber(const btRigidBody& body) noexcept;

// Bullet has no accessor for the number. The arguments of an explicit instantiation are not subject
// to access control ([temp.spec.general]), which lends one without a change of Bullet.
template <int btRigidBody::*kNumber>
struct NumberReader {
  friend int readNumber(const btRigidBody& body) noexcept { return body.*kNumber; }
};
template struct NumberReader<&btRigidBody::m_debugBodyId>;

}  // namespace

int instanceNumber(const btRigidBody& body) noexcept { return readNumber(body); }

AmbientBody* AmbientBodies::find(const btCollisionObject* body) const {
  const auto found = by_object_.find(body);
  if (!found) return nullptr;
  AmbientBody& ambient = **found;
  return isSame(ambient) ? &ambient : nullptr;
}

bool AmbientBodies::isSame(const AmbientBody& ambient) {
  const btCollisionObject* object = ambient.body;
  const btRigidBody* rigid = btRigidBody::upcast(object);
  return rigid && instanceNumber(*rigid) == ambient.instance;
}

AmbientBody& AmbientBodies::insert(AmbientBody ambient) {
  std::list<AmbientBody> last;
  AmbientBody& added = last.emplace_back(std::move(ambient));
  added.instance = instanceNumber(*added.body);
  by_object_.reserveOne();
  if (AmbientBody* same = find(added.body)) {
    keepName(same->def->name, added);  // no state has it
    added.reading = same->reading;
    slots.replace(*same, {&added, nullptr});
  } else {
    slots.enter({&added, nullptr});
  }
  has_vessels = has_vessels || added.vessel;
  erase(*added.body);  // or what is left of one that was destroyed at this address
  by_object_.insert(added.body, last.begin());
  bodies_.splice(bodies_.end(), last);
  return added;
}

bool AmbientBodies::erase(const btRigidBody& body) {
  const auto found = by_object_.find(&body);
  if (!found) return false;
  forgetSolved(**found);
  slots.leave(**found);
  by_object_.erase(&body);
  bodies_.erase(*found);
  return true;
}

void AmbientBodies::clear() {
  solved_list_ = nullptr;
  for (AmbientBody& ambient : bodies_) slots.leave(ambient);
  by_object_.clear();
  bodies_.clear();
  trees.clear();
}

void AmbientBodies::close() {
  clear();
  regions = {};
  complaints.setReport(nullptr);
  task_runner = nullptr;
  naming = nullptr;
  is_closed = true;
}

void AmbientBodies::requireChangeable(const char* function) {
  RegionCall* call = RegionCall::current(regions);
  if (!call) return;
  call->was_refused = true;
  const std::string sentence =
      std::string("bullet_ambient: the flow or the surface of a region of fluid has called ") +
      function +
      ", which changes what is asked for its fluid; nothing has changed: call it between "
      "steps";
  complaints.say(Complaint::kChange, sentence.c_str());
  throw std::logic_error(sentence);
}

void AmbientBodies::noteSolved(AmbientBody& ambient) noexcept {
  if (std::exchange(ambient.outcome.kind, Outcome::kStock) != Outcome::kNotSolved) return;
  ambient.next_solved = solved_list_.load(std::memory_order_relaxed);
  while (!solved_list_.compare_exchange_weak(ambient.next_solved, &ambient)) {
  }
}

// Between steps the list is empty, unless there is no action to take it.
void AmbientBodies::forgetSolved(const AmbientBody& ambient) noexcept {
  AmbientBody* other = solved_list_.load();
  if (other == &ambient) solved_list_ = ambient.next_solved;
  for (; other; other = other->next_solved) {
    if (other->next_solved == &ambient) other->next_solved = ambient.next_solved;
  }
}

AMBIENT_END
