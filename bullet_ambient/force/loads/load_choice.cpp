#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/foils.h"
#include "bullet_ambient/force/loads/form_loads.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/loads/wing_lift.h"

namespace ambient {
namespace {

using Loads = std::shared_ptr<const SurfaceLoads>;

/// Published law at alpha = pi for a body that the surface cuts. The pressure of the attached flow
/// is contained in F_K, docs/theory.md eq. (66). Load: on_faces - slip on the wet part, plus the
/// wet share of that on the whole body in unbounded fluid.
class AttachedLoads final : public LoadsOnPart {
 public:
  /// on_faces: pressure and friction; slip: the pressure alone
  AttachedLoads(FaceSum on_faces, FaceSum slip)
      : on_faces_(std::move(on_faces)), slip_(std::move(slip)) {}

  Wrench sumOn(const Twist& x, const WetPart* wet) const noexcept override {
    return on_faces_.sumOn(x, wet) + -1.0 * slip_.sumOn(x, wet) +
           (wet ? wet->share : 1) * slip_.sumOn(x, nullptr);
  }
  FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept override {
    const Wrench friction = on_faces_.partsOn(x, wet).friction;
    return {sumOn(x, wet) + -1.0 * friction, friction};
  }
  int faces() const noexcept override { return on_faces_.faces() + 2 * slip_.faces(); }

 private:
  FaceSum on_faces_, slip_;
};

/// Published law on a sphere, from the loads on unitSphere() in a fluid with the viscosity over R:
/// with lengths in radii forces grow by R^2, torques by R^3.
class SphereLoads final : public LoadsOnPart {
 public:
  SphereLoads(Loads on_unit, const FluidBody& sphere)
      : on_unit_(std::move(on_unit)),
        centre_(sphere.centre_of_volume),
        radius_(sphere.sphere_radius) {}

  Wrench sumOn(const Twist& x, const WetPart* wet) const noexcept override {
    if (!wet) return partsOn(x, nullptr).total();
    const SurfaceElsewhere surface(wet->plane, {Matrix3::Identity(), centre_}, radius_);
    return enlarged(on_unit_->wetLoad(inRadii(x), {surface.plane, wet->share}));
  }
  FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept override {
    if (!wet) return enlarged(on_unit_->parts(inRadii(x)));
    const SurfaceElsewhere surface(wet->plane, {Matrix3::Identity(), centre_}, radius_);
    return enlarged(on_unit_->wetParts(inRadii(x), {surface.plane, wet->share}));
  }
  int faces() const noexcept override { return on_unit_->faces(); }
  bool needsGuard() const noexcept override { return on_unit_->needsGuard(); }
  double wakeShare() const noexcept override { return on_unit_->wakeShare(); }
  /// Frame at the sphere's centre with the axes of F.
  FrameOffset frame(const FrameOffset& fluid_frame) const override {
    return {fluid_frame.rotation, fluid_frame.rotation * centre_ + fluid_frame.translation};
  }

 private:
  Twist inRadii(const Twist& x) const noexcept { return {radius_ * x.angular, x.linear}; }
  Wrench enlarged(const Wrench& load) const noexcept {
    const double square = radius_ * radius_;
    return {square * radius_ * load.torque, square * load.force};
  }
  FaceLoads enlarged(const FaceLoads& loads) const noexcept {
    return {enlarged(loads.pressure), enlarged(loads.friction)};
  }

