#include "bullet_ambient/force/loads/surface_loads.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/law/viscous_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/load_tables.h"
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

/// Loads whose parts a derived class computes at once.
class ViscousLoads : public SurfaceLoads {
 public:
  Wrench load(const Twist& x) const noexcept override { return partsOn(x, nullptr).total(); }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return partsOn(x, &wet).total();
  }
  FaceLoads parts(const Twist& x) const noexcept override { return partsOn(x, nullptr); }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    return partsOn(x, &wet);
  }
  SplitLoad split(const Twist& x, const WetPart* wet) const noexcept override {
    const Parts parts = compute(x, wet);
    return {parts.pressure + parts.layer, parts.growth};
  }
  const Resistance* resistance() const noexcept override {
    return resistance_ ? &*resistance_ : nullptr;
  }
  bool needsGuard() const noexcept override { return false; }

 protected:
  /// Pressure, friction of turbulent layers, and growth of the resistance.
  struct Parts {
    Wrench pressure, layer;
    Growth growth;
  };
  /// Computes the parts on the whole body, or on the part of it in the fluid.
  virtual Parts compute(const Twist& x, const WetPart* wet) const noexcept = 0;

  /// C becomes C times the share of the body in the fluid.
  static Growth inWater(const Growth& growth, const WetPart* wet) noexcept {
    const double root = wet ? std::sqrt(wet->share) : 1;
    return {root * growth.rotation, root * growth.translation};
  }

  std::optional<Resistance> resistance_;  ///< none: no friction

 private:
  FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept {
    const Parts parts = compute(x, wet);
    if (!resistance_) return {parts.pressure, {}};
    return {parts.pressure, parts.layer + resistance_->load(parts.growth, x)};
  }
};

ViscousFluid fluidOf(const LoadSettings& settings) {
  return {settings.density, settings.viscosity, settings.roughness};
}

/// Form law: loads on faces, their drag scaled by DragScale, plus FormLift on the body as a whole;
/// with viscosity by ViscousLaw, docs/theory.md eq. (113). Of a body with wings these are loads on
/// its rest, and those on its wings are added, eq. (160).
class FormLoads final : public ViscousLoads {
 public:
  /// on_faces: pressure on `faces` of the body, or on those of its rest.
  FormLoads(std::shared_ptr<const SurfaceLoads> on_faces, const LoadTables::Faces& faces,
            const LoadTables::Body& body, const LoadSettings& settings, double stall_lag)
      : on_faces_(std::move(on_faces)),
        shape_(LoadTables(body).shape()),
        drag_(*body, *faces,
              [&](const Vector3& frontal) {
                return LoadTables(body).ownDrag(faces, Matrix3::Identity(), frontal);
              }),
        lift_(*body, *shape_, stall_lag),
        density_(settings.density),
        centre_(body->centre_of_volume) {
    if (!(settings.viscosity > 0) || !body->viscous.isKnown()) return;
    Vector3 own_drag{0, 0, 0};
    if (!body->viscous.separation.smooth_base.isZero(0)) own_drag = LoadTables(body).ownDrag(faces);
    law_.emplace(*body, shape_->shape, own_drag, fluidOf(settings));
    if (settings.skin_friction) resistance_ = law_->resistance();
  }

  /// Adds wings, which lift with the rest in place of the body as a whole: pressure on their faces.
  void add(WingLift lift, std::vector<std::shared_ptr<const SurfaceLoads>> on_wings) {
    wings_ = std::move(lift);
    on_wings_ = std::move(on_wings);
    lift_ = FormLift(LiftedPart{}, *shape_, 0);
  }

  int faces() const noexcept override {
    int faces = on_faces_->faces();
    for (const auto& wing : on_wings_) faces += wing->faces();
    return faces;
  }
  double wakeShare() const noexcept override { return shape_->wakeShare(); }

