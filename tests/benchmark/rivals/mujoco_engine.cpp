// MuJoCo: fluidshape="ellipsoid" with its default coefficients, option density and viscosity;
// buoyancy by gravcomp. Default integrator and solver.

#include <mujoco/mujoco.h>

#include <sstream>
#include <stdexcept>

#include "tests/benchmark/rivals/engine.h"

namespace ambient::rivals {
namespace {

/// Numbers with blanks between, all digits.
template <class Numbers>
std::string text(const Numbers& numbers) {
  std::ostringstream out;
  out.precision(17);
  for (const double number : numbers) out << number << ' ';
  return out.str();
}

const char* typeOf(Form form) {
  switch (form) {
    case Form::kBox:
      return "box";
    case Form::kCapsule:
      return "capsule";
    case Form::kBall:
      return "sphere";
    case Form::kEllipsoid:
      return "ellipsoid";
  }
  return nullptr;
}

void writeWall(std::ostream& out, const Triple& normal, double distance) {
  Triple place{};
  for (int k = 0; k < 3; ++k) place[k] = -distance * normal[k];
  out << "<geom type='plane' size='0 0 1' pos='" << text(place) << "' zaxis='" << text(normal)
      << "'/>\n";
}

void writeBodies(std::ostream& out, const Scene& scene, bool has_fluid) {
  const double lift = has_fluid ? kWaterDensity / scene.solid.density : 0;
  for (const Motion& start : scene.starts)
    out << "<body pos='" << text(start.position) << "' quat='" << text(start.rotation)
        << "' gravcomp='" << lift << "'><freejoint/><geom type='" << typeOf(scene.solid.form)
        << "' size='" << text(scene.solid.size) << "' density='" << scene.solid.density
        << "'/></body>\n";
}

std::string modelOf(const Scene& scene, bool has_fluid) {
  std::ostringstream out;
  out.precision(17);
  out << "<mujoco><option timestep='" << scene.step << "' gravity='0 0 " << -scene.gravity
      << "' density='" << (has_fluid ? kWaterDensity : 0) << "' viscosity='"
      << (has_fluid && !scene.is_ideal ? kWaterViscosity : 0) << "'/>\n<size memory='1G'/>\n"
      << "<default><geom fluidshape='" << (has_fluid ? "ellipsoid" : "none") << "' friction='0.5'"
      << (scene.is_ideal ? " fluidcoef='0 0 0 0 0'" : "") << "/></default>\n<worldbody>\n";
  if (scene.room) {
    writeWall(out, {0, 0, 1}, 0);
    for (const double side : {-1.0, 1.0}) {
      writeWall(out, {side, 0, 0}, *scene.room);
      writeWall(out, {0, side, 0}, *scene.room);
    }
  }
  writeBodies(out, scene, has_fluid);
  out << "</worldbody></mujoco>\n";
  return out.str();
}

struct Free {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

std::unique_ptr<mjModel, Free> compile(const std::string& xml) {
  char error[500] = "";
  const std::unique_ptr<mjSpec, Free> spec(
      mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  if (!spec) throw std::runtime_error(std::string("MuJoCo: ") + error);
  std::unique_ptr<mjModel, Free> model(mj_compile(spec.get(), nullptr));
  if (!model) throw std::runtime_error(std::string("MuJoCo: ") + mjs_getError(spec.get()));
  return model;
}

class MujocoWorld : public World {
 public:
  MujocoWorld(const Scene& scene, bool has_fluid)
      : model_(compile(modelOf(scene, has_fluid))), data_(mj_makeData(model_.get())) {
    for (std::size_t i = 0; i < scene.starts.size(); ++i) {
      mjtNum* const rate = data_->qvel + 6 * i;
      mju_copy3(rate, scene.starts[i].velocity.data());
      mjtNum back[4];
      mju_negQuat(back, scene.starts[i].rotation.data());
      mju_rotVecQuat(rate + 3, scene.starts[i].spin.data(), back);
    }
  }

  void step() override { mj_step(model_.get(), data_.get()); }

  Motion motion(std::size_t body) const override {
    const mjtNum* const pose = data_->qpos + 7 * body;
    const mjtNum* const rate = data_->qvel + 6 * body;
    Motion motion;
    mju_copy3(motion.position.data(), pose);
    mju_copy4(motion.rotation.data(), pose + 3);
    mju_copy3(motion.velocity.data(), rate);
    mju_rotVecQuat(motion.spin.data(), rate + 3, pose + 3);
    return motion;
  }

 private:
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

std::unique_ptr<World> makeWorld(const Scene& scene, bool has_fluid) {
  if (has_fluid && scene.has_surface) return nullptr;
  return std::make_unique<MujocoWorld>(scene, has_fluid);
}

}  // namespace

Engine mujocoEngine() {
  return {"MuJoCo", mj_versionString(),
          "ellipsoid model, its default coefficients, buoyancy by gravcomp", makeWorld};
}

}  // namespace ambient::rivals
