#include "bullet_ambient/force/loads/form_loads.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/law/viscous_law.h"
#include "bullet_ambient/force/loads/face_loads.h"

namespace ambient {
namespace {

/// Loads of a law with viscosity, of which a derived class computes pressure and layers at once.
class ViscousLoads : public LoadsOnPart {
 public:
  FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept override {
    const Parts parts = compute(x, wet);
    if (!resistance_) return {parts.pressure, {}};
    return {parts.pressure, parts.layer + resistance_->load(parts.growth, x)};
  }
  SplitLoad split(const Twist& x, const WetPart* wet) const noexcept override {
    const Parts parts = compute(x, wet);
    return {parts.pressure + parts.layer, parts.growth};
  }
  const Resistance* resistance() const noexcept override { return resistance_; }
  bool needsGuard() const noexcept override { return false; }

 protected:
  /// Pressure, friction of turbulent layers, and growth of the resistance.
  struct Parts {
    Wrench pressure, layer;
    Growth growth;
  };

  virtual Parts compute(const Twist& x, const WetPart* wet) const noexcept = 0;

  /// C becomes C times the share of the body in the fluid.
  static Growth inWater(const Growth& growth, const WetPart* wet) noexcept {
    const double root = wet ? std::sqrt(wet->share) : 1;
    return {root * growth.rotation, root * growth.translation};
  }

  const Resistance* resistance_ = nullptr;  ///< of the derived class; null: no friction
};

ViscousFluid fluidOf(const LoadSettings& settings) {
  return {settings.density, settings.viscosity, settings.roughness};
}

/// Scales the form law to measured drag coefficients, docs/theory.md eq. (51): the part of the
/// loads on faces that brakes the motion gets a positive factor, so that it still takes energy.
/// Lift stays. Frame F.
class DragScale {
 public:
  /// Cost O(F) where drag is measured. `faces`: those of all parts.
  DragScale(const LoadTables::Body& body, const LoadTables::Faces& faces)
      : is_measured_(!body->drag.isZero(0)),
        centre_(body->centre_of_volume),
        length_sq_(body->area) {
    if (!is_measured_) return;
    Vector3 frontal{0, 0, 0};  // half of the projected areas
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < faces->size(); ++i)
        frontal[axis] += 0.5 * faces->area[i] * std::abs(faces->normal(i)[axis]);
    const Vector3 drag = LoadTables(body).ownDrag(faces, Matrix3::Identity(), frontal);
    AMBIENT_ASSERT(drag.allFinite());
    for (int axis = 0; axis < 3; ++axis)
      if (drag[axis] > 0) scales_[axis] = body->drag[axis] / drag[axis];
  }

  /// Returns `load`, the load on the faces in a twist relative to the flow, with its drag scaled.
  Wrench scaled(const Wrench& load, const Twist& x) const noexcept {
    if (!is_measured_) return load;
    const Vector3 v = x.at(centre_), along = v.cwiseAbs2();
    const double turning = length_sq_ * x.angular.squaredNorm();
    const double sum = along.sum() + turning;
    if (!(sum > 0)) return load;
    const double factor = (scales_.dot(along) + scales_.mean() * turning) / sum;
    const double more = (factor - 1) * power(load, x) / sum;
    const Vector3 force = more * v;
    return load + Wrench{more * length_sq_ * x.angular + centre_.cross(force), force};
  }

