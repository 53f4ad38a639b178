#include "bullet_ambient/force/surface_loads.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/force/drag_scale.h"
#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/form_lift.h"
#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/sphere_loads.h"
#include "bullet_ambient/spatial/pi.h"

namespace ambient {
namespace {

/// The length in the Reynolds number, docs/theory.md eq. (16).
double referenceLength(const FluidBody& body) { return std::sqrt(body.area); }

/// Eq. (13) to (17) by one of the ways to sum them, below a plane or on all faces.
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
  int faces() const noexcept override { return faces_; }
  /// At alpha = pi/2 no face can push its body along: both laws are dissipative term by term.
  bool needsGuard() const noexcept override { return settings_.separation_cosine != 0; }

 protected:
  std::shared_ptr<const Table> table_;
  int faces_;
  double length_;
  LoadSettings settings_;
};

Wrench sumInDouble(const FaceTable& faces, double length, const Twist& x,
                   const LoadSettings& settings, const SurfacePlane* plane) noexcept {
  return computeFaceLoads(faces, length, x, settings, plane).total();
}

/// Clusters have no place: see LevelLoads::wetLoad().
Wrench sumClusters(const LoadLevel& level, double length, const Twist& x,
                   const LoadSettings& settings, const SurfacePlane*) noexcept {
  return computeLevelLoad(level, length, x, settings);
}

using SingleLoads = SummedLoads<PackedFaces, computeFaceLoad>;

struct DoubleLoads final : SummedLoads<FaceTable, sumInDouble> {
  using SummedLoads::SummedLoads;
  FaceLoads parts(const Twist& x) const noexcept override {
    return computeFaceLoads(*table_, length_, x, settings_);
  }
};

struct LevelLoads final : SummedLoads<LoadLevel, sumClusters> {
  using SummedLoads::SummedLoads;
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return wet.share * load(x);
  }
  bool needsGuard() const noexcept override { return true; }  // fitted wrenches may push
};

/// The form law: faces as above, and what acts on the body as a whole.
class FormLoads final : public SurfaceLoads {
 public:
  /// on_faces: of `faces`, which are kept for other media and settings of the shape.
  FormLoads(std::shared_ptr<const SurfaceLoads> on_faces, LoadTables::Faces faces,
            const FluidBody& body, double stall_lag, double density)
      : on_faces_(std::move(on_faces)),
        faces_(std::move(faces)),
        drag_(body, *faces_),
        lift_(body, stall_lag),
        density_(density) {}

  Wrench load(const Twist& x) const noexcept override {
    return drag_.factor(x) * on_faces_->load(x) + lift_.load(x, density_);
  }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return drag_.factor(x) * on_faces_->wetLoad(x, wet) + wet.share * lift_.load(x, density_);
  }
  FaceLoads parts(const Twist& x) const noexcept override {
    const FaceLoads parts = on_faces_->parts(x);
    const double factor = drag_.factor(x);
    return {factor * parts.pressure + lift_.load(x, density_), factor * parts.friction};
  }
  int faces() const noexcept override { return on_faces_->faces(); }
  bool needsGuard() const noexcept override { return on_faces_->needsGuard(); }

 private:
  std::shared_ptr<const SurfaceLoads> on_faces_;
  LoadTables::Faces faces_;
  DragScale drag_;
  FormLift lift_;
  double density_;
};

class SphereLoads final : public SurfaceLoads {
 public:
  SphereLoads(const FluidBody& body, const LoadSettings& settings, LoadTables& tables)
      : centre_(body.centre_of_volume),
        radius_(body.sphere_radius),
        length_(referenceLength(body)),
        settings_(settings) {
    if (needsSphereTable(settings)) table_ = tables.sphereTable(settings.separation_cosine);
  }

  Wrench load(const Twist& x) const noexcept override { return parts(x).total(); }
  FaceLoads parts(const Twist& x) const noexcept override {
    return computeSphereLoads(table_.get(), radius_, length_, x, settings_);
  }
  bool needsGuard() const noexcept override { return false; }
  /// At its centre; it looks the same in all axes.
  FrameOffset frame(const FrameOffset& fluid_frame) const override {
    return {Matrix3::Identity(), fluid_frame.rotation * centre_ + fluid_frame.translation};
  }

