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

/// Length in the Reynolds number [m], docs/theory.md eq. (16).
double referenceLength(const FluidBody& body) { return std::sqrt(body.area); }

/// Loads by one of the functions that sum eq. (13) to (17), over all faces or below a plane.
template <class Table, Wrench (*kSum)(const Table&, double, const Twist&, const LoadSettings&,
                                      const SurfacePlane*) noexcept>
class SummedLoads : public SurfaceLoads {
 public:
  SummedLoads(std::shared_ptr<const Table> table, std::size_t faces, double length,
              const LoadSettings& settings)
      : table_(std::move(table)),
        faces_(static_cast<int>(faces)),
        length_(length),
        settings_(settings) {}

  Wrench load(const Twist& x) const noexcept override {
    return kSum(*table_, length_, x, settings_, nullptr);
  }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return kSum(*table_, length_, x, settings_, &wet.plane);
  }
  FaceLoads parts(const Twist& x) const noexcept override { return partsOf(x, nullptr); }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    return partsOf(x, &wet.plane);
  }
  int faces() const noexcept override { return faces_; }
  /// At alpha = pi/2 the power of each face is negative or 0 by both laws.
  bool needsGuard() const noexcept override { return settings_.separation_cosine != 0; }

 protected:
  /// Friction is what the sum lacks without it.
  FaceLoads partsOf(const Twist& x, const SurfacePlane* plane) const noexcept {
    LoadSettings smooth = settings_;
    smooth.skin_friction = false;
    const Wrench pressure = kSum(*table_, length_, x, smooth, plane);
    return {pressure, kSum(*table_, length_, x, settings_, plane) + -1.0 * pressure};
  }

  std::shared_ptr<const Table> table_;
  int faces_;
  double length_;
  LoadSettings settings_;
};

Wrench sumInDouble(const FaceTable& faces, double length, const Twist& x,
                   const LoadSettings& settings, const SurfacePlane* plane) noexcept {
  return computeFaceLoads(faces, length, x, settings, plane).total();
}

/// Where sides of a pool cut the faces, they are summed in double.
class SingleLoads final : public SummedLoads<PackedFaces, computeFaceLoad> {
 public:
  /// `packed` holds `faces`.
  SingleLoads(std::shared_ptr<const PackedFaces> packed, LoadTables::Faces faces, double length,
              const LoadSettings& settings)
      : SummedLoads(std::move(packed), faces->size(), length, settings),
        in_double_(std::move(faces)) {}

  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return wet.plane.sides_F ? wetParts(x, wet).total() : SummedLoads::wetLoad(x, wet);
  }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    if (!wet.plane.sides_F) return SummedLoads::wetParts(x, wet);
    return computeFaceLoads(*in_double_, length_, x, settings_, &wet.plane);
  }

 private:
  LoadTables::Faces in_double_;
};

struct DoubleLoads final : SummedLoads<FaceTable, sumInDouble> {
  using SummedLoads::SummedLoads;
  FaceLoads parts(const Twist& x) const noexcept override {
    return computeFaceLoads(*table_, length_, x, settings_);
  }
};

/// Published law at alpha = pi for a body that the surface cuts. The pressure of the attached flow
/// is contained in F_K, docs/theory.md eq. (66). Load: on_faces - slip on the wet part, plus the
/// wet share of `whole`.
class AttachedLoads final : public SurfaceLoads {
 public:
  /// on_faces: pressure and friction; slip: the pressure alone; whole: pressure on the whole body
  /// in unbounded fluid.
  AttachedLoads(std::shared_ptr<const SurfaceLoads> on_faces,
                std::shared_ptr<const SurfaceLoads> slip, std::shared_ptr<const SurfaceLoads> whole)
      : on_faces_(std::move(on_faces)),
        slip_(std::move(slip)),
        whole_(std::move(whole)),
        whole_frame_(whole_->frame({})) {}

  Wrench load(const Twist& x) const noexcept override {
    return on_faces_->load(x) + -1.0 * slip_->load(x) + wholeLoad(x);
  }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return on_faces_->wetLoad(x, wet) + -1.0 * slip_->wetLoad(x, wet) + wet.share * wholeLoad(x);
  }
  FaceLoads parts(const Twist& x) const noexcept override {
    const Wrench friction = on_faces_->parts(x).friction;
    return {load(x) + -1.0 * friction, friction};
  }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    const Wrench friction = on_faces_->wetParts(x, wet).friction;
    return {wetLoad(x, wet) + -1.0 * friction, friction};
  }
  int faces() const noexcept override {
    return on_faces_->faces() + slip_->faces() + whole_->faces();
  }
  bool needsGuard() const noexcept override { return whole_->needsGuard(); }
  double wakeShare() const noexcept override { return on_faces_->wakeShare(); }

 private:
  Wrench wholeLoad(const Twist& x) const noexcept {
    return whole_frame_.toB(whole_->load(whole_frame_.toF(x)));
  }

  std::shared_ptr<const SurfaceLoads> on_faces_, slip_, whole_;
  FrameOffset whole_frame_;
};

/// Published law on a sphere, from the loads on unitSphere() in a fluid with the viscosity over R:
/// with lengths in radii forces grow by R^2, torques by R^3.
class SphereLoads final : public SurfaceLoads {
 public:
  SphereLoads(std::shared_ptr<const SurfaceLoads> on_unit, const FluidBody& sphere)
      : on_unit_(std::move(on_unit)),
        centre_(sphere.centre_of_volume),
        radius_(sphere.sphere_radius) {}