 private:
  bool is_measured_;
  Vector3 scales_{1, 1, 1};  ///< sigma_j: measured coefficient over the law's own
  Vector3 centre_;           ///< centre of volume [m]
  double length_sq_;         ///< area in eq. (51) [m^2]
};

/// Form law: loads on faces, their drag scaled by DragScale, plus FormLift on the body as a whole;
/// with viscosity by ViscousLaw, docs/theory.md eq. (113). Of a body with wings these are loads on
/// its rest, and those on its wings are added, eq. (160).
class FormLoads final : public ViscousLoads {
 public:
  FormLoads(FaceSum on_faces, const LoadTables::Body& body, const LoadSettings& settings,
            double stall_lag, std::optional<LoadsOnWings> wings)
      : on_faces_(std::move(on_faces)),
        wings_(std::move(wings)),
        shape_(LoadTables(body).shape()),
        drag_(body, allFaces(body)),
        lift_(wings_ ? LiftedPart{}
                     : LiftedPart{body->added_mass.bottomRightCorner<3, 3>(), body->volume,
                                  body->area, body->centre_of_volume},
              *shape_, stall_lag),
        density_(settings.density),
        centre_(body->centre_of_volume),
        still_axis_(axisOfRevolution(*body)),
        is_round_(!still_axis_.isZero(0)) {
    if (!(settings.viscosity > 0) || !body->viscous.isKnown()) return;
    Vector3 own_drag{0, 0, 0};
    if (!body->viscous.separation.smooth_base.isZero(0))
      own_drag = LoadTables(body).ownDrag(allFaces(body));
    law_.emplace(*body, shape_->shape, own_drag, fluidOf(settings));
    if (settings.skin_friction) resistance_ = &law_->resistance();
  }

  int faces() const noexcept override {
    int faces = on_faces_.faces();
    if (wings_)
      for (const FaceSum& wing : wings_->on_faces) faces += wing.faces();
    return faces;
  }
  double wakeShare() const noexcept override { return shape_->wakeShare(); }
  bool needsGuard() const noexcept override { return wings_ && wings_->lift.hasWakes(); }

 protected:
  Parts compute(const Twist& x, const WetPart* wet) const noexcept override {
    const double share = wet ? wet->share : 1;
    const Vector3 &w = x.angular, v = x.at(centre_);
    if (!law_) {
      const Wrench faces = drag_.scaled(withWings(onFaces(x, wet), x, wet), x);
      Parts parts{faces + share * lift_.load(w, v, density_).aboutOrigin(centre_), {}, {}};
      if (wings_) parts.pressure += wings_->lift.load(x, density_, 1, 1, wet);
      return parts;
    }
    const ViscousLaw::Scalars s = law_->scalars(x);
    if (!s.moves) return {{}, {}, resistance_ ? inWater(kCreeping, wet) : Growth{}};
    const Wrench on_faces = drag_.scaled(withWings(pressure(s, x, v, wet), x, wet), x);
    Wrench whole = lift_.load(w, v, density_, s.munk);
    if (law_->isSmooth()) whole += law_->smoothLoad(s, w, v);
    Parts parts{s.pressure * on_faces + share * whole.aboutOrigin(centre_), {}, {}};
    if (wings_) parts.pressure += wings_->lift.load(x, density_, s.munk, s.pressure, wet);
    if (!resistance_) return parts;
    if (law_->isSmooth()) parts.layer = share * Wrench::ofForceAt(law_->layerForce(s, v), centre_);
    parts.growth = inWater(law_->growth(s, share > 0 ? -power(on_faces, x) / share : 0), wet);
    return parts;
  }