 protected:
  Parts compute(const Twist& x, const WetPart* wet) const noexcept override {
    const double share = wet ? wet->share : 1;
    const Vector3 &w = x.angular, v = x.at(centre_);
    if (!law_) {
      const Wrench faces = drag_.scaled(withWings(onFaces(x, wet), x, wet), x);
      Parts parts{faces + share * atCentre(lift_.load(w, v, density_)), {}, {}};
      if (wings_) parts.pressure += wings_->load(x, density_, {}, wet);
      return parts;
    }
    const ViscousLaw::Scalars s = law_->scalars(x);
    if (!s.moves) return {{}, {}, resistance_ ? inWater(kCreeping, wet) : Growth{}};
    const Wrench on_faces = drag_.scaled(withWings(pressure(s, x, v, wet), x, wet), x);
    Wrench whole = lift_.load(w, v, density_, s.munk);
    if (law_->isSmooth()) whole += law_->smoothLoad(s, w, v);
    Parts parts{s.pressure * on_faces + share * atCentre(whole), {}, {}};
    if (wings_) parts.pressure += wings_->load(x, density_, {s.munk, s.pressure}, wet);
    if (!resistance_) return parts;
    if (law_->isSmooth()) parts.layer = share * atCentre({Vector3::Zero(), law_->layerForce(s, v)});
    parts.growth = inWater(law_->growth(s, share > 0 ? -power(on_faces, x) / share : 0), wet);
    return parts;
  }

 private:
  Wrench onFaces(const Twist& x, const WetPart* wet) const noexcept {
    return wet ? on_faces_->wetLoad(x, *wet) : on_faces_->load(x);
  }
  Wrench withWings(Wrench load, const Twist& x, const WetPart* wet) const noexcept {
    for (const auto& wing : on_wings_) load += wet ? wing->wetLoad(x, *wet) : wing->load(x);
    return load;
  }
  Wrench atCentre(const Wrench& about) const noexcept {
    return {about.torque + centre_.cross(about.force), about.force};
  }
  /// F_P of eq. (111): S P(S x), with S about the centre of volume in the axes q_j. `v`: there.
  Wrench pressure(const ViscousLaw::Scalars& s, const Twist& x, const Vector3& v,
                  const WetPart* wet) const noexcept {
    if (!law_->isSmooth()) return onFaces(x, wet);
    const Matrix3 turning = law_->scaling(s.turning), moving = law_->scaling(s.moving);
    Twist seen{turning * x.angular, moving * v};
    seen.linear -= seen.angular.cross(centre_);
    const Wrench load = onFaces(seen, wet);
    return atCentre({turning * (load.torque - centre_.cross(load.force)), moving * load.force});
  }

  std::shared_ptr<const SurfaceLoads> on_faces_;
  LoadTables::Shape shape_;
  DragScale drag_;
  FormLift lift_;
  double density_;
  Vector3 centre_;
  std::optional<ViscousLaw> law_;  ///< none: no viscosity
  std::optional<WingLift> wings_;  ///< none: the body is one part
  std::vector<std::shared_ptr<const SurfaceLoads>> on_wings_;
};

/// Form law on a ball in closed form, docs/theory.md eq. (119); on the part of it that is in the
/// fluid, its pressure by the faces of unitSphere(), with lengths in radii.
class BallLoads final : public ViscousLoads {
 public:
  /// on_unit: pressure on unitSphere(); null for a ball that no surface cuts.
  BallLoads(std::shared_ptr<const SurfaceLoads> on_unit, const FluidBody& ball,
            const LoadSettings& settings)
      : on_unit_(std::move(on_unit)),
        centre_(ball.centre_of_volume),
        radius_(ball.sphere_radius),
        fluid_(fluidOf(settings)) {
    if (settings.skin_friction && settings.viscosity > 0)
      resistance_ = ballResistance(radius_, settings.viscosity);
  }

  int faces() const noexcept override { return on_unit_ ? on_unit_->faces() : 0; }
  double wakeShare() const noexcept override { return 1; }
  /// Frame at the ball's centre with the axes of F.
  FrameOffset frame(const FrameOffset& fluid_frame) const override {
    return {fluid_frame.rotation, fluid_frame.rotation * centre_ + fluid_frame.translation};
  }

 protected:
  Parts compute(const Twist& x, const WetPart* wet) const noexcept override {
    const BallLoad ball = computeBallLoad(radius_, fluid_, x);
    Parts parts{ball.pressure, ball.layer, inWater(ball.growth, wet)};
    if (wet) {
      const PlaneInRadii surface(wet->plane, centre_, radius_);
      const Wrench on_faces =
          on_unit_->wetLoad({radius_ * x.angular, x.linear}, {surface.plane, wet->share});
      const double scale =
          ball.share * ball.suction * ball.suction * ball.suction * radius_ * radius_;
      parts.pressure = {scale * radius_ * on_faces.torque,
                        scale * on_faces.force + wet->share * ball.whole};
      parts.layer = wet->share * parts.layer;
    }
    if (!resistance_) {
      parts.layer = {};
      parts.growth = {};
    }
    return parts;
  }