  Loads on_unit_;
  Vector3 centre_;
  double radius_;
};

// Checks the faces of a fluid body that the user's code may have filled.
void checkFaces(const FluidBody& body) {
  const FaceTable& faces = body.faces;
  for (const std::vector<double>* column : faces.columns()) {
    if (column->size() != faces.size()) {
      reject(body, "number of entries in a column of its faces",
             static_cast<double>(column->size()), "the same in all columns");
    }
    for (const double entry : *column)
      if (!std::isfinite(entry)) reject(body, "an entry of its faces", entry, "finite");
  }
}

using Body = std::shared_ptr<const FluidBody>;

bool hasFaces(const FluidBody& body) { return body.faces.size() > 0 || body.omits_faces; }

// Returns the faces that the form law is summed over: those of the smallest level within the
// allowed error, or all.
LoadTables::Faces chooseFormFaces(const Body& body, const ShapeFactors& shape,
                                  const FlowSettings& flow) {
  const FormLevel* best = nullptr;
  for (const FormLevel& level : body->form_levels) {
    const bool fits = level.law_revision == kFormLawRevision || !shape.actOnFaces();
    if (fits && level.p99_error <= flow.maximum_load_error &&
        (!best || level.faces.size() < best->faces.size()))
      best = &level;
  }
  return {body, best ? &best->faces : &body->form.faces};
}

/// Published law; at alpha = pi a body that the surface may cut has other loads.
Loads publishedLoads(const Body& body, LoadSettings settings, LoadPrecision precision,
                     bool is_cut) {
  const Body whole = withFaces(body);
  const LoadTables::Faces faces(whole, &whole->faces);
  FaceSum on_faces(whole, faces, settings, precision);
  if (!is_cut || settings.separation_cosine != -1)
    return std::make_shared<FaceSum>(std::move(on_faces));
  settings.skin_friction = false;
  return std::make_shared<AttachedLoads>(std::move(on_faces),
                                         FaceSum(whole, faces, settings, precision));
}

/// Form law; on a body with wings part by part.
Loads formLoads(const Body& body, const LoadSettings& settings, const FlowSettings& flow) {
  requirePrepared(*body);
  const auto onFaces = [&](LoadTables::Faces faces, const ShapeFactors& shape) {
    LoadSettings smooth = settings;  // friction is no sum over faces
    smooth.shape = &shape;
    smooth.skin_friction = false;
    return FaceSum(body, std::move(faces), smooth, flow.precision);
  };
  if (body->wings.empty()) {
    const LoadTables::Shape shape = LoadTables(body).shape();
    return makeFormLoads(onFaces(chooseFormFaces(body, *shape, flow), *shape), body, settings,
                         flow.stall_lag);
  }
  const LoadTables::Parts parts = LoadTables(body).parts();
  LoadsOnWings wings{WingLift(*body, *parts, flow.stall_lag), {}};
  for (std::size_t i = 1; i < parts->size(); ++i)
    wings.on_faces.push_back(onFaces({body, &(*parts)[i].faces}, (*parts)[i].shape));
  const BodyPart& rest = parts->front();
  return makeFormLoads(onFaces({body, &rest.faces}, rest.shape), body, settings, flow.stall_lag,
                       std::move(wings));
}

/// Form law on a ball, which a surface may cut or not.
Loads loadsOnBall(const Body& ball, const LoadSettings& settings, const FlowSettings& flow,
                  bool is_cut) {
  LoadSettings ideal = settings;
  ideal.viscosity = 0;
  return makeBallLoads(is_cut ? formLoads(unitSphere(), ideal, flow) : nullptr, *ball, settings);
}

/// Published law on the faces of unitSphere().
Loads loadsOnSphere(const Body& sphere, LoadSettings settings, LoadPrecision precision) {
  settings.viscosity /= sphere->sphere_radius;
  return std::make_shared<SphereLoads>(publishedLoads(unitSphere(), settings, precision, true),
                                       *sphere);
}

/// Whether a body that a surface may cut has other loads than one that is wholly in a fluid.
bool isOtherWhereCut(const FluidBody& body, const LoadSettings& settings) {
  const bool has_levels = settings.law == PressureLaw::kForm && !body.form_levels.empty();
  return body.sphere_radius > 0 || has_levels || settings.separation_cosine == -1;
}

Loads lawOf(const Body& body, const LoadSettings& settings, const FlowSettings& flow,
            FluidExtent extent) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  const bool is_cut = extent == FluidExtent::kWaterline;
  if (flow.own_law && !is_cut) return flow.own_law(withFaces(body), settings);
  const bool is_ball = body->sphere_radius > 0;
  if (!is_ball && !hasFaces(*body)) return nullptr;
  if (settings.law != PressureLaw::kForm)
    return is_ball ? loadsOnSphere(body, settings, flow.precision)
                   : publishedLoads(body, settings, flow.precision, is_cut);
  FlowSettings chosen = flow;
  if (is_cut) chosen.maximum_load_error = 0;
  return is_ball ? loadsOnBall(body, settings, chosen, is_cut) : formLoads(body, settings, chosen);
}

Loads makeLoads(const Body& body, const Medium& medium, const FlowSettings& flow,
                FluidExtent extent) {
  const LoadSettings settings = loadSettings(medium, flow);
  checkFlow(*body, flow);
  if (!isOtherWhereCut(*body, settings)) extent = FluidExtent::kUnbounded;
  const auto make = [&] { return lawOf(body, settings, flow, extent); };
  // Not for a medium without loads, nor for one that later checks reject.
  const bool is_shared = medium.density > 0 && medium.viscosity >= 0 && !flow.own_law;
  auto loads = is_shared ? LoadTables(body).loads(medium, flow, extent, make) : make();
  if (!flow.foils || !(medium.density > 0)) return loads;
  return addFoils(std::move(loads), flow.foils, medium.density);
}

}  // namespace