 private:
  Vector3 centre_;
  double radius_, length_;
  LoadSettings settings_;
  std::shared_ptr<const SphereTable> table_;  ///< null where it needs none
};

/// At alpha = pi the pressure on a part of a body is that of a flow that is attached everywhere,
/// which the inertia of the water has in it: docs/theory.md eq. (66), and on the whole of a body no
/// more than its share of the load in unbounded fluid.
class AttachedLoads final : public SurfaceLoads {
 public:
  /// on_faces: the law with this pressure; slip: the pressure alone; whole: that of a body in
  /// unbounded fluid.
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
  int faces() const noexcept override {
    return on_faces_->faces() + slip_->faces() + whole_->faces();
  }
  bool needsGuard() const noexcept override { return whole_->needsGuard(); }

 private:
  Wrench wholeLoad(const Twist& x) const noexcept {
    return whole_frame_.toB(whole_->load(whole_frame_.toF(x)));
  }

  std::shared_ptr<const SurfaceLoads> on_faces_, slip_, whole_;
  FrameOffset whole_frame_;
};

/// The form law at alpha = pi, whose lee feels the pressure of the slip besides its own: of that a
/// part of a body has its share of the whole, as by AttachedLoads.
class AttachedFormLoads final : public SurfaceLoads {
 public:
  /// Of the form law at alpha = pi/2, and at pi.
  AttachedFormLoads(std::shared_ptr<const SurfaceLoads> separated,
                    std::shared_ptr<const SurfaceLoads> attached)
      : separated_(std::move(separated)), attached_(std::move(attached)) {}

  Wrench load(const Twist& x) const noexcept override { return attached_->load(x); }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    const Wrench by_lee = attached_->load(x) + -1.0 * separated_->load(x);
    return separated_->wetLoad(x, wet) + wet.share * by_lee;
  }
  int faces() const noexcept override { return 2 * separated_->faces() + attached_->faces(); }
  bool needsGuard() const noexcept override { return attached_->needsGuard(); }

 private:
  std::shared_ptr<const SurfaceLoads> separated_, attached_;
};

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
  constexpr double kRounding = 1e-9;  // of an angle that was written by hand
  if (!(flow.separation_angle >= kPi / 2 * (1 - kRounding)) ||
      !(flow.separation_angle <= kPi * (1 + kRounding))) {
    reject(body, "separation angle [rad]", flow.separation_angle, "between pi/2 and pi");
  }
  if (!(flow.stall_lag >= 0) || !std::isfinite(flow.stall_lag)) {
    reject(body, "stall lag [lengths over speed]", flow.stall_lag, "zero or positive and finite");
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

using Body = std::shared_ptr<const FluidBody>;

// Those that the form law is summed over: of the smallest level that keeps the allowed error, or
// all.
LoadTables::Faces chooseFormFaces(const Body& body, const FlowSettings& flow, LoadTables& tables) {
  const FormLevel* best = nullptr;
  for (const FormLevel& level : body->form_levels)
    if (level.p99_error <= flow.maximum_load_error &&
        (!best || level.faces.size() < best->faces.size()))
      best = &level;
  if (best) return {body, &best->faces};
  return tables.formFaces(body);
}

std::shared_ptr<const SurfaceLoads> loadsOn(const LoadTables::Faces& faces, double length,
                                            const LoadSettings& settings, LoadPrecision precision,
                                            LoadTables& tables) {
  const std::size_t count = faces->size();
  if (precision == LoadPrecision::kDouble)
    return std::make_shared<DoubleLoads>(faces, count, length, settings);
  return std::make_shared<SingleLoads>(tables.packedFaces(faces, settings.law), count, length,
                                       settings);
}

std::shared_ptr<const SurfaceLoads> loadsOnFaces(const Body& body, const LoadSettings& settings,
                                                 const FlowSettings& flow, LoadTables& tables) {
  if (body->faces.size() == 0) return nullptr;
  const double length = referenceLength(*body);
  if (settings.law == PressureLaw::kPublished)
    return loadsOn({body, &body->faces}, length, settings, flow.precision, tables);
  const LoadTables::Faces faces = chooseFormFaces(body, flow, tables);
  auto on_faces = loadsOn(faces, length, settings, flow.precision, tables);
  return std::make_shared<FormLoads>(std::move(on_faces), faces, *body, flow.stall_lag,
                                     settings.density);
}

/// On faces, a sphere by the law of SphereLoads.
std::shared_ptr<const SurfaceLoads> waterlineLoadsOnFaces(const Body& body, LoadSettings settings,
                                                          const FlowSettings& flow,
                                                          LoadTables& tables) {
  const bool is_sphere = body->sphere_radius > 0;
  if (is_sphere) settings.law = PressureLaw::kPublished;
  auto on_faces = loadsOnFaces(body, settings, flow, tables);
  if (settings.separation_cosine != -1) return on_faces;
  if (settings.law == PressureLaw::kForm) {
    settings.separation_cosine = 0;
    auto separated = loadsOnFaces(body, settings, flow, tables);
    return std::make_shared<AttachedFormLoads>(std::move(separated), std::move(on_faces));
  }
  settings.skin_friction = false;
  auto slip = loadsOnFaces(body, settings, flow, tables);
  auto whole = is_sphere ? std::make_shared<SphereLoads>(*body, settings, tables) : slip;
  return std::make_shared<AttachedLoads>(std::move(on_faces), std::move(slip), std::move(whole));
}

std::shared_ptr<const SurfaceLoads> lawOf(const Body& body, const LoadSettings& settings,
                                          const FlowSettings& flow, LoadTables& tables) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  if (flow.own_law) return flow.own_law(body, settings);
  if (body->sphere_radius > 0) return std::make_shared<SphereLoads>(*body, settings, tables);
  if (flow.law == PressureLaw::kPublished)
    if (const LoadLevel* level = chooseLevel(*body, flow))
      return std::make_shared<LevelLoads>(std::shared_ptr<const LoadLevel>(body, level),
                                          level->clusters, referenceLength(*body), settings);
  return loadsOnFaces(body, settings, flow, tables);
}

