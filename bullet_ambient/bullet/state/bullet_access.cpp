#include "bullet_ambient/bullet/state/bullet_access.h"

AMBIENT_BEGIN
namespace {

MultiBodySleep readSleep(btMultiBody& body) noexcept;

// An explicit instantiation lends access to private members, as C++ allows.
template <btScalar btMultiBody::*kTimer, btScalar btMultiBody::*kThreshold,
          btScalar btMultiBody::*kTimeout>
struct SleepReader {
  friend MultiBodySleep readSleep(btMultiBody& body) noexcept {
    return {body.*kTimer, body.*kThreshold, body.*kTimeout};
  }
};
template struct SleepReader<&btMultiBody::m_sleepTimer, &btMultiBody::m_sleepEpsilon,
                            &btMultiBody::m_sleepTimeout>;

}  // namespace

MultiBodySleep sleepOf(btMultiBody& body) noexcept { return readSleep(body); }

AMBIENT_END