 private:
  /// Those of all parts.
  LoadTables::Faces allFaces(const LoadTables::Body& body) const {
    return wings_ ? LoadTables::Faces(body, &body->form.faces) : on_faces_.table();
  }
  /// Pressure on the faces. That on a body of revolution neither sees its spin nor changes it,
  /// docs/theory.md eq. (66b).
  Wrench onFaces(const Twist& x, const WetPart* wet) const noexcept {
    if (!is_round_) return on_faces_.sumOn(x, wet);
    const Vector3 spin = still_axis_.dot(x.angular) * still_axis_;
    Wrench load = on_faces_.sumOn({x.angular - spin, x.linear + spin.cross(centre_)}, wet);
    load.torque -= still_axis_.dot(load.torque - centre_.cross(load.force)) * still_axis_;
    return load;
  }
  Wrench withWings(Wrench load, const Twist& x, const WetPart* wet) const noexcept {
    if (!wings_) return load;
    for (std::size_t i = 0; i < wings_->on_faces.size(); ++i) {
      const Twist seen = wings_->lift.seenBy(i, x, wet);
      const Wrench on_wing = wings_->on_faces[i].sumOn(seen, wet);
      load += on_wing + wings_->lift.bySection(i, seen, density_, wet, on_wing);
    }
    return load;
  }
  /// F_P of eq. (111): S P(S x), with S about the centre of volume in the axes q_j. `v`: there.
  Wrench pressure(const ViscousLaw::Scalars& s, const Twist& x, const Vector3& v,
                  const WetPart* wet) const noexcept {
    if (!law_->isSmooth()) return onFaces(x, wet);
    const Matrix3 turning = law_->scaling(s.turning), moving = law_->scaling(s.moving);
    Twist seen{turning * x.angular, moving * v};
    seen.linear -= seen.angular.cross(centre_);
    const Wrench load = onFaces(seen, wet);
    return Wrench{turning * (load.torque - centre_.cross(load.force)), moving * load.force}
        .aboutOrigin(centre_);
  }

  FaceSum on_faces_;
  std::optional<LoadsOnWings> wings_;  ///< they lift with the rest in place of the body as a whole
  LoadTables::Shape shape_;
  DragScale drag_;
  FormLift lift_;
  double density_;
  Vector3 centre_;
  Vector3 still_axis_;             ///< of a body of revolution, unit; else 0
  bool is_round_;                  ///< there is such an axis
  std::optional<ViscousLaw> law_;  ///< none: no viscosity
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
    if (!settings.skin_friction || !(settings.viscosity > 0)) return;
    of_ball_ = ballResistance(radius_, settings.viscosity);
    resistance_ = &of_ball_;
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
      const SurfaceElsewhere surface(wet->plane, {Matrix3::Identity(), centre_}, radius_);
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
  Resistance of_ball_;
};

}  // namespace

FaceSum::FaceSum(const LoadTables::Body& body, LoadTables::Faces faces,
                 const LoadSettings& settings, LoadPrecision precision)
    : faces_(std::move(faces)), reference_length_(std::sqrt(body->area)), settings_(settings) {
  if (precision == LoadPrecision::kSingle)
    packed_ = LoadTables(body).packedFaces(faces_, settings.shape);
}

Wrench FaceSum::sumOn(const Twist& x, const WetPart* wet) const noexcept {
  const SurfacePlane* const plane = wet ? &wet->plane : nullptr;
  if (isInSingle(wet)) return computeFaceLoad(*packed_, reference_length_, x, settings_, plane);
  return computeFaceLoads(*faces_, reference_length_, x, settings_, plane).total();
}

FaceLoads FaceSum::partsOn(const Twist& x, const WetPart* wet) const noexcept {
  const SurfacePlane* const plane = wet ? &wet->plane : nullptr;
  if (!isInSingle(wet)) return computeFaceLoads(*faces_, reference_length_, x, settings_, plane);
  // Friction is what the sum lacks without it.
  LoadSettings smooth = settings_;
  smooth.skin_friction = false;
  const Wrench pressure = computeFaceLoad(*packed_, reference_length_, x, smooth, plane);
  return {pressure, sumOn(x, wet) + -1.0 * pressure};
}

std::shared_ptr<const SurfaceLoads> makeFormLoads(FaceSum on_faces, const LoadTables::Body& body,
                                                  const LoadSettings& settings, double stall_lag,
                                                  std::optional<LoadsOnWings> wings) {
  return std::make_shared<FormLoads>(std::move(on_faces), body, settings, stall_lag,
                                     std::move(wings));
}

std::shared_ptr<const SurfaceLoads> makeBallLoads(std::shared_ptr<const SurfaceLoads> on_unit,
                                                  const FluidBody& ball,
                                                  const LoadSettings& settings) {
  return std::make_shared<BallLoads>(std::move(on_unit), ball, settings);
}

}  // namespace ambient