  Wrench load(const Twist& x) const noexcept override { return parts(x).total(); }
  FaceLoads parts(const Twist& x) const noexcept override {
    return enlarged(on_unit_->parts(inRadii(x)));
  }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    const PlaneInRadii surface(wet.plane, centre_, radius_);
    return enlarged(on_unit_->wetLoad(inRadii(x), {surface.plane, wet.share}));
  }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    const PlaneInRadii surface(wet.plane, centre_, radius_);
    return enlarged(on_unit_->wetParts(inRadii(x), {surface.plane, wet.share}));
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

  std::shared_ptr<const SurfaceLoads> on_unit_;
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

std::shared_ptr<const SurfaceLoads> loadsOn(const Body& body, const LoadTables::Faces& faces,
                                            const LoadSettings& settings, LoadPrecision precision) {
  const double length = referenceLength(*body);
  if (precision == LoadPrecision::kDouble)
    return std::make_shared<DoubleLoads>(faces, faces->size(), length, settings);
  return std::make_shared<SingleLoads>(LoadTables(body).packedFaces(faces, settings.shape), faces,
                                       length, settings);
}

/// Form law on a body with wings, part by part.
std::shared_ptr<const SurfaceLoads> loadsOnParts(const Body& body, const LoadSettings& settings,
                                                 const FlowSettings& flow) {
  const LoadTables::Parts parts = LoadTables(body).parts();
  const auto onFaces = [&](const BodyPart& part) {
    LoadSettings smooth = settings;  // friction is no sum over faces
    smooth.shape = &part.shape;
    smooth.skin_friction = false;
    return loadsOn(body, {body, &part.faces}, smooth, flow.precision);
  };
  std::vector<std::shared_ptr<const SurfaceLoads>> on_wings;
  for (std::size_t i = 1; i < parts->size(); ++i) on_wings.push_back(onFaces((*parts)[i]));
  return makeFormLoads(onFaces(parts->front()), {body, &body->form.faces}, body, settings,
                       flow.stall_lag,
                       LoadsOnWings{WingLift(*body, *parts, flow.stall_lag), std::move(on_wings)});
}

std::shared_ptr<const SurfaceLoads> loadsOnFaces(const Body& body, LoadSettings settings,
                                                 const FlowSettings& flow) {
  if (!hasFaces(*body)) return nullptr;
  if (settings.law != PressureLaw::kForm) {
    const Body whole = withFaces(body);
    return loadsOn(whole, {whole, &whole->faces}, settings, flow.precision);
  }
  requirePrepared(*body);
  if (!body->wings.empty()) return loadsOnParts(body, settings, flow);
  const LoadTables::Shape shape = LoadTables(body).shape();
  const LoadTables::Faces faces = chooseFormFaces(body, *shape, flow);
  LoadSettings smooth = settings;  // friction is no sum over faces
  smooth.shape = shape.get();
  smooth.skin_friction = false;
  auto on_faces = loadsOn(body, faces, smooth, flow.precision);
  return makeFormLoads(std::move(on_faces), faces, body, settings, flow.stall_lag);
}

std::shared_ptr<const SurfaceLoads> waterlineLoadsOnFaces(const Body& body, LoadSettings settings,
                                                          const FlowSettings& flow) {
  auto on_faces = loadsOnFaces(body, settings, flow);
  if (settings.separation_cosine != -1) return on_faces;
  settings.skin_friction = false;
  const auto slip = loadsOnFaces(body, settings, flow);
  return std::make_shared<AttachedLoads>(std::move(on_faces), slip, slip);
}

/// Form law on a ball, which a surface may cut or not.
std::shared_ptr<const SurfaceLoads> loadsOnBall(const Body& ball, const LoadSettings& settings,
                                                const FlowSettings& flow, bool is_cut) {
  LoadSettings ideal = settings;
  ideal.viscosity = 0;
  return makeBallLoads(is_cut ? loadsOnFaces(unitSphere(), ideal, flow) : nullptr, *ball, settings);
}

/// Published law on the faces of unitSphere().
std::shared_ptr<const SurfaceLoads> loadsOnSphere(const Body& sphere, LoadSettings settings,
                                                  const FlowSettings& flow) {
  settings.viscosity /= sphere->sphere_radius;
  return std::make_shared<SphereLoads>(waterlineLoadsOnFaces(unitSphere(), settings, flow),
                                       *sphere);
}

/// Whether a body that a surface may cut has other loads than one that is wholly in a fluid.
bool isOtherWhereCut(const FluidBody& body, const LoadSettings& settings) {
  const bool has_levels = settings.law == PressureLaw::kForm && !body.form_levels.empty();
  return body.sphere_radius > 0 || has_levels || settings.separation_cosine == -1;
}

std::shared_ptr<const SurfaceLoads> lawOf(const Body& body, const LoadSettings& settings,
                                          const FlowSettings& flow, FluidExtent extent) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  const bool is_cut = extent == FluidExtent::kWaterline;
  if (flow.own_law && !is_cut) return flow.own_law(withFaces(body), settings);
  FlowSettings chosen = flow;
  if (is_cut) chosen.maximum_load_error = 0;
  if (body->sphere_radius > 0)
    return settings.law == PressureLaw::kForm ? loadsOnBall(body, settings, chosen, is_cut)
                                              : loadsOnSphere(body, settings, chosen);
  return (is_cut ? waterlineLoadsOnFaces : loadsOnFaces)(body, settings, chosen);
}

std::shared_ptr<const SurfaceLoads> makeLoads(const Body& body, const Medium& medium,
                                              const FlowSettings& flow, FluidExtent extent) {
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
