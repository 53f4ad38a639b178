// Jolt: Body::ApplyBuoyancyImpulse() of each body before each step, with the drag factors that its
// documentation suggests. One thread, no sleeping, no damping besides.

// clang-format off
#include <Jolt/Jolt.h>  // before its others
// clang-format on

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayerInterfaceTable.h>
#include <Jolt/Physics/Collision/BroadPhase/ObjectVsBroadPhaseLayerFilterTable.h>
#include <Jolt/Physics/Collision/ObjectLayerPairFilterTable.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/PlaneShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#include <algorithm>

#include "tests/benchmark/rivals/engine.h"

namespace ambient::rivals {
namespace {

constexpr JPH::ObjectLayer kStill = 0, kMoving = 1;

JPH::Vec3 toJolt(const Triple& v) { return {float(v[0]), float(v[1]), float(v[2])}; }
Triple fromJolt(JPH::Vec3Arg v) { return {double(v.GetX()), double(v.GetY()), double(v.GetZ())}; }

/// Registers Jolt's types once in a program.
struct Library {
  Library() {
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory;
    JPH::RegisterTypes();
  }
  ~Library() {
    JPH::UnregisterTypes();
    delete JPH::Factory::sInstance;
    JPH::Factory::sInstance = nullptr;
  }
};

/// Two layers; still bodies do not meet each other.
struct Layers {
  Layers() {
    pairs.EnableCollision(kMoving, kMoving);
    pairs.EnableCollision(kMoving, kStill);
    broad.MapObjectToBroadPhaseLayer(kStill, JPH::BroadPhaseLayer(0));
    broad.MapObjectToBroadPhaseLayer(kMoving, JPH::BroadPhaseLayer(1));
  }
  JPH::ObjectLayerPairFilterTable pairs{2};
  JPH::BroadPhaseLayerInterfaceTable broad{2, 2};
  JPH::ObjectVsBroadPhaseLayerFilterTable filter{broad, 2, pairs, 2};
};

// An ellipsoid touches nothing here: a ball around it serves.
JPH::Ref<JPH::Shape> shapeOf(const Solid& solid) {
  const float a = float(solid.size[0]), b = float(solid.size[1]);
  switch (solid.form) {
    case Form::kBox:
      return new JPH::BoxShape(toJolt(solid.size));
    case Form::kCapsule:
      return new JPH::CapsuleShape(b, a);
    case Form::kBall:
      return new JPH::SphereShape(a);
    case Form::kEllipsoid:
      return new JPH::SphereShape(float(*std::max_element(solid.size.begin(), solid.size.end())));
  }
  return nullptr;
}

class JoltWorld : public World {
 public:
  JoltWorld(const Scene& scene, bool has_fluid) : scene_(scene), has_fluid_(has_fluid) {
    system_.Init(4096, 0, 65536, 32768, layers_.broad, layers_.filter, layers_.pairs);
    system_.SetGravity(gravity_);
    const JPH::Ref<JPH::Shape> shape = shapeOf(scene.solid);
    for (const Motion& start : scene.starts) bodies_.push_back(add(settingsOf(*shape, start)));
    if (scene.room) addWalls(float(*scene.room));
    system_.OptimizeBroadPhase();
  }

  void step() override {
    const auto duration = float(scene_.step);
    if (has_fluid_)
      for (JPH::Body* body : bodies_)
        body->ApplyBuoyancyImpulse(surface_, JPH::Vec3::sAxisZ(), buoyancy_, linear_drag_,
                                   angular_drag_, JPH::Vec3::sZero(), gravity_, duration);
    system_.Update(duration, 1, &memory_, &jobs_);
  }

  Motion motion(std::size_t i) const override {
    const JPH::Body& body = *bodies_[i];
    const JPH::Quat q = body.GetRotation();
    return {fromJolt(JPH::Vec3(body.GetCenterOfMassPosition())),
            {double(q.GetW()), double(q.GetX()), double(q.GetY()), double(q.GetZ())},
            fromJolt(body.GetLinearVelocity()),
            fromJolt(body.GetAngularVelocity())};
  }

 private:
  JPH::Body* add(const JPH::BodyCreationSettings& settings) {
    JPH::BodyInterface& bodies = system_.GetBodyInterfaceNoLock();
    JPH::Body* const body = bodies.CreateBody(settings);
    bodies.AddBody(body->GetID(), JPH::EActivation::Activate);
    return body;
  }

  JPH::BodyCreationSettings settingsOf(const JPH::Shape& shape, const Motion& start) const {
    const auto& [w, x, y, z] = start.rotation;
    JPH::BodyCreationSettings settings(
        &shape, JPH::RVec3(toJolt(start.position)),
        JPH::Quat(float(x), float(y), float(z), float(w)).Normalized(), JPH::EMotionType::Dynamic,
        kMoving);
    settings.mLinearVelocity = toJolt(start.velocity);
    settings.mAngularVelocity = toJolt(start.spin);
    settings.mLinearDamping = settings.mAngularDamping = 0;
    settings.mAllowSleeping = false;
    settings.mFriction = 0.5f;
    settings.mApplyGyroscopicForce = scene_.is_ideal;
    settings.mOverrideMassProperties = JPH::EOverrideMassProperties::CalculateInertia;
    settings.mMassPropertiesOverride.mMass = float(scene_.solid.density * volumeOf(scene_.solid));
    if (scene_.solid.form == Form::kEllipsoid) {
      settings.mOverrideMassProperties = JPH::EOverrideMassProperties::MassAndInertiaProvided;
      settings.mMassPropertiesOverride.mInertia =
          JPH::Mat44::sScale(toJolt(ellipsoidMoments(scene_.solid)));
    }
    return settings;
  }

  void addWalls(float distance) {
    const JPH::Vec3 x = JPH::Vec3::sAxisX(), y = JPH::Vec3::sAxisY();
    addWall({JPH::Vec3::sAxisZ(), 0});
    for (const JPH::Vec3& normal : {x, -x, y, -y}) addWall({normal, distance});
  }

  void addWall(const JPH::Plane& plane) {
    JPH::BodyCreationSettings settings(new JPH::PlaneShape(plane), JPH::RVec3::sZero(),
                                       JPH::Quat::sIdentity(), JPH::EMotionType::Static, kStill);
    settings.mFriction = 0.5f;
    add(settings);
  }

  const Scene scene_;
  const bool has_fluid_;
  const JPH::Vec3 gravity_{0, 0, float(-scene_.gravity)};
  const JPH::RVec3 surface_{0, 0, scene_.has_surface ? 0.0f : 1000.0f};
  const float buoyancy_ = float(kWaterDensity / scene_.solid.density);
  const float linear_drag_ = scene_.is_ideal ? 0 : 0.5f,
              angular_drag_ = scene_.is_ideal ? 0 : 0.01f;
  Layers layers_;
  JPH::TempAllocatorImpl memory_{64 << 20};
  JPH::JobSystemSingleThreaded jobs_{JPH::cMaxPhysicsJobs};
  JPH::PhysicsSystem system_;
  std::vector<JPH::Body*> bodies_;
};

std::unique_ptr<World> makeWorld(const Scene& scene, bool has_fluid) {
  static const Library library;
  return std::make_unique<JoltWorld>(scene, has_fluid);
}

}  // namespace

Engine joltEngine() {
  return {"Jolt",
          std::to_string(JPH_VERSION_MAJOR) + "." + std::to_string(JPH_VERSION_MINOR) + "." +
              std::to_string(JPH_VERSION_PATCH),
          "buoyancy impulse, drag factors 0.5 and 0.01 as documented", makeWorld};
}

}  // namespace ambient::rivals
