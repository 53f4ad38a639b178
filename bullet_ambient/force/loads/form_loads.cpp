#include "bullet_ambient/force/loads/form_loads.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/law/viscous_law.h"
#include "bullet_ambient/force/loads/face_loads.h"

namespace ambient {
namespace {

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
  const Resistance* resistance() const noexcept override { return resistance_; }
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

  const Resistance* resistance_ = nullptr;  ///< of the derived class; null: no friction

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
        centre_(body->centre_of_volume),
        still_axis_(axisOfRevolution(*body)),
        is_round_(!still_axis_.isZero(0)) {
    if (!(settings.viscosity > 0) || !body->viscous.isKnown()) return;
    Vector3 own_drag{0, 0, 0};
    if (!body->viscous.separation.smooth_base.isZero(0)) own_drag = LoadTables(body).ownDrag(faces);
    law_.emplace(*body, shape_->shape, own_drag, fluidOf(settings));
    if (settings.skin_friction) resistance_ = &law_->resistance();
  }

  /// Adds wings, which lift with the rest in place of the body as a whole.
  void add(LoadsOnWings wings) {
    wings_ = std::make_unique<const LoadsOnWings>(std::move(wings));
    lift_ = FormLift(LiftedPart{}, *shape_, 0);
  }

  int faces() const noexcept override {
    int faces = on_faces_->faces();
    if (wings_)
      for (const auto& wing : wings_->on_faces) faces += wing->faces();
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
      Parts parts{faces + share * atCentre(lift_.load(w, v, density_)), {}, {}};
      if (wings_) parts.pressure += wings_->lift.load(x, density_, {}, wet);
      return parts;
    }
    const ViscousLaw::Scalars s = law_->scalars(x);
    if (!s.moves) return {{}, {}, resistance_ ? inWater(kCreeping, wet) : Growth{}};
    const Wrench on_faces = drag_.scaled(withWings(pressure(s, x, v, wet), x, wet), x);
    Wrench whole = lift_.load(w, v, density_, s.munk);
    if (law_->isSmooth()) whole += law_->smoothLoad(s, w, v);
    Parts parts{s.pressure * on_faces + share * atCentre(whole), {}, {}};
    if (wings_) parts.pressure += wings_->lift.load(x, density_, {s.munk, s.pressure}, wet);
    if (!resistance_) return parts;
    if (law_->isSmooth()) parts.layer = share * atCentre({Vector3::Zero(), law_->layerForce(s, v)});
    parts.growth = inWater(law_->growth(s, share > 0 ? -power(on_faces, x) / share : 0), wet);
    return parts;
  }

 private:
  /// Pressure on the faces. That on a body of revolution neither sees its spin nor changes it,
  /// docs/theory.md eq. (66b).
  Wrench onFaces(const Twist& x, const WetPart* wet) const noexcept {
    if (!is_round_) return sumOnFaces(x, wet);
    const Vector3 spin = still_axis_.dot(x.angular) * still_axis_;
    Wrench load = sumOnFaces({x.angular - spin, x.linear + spin.cross(centre_)}, wet);
    load.torque -= still_axis_.dot(load.torque - centre_.cross(load.force)) * still_axis_;
    return load;
  }
  Wrench sumOnFaces(const Twist& x, const WetPart* wet) const noexcept {
    return wet ? on_faces_->wetLoad(x, *wet) : on_faces_->load(x);
  }
  Wrench withWings(Wrench load, const Twist& x, const WetPart* wet) const noexcept {
    if (!wings_) return load;
    for (std::size_t i = 0; i < wings_->on_faces.size(); ++i) {
      const SurfaceLoads& wing = *wings_->on_faces[i];
      const Twist seen = wings_->lift.seenBy(i, x, wet);
      const Wrench on_wing = wet ? wing.wetLoad(seen, *wet) : wing.load(seen);
      load += on_wing + wings_->lift.bySection(i, seen, density_, wet, on_wing);
    }
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
  Vector3 still_axis_;                         ///< of a body of revolution, unit; else 0
  bool is_round_;                              ///< there is such an axis
  std::optional<ViscousLaw> law_;              ///< none: no viscosity
  std::unique_ptr<const LoadsOnWings> wings_;  ///< null: the body is one part
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
  Resistance of_ball_;
};

}  // namespace

std::shared_ptr<const SurfaceLoads> makeFormLoads(std::shared_ptr<const SurfaceLoads> on_faces,
                                                  const LoadTables::Faces& faces,
                                                  const LoadTables::Body& body,
                                                  const LoadSettings& settings, double stall_lag,
                                                  std::optional<LoadsOnWings> wings) {
  auto loads = std::make_shared<FormLoads>(std::move(on_faces), faces, body, settings, stall_lag);
  if (wings) loads->add(*std::move(wings));
  return loads;
}

std::shared_ptr<const SurfaceLoads> makeBallLoads(std::shared_ptr<const SurfaceLoads> on_unit,
                                                  const FluidBody& ball,
                                                  const LoadSettings& settings) {
  return std::make_shared<BallLoads>(std::move(on_unit), ball, settings);
}

}  // namespace ambient
