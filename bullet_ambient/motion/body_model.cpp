#include "bullet_ambient/motion/body_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "bullet_ambient/force/level_loads.h"
#include "bullet_ambient/force/passivity_guard.h"
#include "bullet_ambient/force/single_loads.h"

namespace ambient {
namespace {

[[noreturn]] void reject(const FluidBody& body, const std::string& what, double value,
                         const char* limit) {
  std::ostringstream message;
  message << "fluid body '" << body.name << "': " << what << " is " << value << ", must be "
          << limit;
  throw std::invalid_argument(message.str());
}

Eigen::Vector3d eigenvalues(const Eigen::Matrix3d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

void checkMass(const FluidBody& body, const MassProperties& mass) {
  if (!(mass.mass > 0) || !std::isfinite(mass.mass)) {
    reject(body, "mass [kg]", mass.mass, "positive and finite");
  }
  for (const double entry : mass.inertia.reshaped()) {
    if (!std::isfinite(entry)) {
      reject(body, "moment of inertia [kg m^2]", entry,
             "finite (for a body that must not turn, use its angular factor)");
    }
  }
  const double smallest = eigenvalues(mass.inertia)[0];
  if (!(smallest > 0)) {
    reject(body, "smallest principal moment of inertia [kg m^2]", smallest, "positive");
  }
}

void checkShape(const FluidBody& body) {
  if (!(body.volume >= 0) || !std::isfinite(body.volume)) {
    reject(body, "volume [m^3]", body.volume, "zero or positive and finite");
  }
  if (!(body.sphere_radius >= 0) || !std::isfinite(body.sphere_radius)) {
    reject(body, "radius of the sphere [m]", body.sphere_radius, "zero or positive and finite");
  }
  if (!(body.area >= 0) || !std::isfinite(body.area)) {
    reject(body, "wetted area [m^2]", body.area, "zero or positive and finite");
  }
  if (!body.centre_of_volume.allFinite()) {
    reject(body, "distance of its centre of volume [m]", body.centre_of_volume.norm(), "finite");
  }
}

// Of a fluid body that was filled by hand: readers and builders have checked theirs.
void checkFaces(const FluidBody& body) {
  const FaceTable& faces = body.faces;
  for (const std::vector<double>* column : faces.columns()) {
    if (column->size() != faces.size()) {
      reject(body, "number of entries in a column of its faces",
             static_cast<double>(column->size()), "the same in all columns");
    }
    for (const double entry : *column) {
      if (!std::isfinite(entry)) reject(body, "an entry of its faces", entry, "finite");
    }
  }
}

void checkFlow(const FluidBody& body, const FlowSettings& flow) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kRounding = 1e-9;  // of an angle that was written by hand
  if (!(flow.separation_angle >= kPi / 2 * (1 - kRounding)) ||
      !(flow.separation_angle <= kPi * (1 + kRounding))) {
    reject(body, "separation angle [rad]", flow.separation_angle, "between pi/2 and pi");
  }
  if (!(flow.maximum_load_error >= 0)) {
    reject(body, "largest error of its loads", flow.maximum_load_error, "zero or positive");
  }
}

// The cheapest level that keeps the allowed error, if it is cheaper than all faces.
const LoadLevel* chooseLevel(const FluidBody& body, const FlowSettings& flow) {
  constexpr double kSameAngle = 1e-9;
  const LoadLevel* best = nullptr;
  double least = static_cast<double>(body.faces.size());
  for (const LoadLevel& level : body.levels) {
    const bool fits = std::abs(level.separation_angle - flow.separation_angle) <= kSameAngle &&
                      level.error.p99 <= flow.maximum_load_error;
    if (!fits || !(level.cost < least)) continue;
    least = level.cost;
    best = &level;
  }
  return best;
}

// The cheapest way to the loads that the body, its medium and its settings allow.
void planLoads(const FluidBody& body, const FlowSettings& flow, BodyModel& model) {
  model.load_model = flow.model.get();
  if (!(model.loads.density > 0)) return;
  model.has_surface_loads = model.load_model || body.sphere_radius > 0 || body.faces.size() > 0;
  if (model.load_model) return;
  if (body.sphere_radius > 0) {
    model.sphere_radius = body.sphere_radius;
    if (needsSphereTable(model.loads))
      model.sphere_table = sharedSphereTable(model.loads.separation_cosine);
    return;
  }
  model.level = chooseLevel(body, flow);
  if (!model.level && flow.precision == LoadPrecision::kSingle)
    model.packed_faces = sharedPackedFaces(body.faces);
}

void checkFrame(const FluidBody& body, const FrameOffset& frame) {
  if (!frame.translation.allFinite()) {
    reject(body, "distance of its frame from the centre of mass [m]", frame.translation.norm(),
           "finite");
  }
  constexpr double kRounding = 1e-6;  // of a rotation that was stored as float
  const Matrix3 rest = frame.rotation * frame.rotation.transpose() - Matrix3::Identity();
  const double error = rest.cwiseAbs().maxCoeff();
  if (!(error <= kRounding))
    reject(body, "error of its frame's rotation matrix", error, "at most 1e-6");
  if (!(frame.rotation.determinant() > 0)) {
    reject(body, "determinant of its frame's rotation matrix", frame.rotation.determinant(),
           "1: a rotation, not a mirror");
  }
}

// K as it was before the frame change, whose rounding leaves an asymmetry and, where symmetry makes
// a coupling vanish, something close to zero.
Matrix6 withoutRounding(const Matrix6& inertia) {
  constexpr double kRounding = 1e-14;
  Matrix6 K = 0.5 * (inertia + inertia.transpose());
  const Vector6 size = K.diagonal().cwiseAbs().cwiseSqrt();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (i != j && std::abs(K(i, j)) <= kRounding * size[i] * size[j]) K(i, j) = 0;
  return K;
}

}  // namespace

void checkMedium(const FluidBody& body, const Medium& medium) {
  if (!(medium.density >= 0) || !std::isfinite(medium.density)) {
    reject(body, "density of the medium [kg/m^3]", medium.density, "zero or positive and finite");
  }
  if (!(medium.viscosity >= 0) || !std::isfinite(medium.viscosity)) {
    reject(body, "viscosity of the medium [Pa s]", medium.viscosity, "zero or positive and finite");
  }
  if (!medium.velocity.allFinite()) {
    reject(body, "speed of the medium [m/s]", medium.velocity.norm(), "finite");
  }
  if (!medium.acceleration.allFinite()) {
    reject(body, "acceleration of the medium [m/s^2]", medium.acceleration.norm(), "finite");
  }
}

BodyModel makeBodyModel(const FluidBody& fluid_body, const FrameOffset& fluid_frame,
                        const MassProperties& mass, const Medium& medium,
                        const FlowSettings& flow) {
  checkMass(fluid_body, mass);
  checkShape(fluid_body);
  checkFaces(fluid_body);
  checkMedium(fluid_body, medium);
  checkFlow(fluid_body, flow);
  checkFrame(fluid_body, fluid_frame);
  BodyModel model;
  model.inertia = rigidBodyInertia(mass.mass, mass.inertia) +
                  medium.density * fluid_frame.inertiaToB(fluid_body.added_mass);
  model.inertia = withoutRounding(model.inertia);
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> cholesky(model.inertia);
  if (cholesky.info() != Eigen::Success || !model.inertia.allFinite()) {
    reject(fluid_body, "largest entry of body and added inertia",
           model.inertia.cwiseAbs().maxCoeff(), "finite, in a positive definite 6x6 matrix");
  }
  model.inverse_inertia = cholesky.solve(Eigen::Matrix<double, 6, 6>::Identity());
  model.inverse_inertia = 0.5 * (model.inverse_inertia + model.inverse_inertia.transpose()).eval();
  model.has_diagonal_inertia = model.inertia.isDiagonal(0) && model.inverse_inertia.isDiagonal(0);
  model.mass = mass.mass;
  model.displaced_mass = medium.density * fluid_body.volume;
  model.centre_of_volume =
      fluid_frame.rotation * fluid_body.centre_of_volume + fluid_frame.translation;
  model.fluid_frame = fluid_frame;
  model.loads = {medium.density, medium.viscosity, separationCosine(flow.separation_angle),
                 flow.skin_friction};
  model.reference_length = std::sqrt(fluid_body.area);
  model.largest_mass = eigenvalues(model.inertia.bottomRightCorner<3, 3>())[2];
  model.faces = &fluid_body.faces;
  planLoads(fluid_body, flow, model);
  return model;
}

static Wrench computeLoad(const BodyModel& model, const Twist& x_F) noexcept {
  const double length = model.reference_length;
  if (model.level) return computeLevelLoad(*model.level, length, x_F, model.loads);
  return model.packed_faces ? computeFaceLoad(*model.packed_faces, length, x_F, model.loads)
                            : computeFaceLoads(*model.faces, length, x_F, model.loads).total();
}

// A sphere looks the same in all axes: the frame F plays no part.
static Wrench computeSphereLoad(const BodyModel& model, const Twist& x) noexcept {
  const Twist at_centre{x.angular, x.at(model.centre_of_volume)};
  Wrench load = computeSphereLoads(model.sphere_table.get(), model.sphere_radius,
                                   model.reference_length, at_centre, model.loads)
                    .total();
  load.torque += model.centre_of_volume.cross(load.force);
  return load;
}

SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist) noexcept {
  if (model.sphere_radius > 0) return {computeSphereLoad(model, relative_twist), false};
  const Twist x_F = model.fluid_frame.toF(relative_twist);
  if (model.load_model) {
    const Wrench load_F = model.load_model->load(*model.faces, x_F, model.loads);
    const GuardedWrench guarded =
        removePositivePower(model.fluid_frame.toB(load_F), relative_twist, model.inertia);
    return {guarded.wrench, guarded.acted};
  }
  const Wrench wrench = model.fluid_frame.toB(computeLoad(model, x_F));
  // At alpha = pi/2 no face can push its body along: eq. (15) and (17) are dissipative term by
  // term. The fitted wrenches of clusters can.
  if (model.loads.separation_cosine == 0 && !model.level) return {wrench, false};
  const GuardedWrench guarded = removePositivePower(wrench, relative_twist, model.inertia);
  return {guarded.wrench, guarded.acted};
}

int facesPerLoad(const BodyModel& model) noexcept {
  if (!model.has_surface_loads || model.sphere_radius > 0) return 0;
  return model.level ? model.level->clusters : static_cast<int>(model.faces->size());
}

}  // namespace ambient
