#include "bullet_ambient/force/loads/surface_loads.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/sphere_loads.h"
#include "bullet_ambient/force/loads/unit_sphere.h"

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
  FaceLoads parts(const Twist& x) const noexcept override { return split(x, nullptr); }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    return split(x, &wet.plane);
  }
  int faces() const noexcept override { return faces_; }
  /// At alpha = pi/2 the power of each face is negative or 0 by both laws.
  bool needsGuard() const noexcept override { return settings_.separation_cosine != 0; }
  double wakeShare() const noexcept override { return settings_.wake_share; }

 protected:
  /// Friction is what the sum lacks without it.
  FaceLoads split(const Twist& x, const SurfacePlane* plane) const noexcept {
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

/// Form law: loads on faces, their drag scaled by DragScale, plus FormLift on the body as a whole.
class FormLoads final : public SurfaceLoads {
 public:
  /// on_faces: loads on `faces`.
  FormLoads(std::shared_ptr<const SurfaceLoads> on_faces, const FaceTable& faces,
            LoadTables::Shape shape, const FluidBody& body, const LoadSettings& settings,
            double stall_lag)
      : on_faces_(std::move(on_faces)),
        shape_(std::move(shape)),
        drag_(body, faces, *shape_),
        lift_(body, *shape_, stall_lag, shape_->slipShare(settings.separation_cosine)),
        density_(settings.density) {}

  Wrench load(const Twist& x) const noexcept override {
    return drag_.scaled(on_faces_->load(x), x) + lift_.load(x, density_);
  }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return drag_.scaled(on_faces_->wetLoad(x, wet), x) + wet.share * lift_.load(x, density_);
  }
  FaceLoads parts(const Twist& x) const noexcept override {
    return onBody(x, on_faces_->parts(x), 1);
  }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    return onBody(x, on_faces_->wetParts(x, wet), wet.share);
  }
  int faces() const noexcept override { return on_faces_->faces(); }
  bool needsGuard() const noexcept override { return on_faces_->needsGuard(); }
  double wakeShare() const noexcept override { return shape_->wakeShare(); }

 private:
  FaceLoads onBody(const Twist& x, const FaceLoads& parts, double share) const noexcept {
    return {drag_.scaled(parts.pressure, x) + share * lift_.load(x, density_),
            drag_.scaled(parts.friction, x)};
  }

  std::shared_ptr<const SurfaceLoads> on_faces_;
  LoadTables::Shape shape_;
  DragScale drag_;
  FormLift lift_;
  double density_;
};

class SphereLoads final : public SurfaceLoads {
 public:
  SphereLoads(const FluidBody& body, const LoadSettings& settings)
      : centre_(body.centre_of_volume),
        radius_(body.sphere_radius),
        length_(referenceLength(body)),
        settings_(settings) {
    if (needsSphereTable(settings)) table_ = sharedSphereTable(settings.separation_cosine);
  }

  Wrench load(const Twist& x) const noexcept override { return parts(x).total(); }
  FaceLoads parts(const Twist& x) const noexcept override {
    return computeSphereLoads(table_.get(), radius_, length_, x, settings_);
  }
  bool needsGuard() const noexcept override { return false; }
  double wakeShare() const noexcept override { return settings_.wake_share; }
  /// Frame at the sphere's centre with the axes of B.
  FrameOffset frame(const FrameOffset& fluid_frame) const override {
    return {Matrix3::Identity(), fluid_frame.rotation * centre_ + fluid_frame.translation};
  }

 private:
  Vector3 centre_;
  double radius_, length_;
  LoadSettings settings_;
  std::shared_ptr<const SphereTable> table_;  ///< null if needsSphereTable() is false
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

/// Form law at alpha = pi for a body that the surface cuts. The lee adds the pressure of the slip;
/// for a part of the body this addition is the wet share of the whole, as in AttachedLoads.
class AttachedFormLoads final : public SurfaceLoads {
 public:
  /// separated: form law at alpha = pi/2; attached: form law at alpha = pi.
  AttachedFormLoads(std::shared_ptr<const SurfaceLoads> separated,
                    std::shared_ptr<const SurfaceLoads> attached)
      : separated_(std::move(separated)), attached_(std::move(attached)) {}

  Wrench load(const Twist& x) const noexcept override { return attached_->load(x); }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    const Wrench by_lee = attached_->load(x) + -1.0 * separated_->load(x);
    return separated_->wetLoad(x, wet) + wet.share * by_lee;
  }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    const Wrench friction = separated_->wetParts(x, wet).friction;
    return {wetLoad(x, wet) + -1.0 * friction, friction};
  }
  int faces() const noexcept override { return 2 * separated_->faces() + attached_->faces(); }
  bool needsGuard() const noexcept override { return attached_->needsGuard(); }
  double wakeShare() const noexcept override { return separated_->wakeShare(); }

 private:
  std::shared_ptr<const SurfaceLoads> separated_, attached_;
};

/// Loads on a sphere that the surface of its fluid may cut, from those on unitSphere() in a fluid
/// with the viscosity over R: with lengths in radii forces grow by R^2, torques by R^3.
class WetSphereLoads final : public SurfaceLoads {
 public:
  WetSphereLoads(std::shared_ptr<const SurfaceLoads> on_unit, const FluidBody& sphere)
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
    for (const double entry : *column) {
      if (!std::isfinite(entry)) reject(body, "an entry of its faces", entry, "finite");
    }
  }
}

