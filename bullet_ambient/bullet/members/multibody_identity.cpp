#include "bullet_ambient/bullet/members/multibody_identity.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <atomic>

#include "bullet_ambient/base/ambient_assert.h"

AMBIENT_BEGIN
namespace {

// Two numbers, so that btScalar of single precision holds both exactly.
constexpr int kBits = 20;

// btMultiBodyDynamicsWorld finds the room in the same way.
btScalar* roomOf(const btMultiBody& body) noexcept {
  const int dofs = body.getNumDofs();
  return const_cast<btScalar*>(body.getVelocityVector()) + 6 + dofs + dofs * dofs;
}

bool isPart(btScalar part) noexcept { return part >= 0 && part < btScalar(1 << kBits); }

}  // namespace

int instanceNumber(const btMultiBody& body) noexcept {
  const btScalar low = roomOf(body)[0], high = roomOf(body)[1];
  if (!isPart(low) || !isPart(high)) return 0;  // of RK4
  return static_cast<int>(low) + (static_cast<int>(high) << kBits);
}

void setInstanceNumber(btMultiBody& body, int number) noexcept {
  AMBIENT_ASSERT(number > 0);
  roomOf(body)[0] = static_cast<btScalar>(number & ((1 << kBits) - 1));
  roomOf(body)[1] = static_cast<btScalar>(number >> kBits);
}

int giveInstanceNumber(btMultiBody& body) noexcept {
  static std::atomic<int> last{0};
  const int known = instanceNumber(body);
  if (known > 0) return known;
  const int number = ++last;
  setInstanceNumber(body, number);
  return number;
}

AMBIENT_END
