#include "tests/bullet_ambient/bullet/pile/pile_scene.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

btVector3 cubeVector(double x) { return {btScalar(x), btScalar(x), btScalar(x)}; }

}  // namespace

FluidBody pileFluidBody(PileFluid fluid) {
  const double density = 1;
  const double largest = fluid.added_mass * Pile::kMass / density;
  const double size = Pile::kHalfEdge;
  Vector6 diagonal;
  diagonal << 0.1 * largest * size * size * Vector3(1, 0.6, 0.8), largest * Vector3(1, 0.5, 0.7);
  // A fluid frame off the centre of mass couples the blocks of K.
  FluidBody shape;
  shape.name = "box of the pile";
  shape.added_mass = shiftOrigin(diagonal.asDiagonal(), {0.3 * size, -0.2 * size, 0.1 * size});
  shape.volume = std::max(fluid.buoyancy, 1e-9) * Pile::kMass / density;
  shape.area = 6 * 4 * size * size;
  return shape;
}

Pile::Pile(const PileDef& pile) : box_shape_(cubeVector(kHalfEdge)) {
  host_.world.setGravity({0, 0, btScalar(-9.81)});
  addWalls(pile.edge);
  addBoxes(pile);
}

Pile::Pile(double ambient_part, PileFluid fluid, const PileDef& pile) : Pile(pile) {
  fluid_def_ = fluid;
  fluid_.emplace(host_.world);
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(pileFluidBody(fluid));
  def.medium.density = 1;
  def.medium.viscosity = 0;
  for (std::size_t i = 0; i < boxes().size(); ++i) {
    const bool is_ambient = std::floor(ambient_part * static_cast<double>(i + 1)) >
                            std::floor(ambient_part * static_cast<double>(i));
    if (is_ambient) fluid_->add(*boxes()[i], def);
  }
}

btRigidBody& Pile::add(WorldContents& group, double mass, btCollisionShape& shape,
                       const btTransform& start) {
  btRigidBody& body = group.add(mass, shape, start);
  body.setRestitution(0);
  body.setFriction(btScalar(0.5));
  return body;
}

void Pile::addWalls(int edge) {
  const auto room = static_cast<btScalar>((1.5 * edge + 2) * kHalfEdge);
  for (const btVector3& normal : {btVector3(0, 0, 1), btVector3(1, 0, 0), btVector3(-1, 0, 0),
                                  btVector3(0, 1, 0), btVector3(0, -1, 0)}) {
    const btScalar distance = normal.z() > 0 ? btScalar(0) : -room;
    wall_shapes_.push_back(std::make_unique<btStaticPlaneShape>(normal, distance));
    add(host_.contents, 0, *wall_shapes_.back(), btTransform::getIdentity());
  }
}

void Pile::addBoxes(const PileDef& def) {
  Arbitrary arbitrary(def.seed);
  const double pitch = 2 * kHalfEdge + def.gap;
  for (int k = 0; k < def.edge; ++k) {
    for (int j = 0; j < def.edge; ++j) {
      for (int i = 0; i < def.edge; ++i) {
        const double middle = (def.edge - 1) / 2.0;
        const Vector3 turn = arbitrary.vector(def.tilt / 2);
        const btVector3 origin(btScalar((i - middle) * pitch), btScalar((j - middle) * pitch),
                               btScalar(def.height + (k + 0.5) * pitch));
        const btQuaternion rotation(btScalar(turn.x()), btScalar(turn.y()), btScalar(turn.z()), 1);
        add(boxes_, kMass, box_shape_, btTransform(rotation.normalized(), origin));
      }
    }
  }
}

void Pile::keepAwake() {
  for (const auto& box : boxes()) box->setActivationState(DISABLE_DEACTIVATION);
}

bool Pile::isAsleep() const {
  for (const auto& box : boxes())
    if (box->isActive()) return false;
  return true;
}

double Pile::energy() const {
  double sum = 0;
  for (const auto& box : boxes()) {
    const RigidState state = readState(*box);
    const bool is_ambient = fluid_ && fluid_->find(*box);
    const double weight = 9.81 * kMass * (is_ambient ? 1 - fluid_def_.buoyancy : 1);
    sum += weight * state.position.z();
    Matrix6 inertia = Matrix6::Zero();
    if (is_ambient) {
      inertia = fluid_->find(*box)->inertia();
    } else {
      inertia.diagonal() << toVector3(box->getInvInertiaDiagLocal()).cwiseInverse(),
          Vector3::Constant(kMass);
    }
    const Vector6 x = state.twist.vector();
    sum += x.dot(inertia * x) / 2;
  }
  return sum;
}

}  // namespace ambient::test