std::shared_ptr<const SurfaceLoads> waterlineLawOf(const Body& body, const LoadSettings& settings,
                                                   const FlowSettings& flow, LoadTables& tables) {
  checkFaces(*body);
  if (!(settings.density > 0)) return nullptr;
  FlowSettings on_all = flow;
  on_all.maximum_load_error = 0;
  return waterlineLoadsOnFaces(body, settings, on_all, tables);
}

// A medium that is no fluid has no loads, or is refused later.
bool isFluid(const Medium& medium) { return medium.density > 0 && medium.viscosity >= 0; }

}  // namespace

LoadSettings loadSettings(const Medium& medium, const FlowSettings& flow) {
  return {medium.density, medium.viscosity, separationCosine(flow.separation_angle),
          flow.skin_friction, flow.law};
}

std::shared_ptr<const SurfaceLoads> makeSurfaceLoads(const std::shared_ptr<const FluidBody>& body,
                                                     const Medium& medium, const FlowSettings& flow,
                                                     LoadTables& tables) {
  const LoadSettings settings = loadSettings(medium, flow);
  const auto make = [&] { return lawOf(body, settings, flow, tables); };
  checkFlow(*body, flow);
  const bool is_shared = isFluid(medium) && !flow.own_law;
  return is_shared ? tables.loads(body, medium, flow, LoadPlace::kUnbounded, make) : make();
}

std::shared_ptr<const SurfaceLoads> makeWaterlineLoads(const std::shared_ptr<const FluidBody>& body,
                                                       const Medium& medium,
                                                       const FlowSettings& flow,
                                                       LoadTables& tables) {
  const bool has_places = body->faces.size() > 0 && !flow.own_law;
  if (!has_places) return makeSurfaceLoads(body, medium, flow, tables);
  const LoadSettings settings = loadSettings(medium, flow);
  const auto make = [&] { return waterlineLawOf(body, settings, flow, tables); };
  checkFlow(*body, flow);
  return isFluid(medium) ? tables.loads(body, medium, flow, LoadPlace::kWaterline, make) : make();
}

}  // namespace ambient