void checkFlow(const FluidBody& body, const FlowSettings& flow) {
  constexpr double kRounding = 1e-9;  // tolerance for angles typed with few digits
  if (!(flow.separation_angle >= kPi / 2 * (1 - kRounding)) ||
      !(flow.separation_angle <= kPi * (1 + kRounding))) {
    reject(body, "separation angle [rad]", flow.separation_angle, "between pi/2 and pi");
  }
  constexpr double kLongestLag = 1e6;  // keeps its products with the motion finite
  if (!(flow.stall_lag >= 0) || !(flow.stall_lag <= kLongestLag)) {
    reject(body, "stall lag [lengths over speed]", flow.stall_lag, "from 0 to 1e6");
  }
  if (!(flow.maximum_load_error >= 0)) {
    reject(body, "largest error of its loads", flow.maximum_load_error, "zero or positive");
  }
}

using Body = std::shared_ptr<const FluidBody>;

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
  if (best) return {body, &best->faces};
  return {body, &body->form.faces};
}

std::shared_ptr<const SurfaceLoads> loadsOn(const Body& body, const LoadTables::Faces& faces,
                                            const LoadSettings& settings, LoadPrecision precision) {
  const double length = referenceLength(*body);
  if (precision == LoadPrecision::kDouble)
    return std::make_shared<DoubleLoads>(faces, faces->size(), length, settings);
  return std::make_shared<SingleLoads>(LoadTables(body).packedFaces(faces, settings.shape), faces,
                                       length, settings);
}

std::shared_ptr<const SurfaceLoads> loadsOnFaces(const Body& body, LoadSettings settings,
                                                 const FlowSettings& flow) {
  if (body->faces.size() == 0) return nullptr;
  if (settings.law != PressureLaw::kForm)
    return loadsOn(body, {body, &body->faces}, settings, flow.precision);
  requirePrepared(*body);
  const LoadTables::Shape shape = LoadTables(body).shape();
  const LoadTables::Faces faces = chooseFormFaces(body, *shape, flow);
  settings.shape = shape.get();
  auto on_faces = loadsOn(body, faces, settings, flow.precision);
  return std::make_shared<FormLoads>(std::move(on_faces), *faces, shape, *body, settings,
                                     flow.stall_lag);
}

/// Spheres use the published law, but for the way of their wake.
LoadSettings ofBall(LoadSettings settings) {
  if (settings.law == PressureLaw::kForm) settings.wake_share = 1;
  settings.law = PressureLaw::kPublished;
  return settings;
}

/// Loads on faces. `settings` of a sphere: ofBall().
std::shared_ptr<const SurfaceLoads> waterlineLoadsOnFaces(const Body& body, LoadSettings settings,
                                                          const FlowSettings& flow) {
  const bool is_sphere = body->sphere_radius > 0;
  auto on_faces = loadsOnFaces(body, settings, flow);
  if (settings.separation_cosine != -1) return on_faces;
  if (settings.law == PressureLaw::kForm) {
    settings.separation_cosine = 0;
    auto separated = loadsOnFaces(body, settings, flow);
    return std::make_shared<AttachedFormLoads>(std::move(separated), std::move(on_faces));
  }
  settings.skin_friction = false;
  auto slip = loadsOnFaces(body, settings, flow);
  auto whole = is_sphere ? std::make_shared<SphereLoads>(*body, settings) : slip;
  return std::make_shared<AttachedLoads>(std::move(on_faces), std::move(slip), std::move(whole));
}

std::shared_ptr<const SurfaceLoads> lawOf(const Body& body, const LoadSettings& settings,
                                          const FlowSettings& flow) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  if (flow.own_law) return flow.own_law(body, settings);
  if (body->sphere_radius > 0) return std::make_shared<SphereLoads>(*body, ofBall(settings));
  return loadsOnFaces(body, settings, flow);
}

std::shared_ptr<const SurfaceLoads> waterlineLawOf(const Body& body, const LoadSettings& settings,
                                                   const FlowSettings& flow) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  FlowSettings on_all = flow;
  on_all.maximum_load_error = 0;
  if (!(body->sphere_radius > 0)) return waterlineLoadsOnFaces(body, settings, on_all);
  LoadSettings in_radii = ofBall(settings);
  in_radii.viscosity /= body->sphere_radius;
  return std::make_shared<WetSphereLoads>(waterlineLoadsOnFaces(unitSphere(), in_radii, on_all),
                                          *body);
}

// False for a medium without loads, and for one that later checks reject.
bool isFluid(const Medium& medium) { return medium.density > 0 && medium.viscosity >= 0; }

}  // namespace

LoadSettings loadSettings(const Medium& medium, const FlowSettings& flow) {
  return {medium.density, medium.viscosity, separationCosine(flow.separation_angle),
          flow.skin_friction, flow.law};
}

std::shared_ptr<const SurfaceLoads> makeSurfaceLoads(const std::shared_ptr<const FluidBody>& body,
                                                     const Medium& medium,
                                                     const FlowSettings& flow) {
  const LoadSettings settings = loadSettings(medium, flow);
  const auto make = [&] { return lawOf(body, settings, flow); };
  checkFlow(*body, flow);
  const bool is_shared = isFluid(medium) && !flow.own_law;
  return is_shared ? LoadTables(body).loads(medium, flow, LoadPlace::kUnbounded, make) : make();
}

std::shared_ptr<const SurfaceLoads> makeWaterlineLoads(const std::shared_ptr<const FluidBody>& body,
                                                       const Medium& medium,
                                                       const FlowSettings& flow) {
  const bool has_places = (body->faces.size() > 0 || body->sphere_radius > 0) && !flow.own_law;
  if (!has_places) return makeSurfaceLoads(body, medium, flow);
  const LoadSettings settings = loadSettings(medium, flow);
  const auto make = [&] { return waterlineLawOf(body, settings, flow); };
  checkFlow(*body, flow);
  return isFluid(medium) ? LoadTables(body).loads(medium, flow, LoadPlace::kWaterline, make)
                         : make();
}

}  // namespace ambient
