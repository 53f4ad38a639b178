#include "demos/simulation/robots/robots_in_world.h"

#include <vector>

#include "demos/simulation/robots/scene_robot.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/robot/link_shape.h"

namespace ambient {
namespace {

class SceneRobots : public RobotsInWorld {
 public:
  std::size_t count() const override { return robots_.size(); }
  SceneRobot& robot(std::size_t index) const override { return *robots_.at(index); }

  void add(const RobotDef& def, btMultiBodyDynamicsWorld& world) override {
    robots_.push_back(std::make_unique<SceneRobot>(def));
    robots_.back()->robot().addTo(world);
  }

  void removeFrom(std::size_t first) override {
    while (robots_.size() > first) robots_.pop_back();
  }

  void prepareStep(std::size_t first, double time, double time_step) override {
    for (std::size_t i = first; i < robots_.size(); ++i) robots_[i]->prepareStep(time, time_step);
  }

  btMultiBody& multiBody(const SceneLink& link) const override {
    return robots_[link.robot]->robot().multiBody();
  }

  Matrix3 bodyToLink(const SceneLink& link) const override {
    const int number = static_cast<int>(link.link) - 1;
    return robots_[link.robot]->robot().linkInBody(number).linear().transpose();
  }

  MotionSample sample(const SceneLink& link) const override {
    return robots_[link.robot]->sample(link.link);
  }

 private:
  std::vector<std::unique_ptr<SceneRobot>> robots_;
};

std::shared_ptr<const FluidBody> fluidBodyOf(const LinkModel& link, const std::string& name,
                                             SceneBodyCache& fluid_bodies) {
  if (link.fluid && !link.fluid->fluid_body.empty())
    return std::make_shared<const FluidBody>(readPrepared(link.fluid->fluid_body.string()));
  const LinkShape shape = makeLinkShape(link, RigidPose::Identity());
  fluid_bodies.warn(shape.warnings);
  return fluid_bodies.get(*shape.in_link, name);
}

}  // namespace

std::unique_ptr<RobotsInWorld> makeRobotsInWorld() { return std::make_unique<SceneRobots>(); }

PreparedBody prepareLink(const Scene& scene, const BodyDef& def, SceneBodyCache& fluid_bodies) {
  const LinkModel& link = scene.robots[def.link->robot].model->links[def.link->link];
  PreparedBody body;
  body.fluid_body = fluidBodyOf(link, def.name, fluid_bodies);
  body.surface = body.fluid_body->surface;
  body.mass = def.mass;
  body.centre_of_mass = link.centre_of_mass;
  body.inertia = link.inertia;
  const bool has_fluid = !link.fluid || link.fluid->medium != "none";
  const bool is_ground = scene.robots[def.link->robot].fixed_base && link.parent < 0;
  if (!has_fluid || is_ground) body.fluid_body = nullptr;
  return body;
}

}  // namespace ambient
