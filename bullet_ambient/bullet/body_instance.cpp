#include "bullet_ambient/bullet/body_instance.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
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

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
