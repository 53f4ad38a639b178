#include "tests/bullet_ambient/bullet/robots/link_contacts.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace ambient::test {
namespace {

void addPoint(const btMultiBody& body, const btManifoldPoint& point, bool is_first, int link,
              const DenseVector6& before, const ContactLaw& law, DenseRobot& robot) {
  if (point.getDistance() > 0) return;  // gap too wide for so short a step
  const btVector3 place = is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
  const btScalar sign = bt(is_first ? 1 : -1);
  reference::DenseRow row = groundRow(body, link, place, sign * point.m_normalWorldOnB);
  row.lower = 0;
  row.target = std::max<Real>(0, -law.restitution * row.jacobian_a.dot(before));
  const int normal_row = static_cast<int>(robot.rows.size());
  robot.rows.push_back(row);
  const btVector3 directions[] = {point.m_lateralFrictionDir1, point.m_lateralFrictionDir2};
  for (int i = 0; i < law.friction_directions; ++i) {
    reference::DenseRow friction = groundRow(body, link, place, sign * directions[i]);
    friction.normal_row = normal_row;
    friction.friction = law.friction;
    robot.rows.push_back(friction);
  }
}

}  // namespace

btCollisionObject& addFloor(RobotWorld& world, const btMultiBody& body, int link,
                            const btVector3& normal, double restitution) {
  const btVector3 centre =
      link < 0 ? body.getBasePos() : body.getLink(link).m_cachedWorldTransform.getOrigin();
  const btScalar half = bt(0.04), overlap = bt(1e-6);
  const btTransform place(shortestArcQuat(btVector3(0, 0, 1), normal),
                          centre - normal * (bt(kSphereRadius) + half - overlap));
  auto box = std::make_unique<btBoxShape>(btVector3(half, half, half));
  box->setMargin(bt(1e-4));
  btCollisionObject& floor = world.addFixed(std::move(box), place);
  floor.setRestitution(bt(restitution));
  return floor;
}

void addContacts(RobotWorld& world, const btMultiBody& body,
                 const std::vector<DenseVector6>& before, const ContactLaw& law,
                 DenseRobot& robot) {
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(i);
    const auto* a = btMultiBodyLinkCollider::upcast(manifold.getBody0());
    const auto* b = btMultiBodyLinkCollider::upcast(manifold.getBody1());
    const int link = (a ? a : b)->m_link;
    for (int k = 0; k < manifold.getNumContacts(); ++k)
      addPoint(body, manifold.getContactPoint(k), a != nullptr, link, before[link + 1], law, robot);
  }
}

}  // namespace ambient::test