 private:
  std::shared_ptr<const SurfaceLoads> on_unit_;
  Vector3 centre_;
  double radius_;
  ViscousFluid fluid_;
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

void checkFlow(const FluidBody& body, const FlowSettings& flow) {
  constexpr double kRounding = 1e-9;  // tolerance for angles typed with few digits
  if (!(flow.separation_angle >= kPi / 2 * (1 - kRounding)) ||
      !(flow.separation_angle <= kPi * (1 + kRounding))) {
    reject(body, "separation angle [rad]", flow.separation_angle, "between pi/2 and pi");
  }
  constexpr double kLongestLag = 1e6;  // keeps its products with the motion finite
  if (!(flow.stall_lag >= 0) || !(flow.stall_lag <= kLongestLag))
    reject(body, "stall lag [lengths over speed]", flow.stall_lag, "from 0 to 1e6");
  const double roughest = std::sqrt(body.area);
  if (!(flow.roughness >= 0) || (flow.roughness > 0 && !(flow.roughness <= roughest))) {
    std::ostringstream limit;
    limit << "from 0 to " << roughest << ", the root of its area";
    reject(body, "roughness [m]", flow.roughness, limit.str().c_str());
  }
  if (!(flow.maximum_load_error >= 0))
    reject(body, "largest error of its loads", flow.maximum_load_error, "zero or positive");
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
  const BodyPart& rest = parts->front();
  const auto loads = std::make_shared<FormLoads>(
      onFaces(rest), LoadTables::Faces{body, &body->form.faces}, body, settings, flow.stall_lag);
  std::vector<std::shared_ptr<const SurfaceLoads>> on_wings;
  for (std::size_t i = 1; i < parts->size(); ++i) on_wings.push_back(onFaces((*parts)[i]));
  loads->add(WingLift(*parts, flow.stall_lag), std::move(on_wings));
  return loads;
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
  return std::make_shared<FormLoads>(std::move(on_faces), faces, body, settings, flow.stall_lag);
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
  return std::make_shared<BallLoads>(is_cut ? loadsOnFaces(unitSphere(), ideal, flow) : nullptr,
                                     *ball, settings);
}

/// Published law on the faces of unitSphere().
std::shared_ptr<const SurfaceLoads> loadsOnSphere(const Body& sphere, LoadSettings settings,
                                                  const FlowSettings& flow) {
  settings.viscosity /= sphere->sphere_radius;
  return std::make_shared<SphereLoads>(waterlineLoadsOnFaces(unitSphere(), settings, flow),
                                       *sphere);
}

std::shared_ptr<const SurfaceLoads> lawOf(const Body& body, const LoadSettings& settings,
                                          const FlowSettings& flow, LoadPlace place) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  const bool is_cut = place == LoadPlace::kWaterline;
  if (flow.own_law && !is_cut) return flow.own_law(withFaces(body), settings);
  FlowSettings chosen = flow;
  if (is_cut) chosen.maximum_load_error = 0;
  if (body->sphere_radius > 0)
    return settings.law == PressureLaw::kForm ? loadsOnBall(body, settings, chosen, is_cut)
                                              : loadsOnSphere(body, settings, chosen);
  return (is_cut ? waterlineLoadsOnFaces : loadsOnFaces)(body, settings, chosen);
}

std::shared_ptr<const SurfaceLoads> makeLoads(const Body& body, const Medium& medium,
                                              const FlowSettings& flow, LoadPlace place) {
  const LoadSettings settings = loadSettings(medium, flow);
  const auto make = [&] { return lawOf(body, settings, flow, place); };
  checkFlow(*body, flow);
  // Not for a medium without loads, nor for one that later checks reject.
  const bool is_shared = medium.density > 0 && medium.viscosity >= 0 && !flow.own_law;
  return is_shared ? LoadTables(body).loads(medium, flow, place, make) : make();
}

}  // namespace

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
  return makeLoads(body, medium, flow, LoadPlace::kUnbounded);
}

std::shared_ptr<const SurfaceLoads> makeWaterlineLoads(const std::shared_ptr<const FluidBody>& body,
                                                       const Medium& medium,
                                                       const FlowSettings& flow) {
  const bool has_places = (hasFaces(*body) || body->sphere_radius > 0) && !flow.own_law;
  return makeLoads(body, medium, flow, has_places ? LoadPlace::kWaterline : LoadPlace::kUnbounded);
}

}  // namespace ambient