std::optional<NumberFault> faultOf(const FlowSettings& flow) noexcept {
  constexpr double kRounding = 1e-9;  // tolerance for angles typed with few digits
  if (!(flow.separation_angle >= kPi / 2 * (1 - kRounding)) ||
      !(flow.separation_angle <= kPi * (1 + kRounding)))
    return NumberFault{"separation angle", "rad", flow.separation_angle, "between pi/2 and pi"};
  constexpr double kLongestLag = 1e6;  // keeps its products with the motion finite
  if (!(flow.stall_lag >= 0) || !(flow.stall_lag <= kLongestLag))
    return NumberFault{"stall lag", "lengths over speed", flow.stall_lag, "from 0 to 1e6"};
  if (!(flow.roughness >= 0) || !std::isfinite(flow.roughness))
    return NumberFault{"roughness", "m", flow.roughness, "zero or positive and finite"};
  if (!(flow.maximum_load_error >= 0))
    return NumberFault{"largest error of its loads", "1", flow.maximum_load_error,
                       "zero or positive"};
  return {};
}

void checkFlow(const FluidBody& body, const FlowSettings& flow) {
  const double roughest = std::sqrt(body.area);
  if (!(flow.roughness >= 0) || (flow.roughness > 0 && !(flow.roughness <= roughest))) {
    std::ostringstream limit;
    limit << "from 0 to " << roughest << ", the root of its area";
    reject(body, "roughness [m]", flow.roughness, limit.str().c_str());
  }
  if (const auto fault = faultOf(flow))
    reject(body, std::string(fault->quantity) + " [" + fault->unit + "]", fault->value,
           fault->limit);
}

LoadSettings loadSettings(const Medium& medium, const FlowSettings& flow) {
  const bool is_form = flow.law == PressureLaw::kForm;
  return {
      medium.density,     medium.viscosity, is_form ? 0 : separationCosine(flow.separation_angle),
      flow.skin_friction, flow.law,         nullptr,
      flow.roughness};
}

std::shared_ptr<const SurfaceLoads> makeSurfaceLoads(const std::shared_ptr<const FluidBody>& body,
                                                     const Medium& medium,
                                                     const FlowSettings& flow) {
  return makeLoads(body, medium, flow, FluidExtent::kUnbounded);
}

std::shared_ptr<const SurfaceLoads> makeWaterlineLoads(const std::shared_ptr<const FluidBody>& body,
                                                       const Medium& medium,
                                                       const FlowSettings& flow) {
  const bool has_places = (hasFaces(*body) || body->sphere_radius > 0) && !flow.own_law;
  return makeLoads(body, medium, flow,
                   has_places ? FluidExtent::kWaterline : FluidExtent::kUnbounded);
}

}  // namespace ambient
