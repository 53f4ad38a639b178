#include "bullet_ambient/force/loads/foils.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/form_loads.h"
#include "bullet_ambient/force/medium/input_checks.h"

namespace ambient {
namespace {

template <class... Parts>
[[noreturn]] void refuseFoil(std::size_t index, const Parts&... parts) {
  refuseInput("foil ", index, ": its ", parts...);
}

void checkPolar(const std::vector<FoilPoint>& polar, std::size_t index) {
  if (polar.empty()) return;
  constexpr double kTyped = 1e-6;  // tolerance for angles typed with few digits
  const double first = polar.front().incidence, last = polar.back().incidence;
  const bool is_whole = std::abs(first + kPi) < kTyped || first == 0;
  if (!is_whole || !(std::abs(last - kPi) < kTyped) || polar.size() < 2)
    refuseFoil(index, "polar is from ", first, " to ", last,
               " rad; must be from -pi, or from 0, to pi");
  for (std::size_t i = 0; i < polar.size(); ++i) {
    const FoilPoint& point = polar[i];
    if (i > 0 && !(point.incidence > polar[i - 1].incidence))
      refuseFoil(index, "polar has the incidence ", point.incidence, " after ",
                 polar[i - 1].incidence, " rad; must be above that");
    if (!std::isfinite(point.lift)) refuseFoil(index, "polar has a lift that is not finite");
    if (!(point.drag >= 0) || !std::isfinite(point.drag))
      refuseFoil(index, "polar has the drag ", point.drag, "; must be >= 0");
  }
}

void checkFoil(const Foil& foil, std::size_t index) {
  const auto require = [&](const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most) || !std::isfinite(value))
      refuseFoil(index, what, " is ", value, "; must be from ", least, " to ", most);
  };
  const auto requireLength = [&](const char* what, double value) {
    if (!(value > 0) || !std::isfinite(value))
      refuseFoil(index, what, " is ", value, " m; must be above 0");
  };
  requireLength("span", foil.span);
  requireLength("chord", foil.chord);
  if (!foil.position.allFinite()) refuseFoil(index, "position is not finite");
  const double size = foil.chord_axis.norm() * foil.span_axis.norm();
  constexpr double kLeastSine = 1e-3;
  if (!(foil.chord_axis.cross(foil.span_axis).norm() > kLeastSine * size))
    refuseFoil(index, "chord_axis and span_axis are along one line");
  require("thickness", foil.thickness, 0, 0.3 * foil.chord);
  require("camber", foil.camber, -kMostCamber, kMostCamber);
  require("drag", foil.drag, 0, kLargestDrag);
  require("aspect", foil.aspect, 0, kLargestDrag);
  checkPolar(foil.polar, index);
}

Wing wingOf(const Foil& foil) {
  Wing wing;
  wing.span = foil.span;
  wing.chord = foil.chord;
  wing.thickness = foil.thickness;
  wing.aspect = foil.aspect > 0 ? foil.aspect : foil.span / foil.chord;
  wing.camber = foil.camber;
  constexpr double kThinnest = 0.04;  // of the chord: a thicker foil has a round nose
  wing.nose = foil.thickness > kThinnest * foil.chord ? 1 : 0;
  return wing;
}

/// A body that is nothing but this foil, in the foil's frame.
std::shared_ptr<const FluidBody> bodyOf(const Foil& foil, const Wing& wing, double share) {
  auto body = std::make_shared<FluidBody>();
  body->name = "foil";
  body->volume = foil.span * foil.chord * foil.thickness;
  body->area = 2 * foil.span * foil.chord;
  body->added_mass(5, 5) = wing.plateMass();
  body->faces = plateFaces(wing);
  body->form.faces = body->faces;
  body->form.part_of_face.assign(body->faces.size(), 1);
  body->wings = {wing};
  body->form.wing_shares = {share};
  return body;
}

/// Per unit density, without viscosity.
std::shared_ptr<const SurfaceLoads> lawOfWing(const Foil& foil, const Wing& wing, double share) {
  FlowSettings flow;
  flow.skin_friction = false;
  return makeWaterlineLoads(bodyOf(foil, wing, share), {1, 0, {}, {}}, flow);
}

}  // namespace

Foils::Placed Foils::place(const Foil& foil, std::size_t index) {
  checkFoil(foil, index);
  const Wing wing = wingOf(foil);
  const double share = wingShare(wing, foil.span * foil.chord * foil.thickness, 1);
  Placed placed{foil, 0, {}, {}, ShapeFactors(wing, share), nullptr, {}, wing.plateMass() / 2};
  if (foil.polar.empty()) placed.law = lawOfWing(foil, wing, share);
  placed.halves =
      halvesOf(Vector3::Zero(), foil.span * Vector3::UnitY(), foil.chord * Vector3::UnitX());
  const Vector3 x = foil.chord_axis.normalized();
  const Vector3 z = x.cross(foil.span_axis).normalized();
  placed.axes.col(0) = x;
  placed.axes.col(1) = z.cross(x);
  placed.axes.col(2) = z;
  placed.pose = {placed.axes, foil.position};
  return placed;
}

Foils::Foils(const std::vector<Foil>& foils) {
  for (const Foil& foil : foils) placed_.push_back(place(foil, placed_.size()));
}

void Foils::turn(std::size_t index, double angle) {
  if (!std::isfinite(angle)) refuseFoil(index, "angle is not finite");
  Placed& placed = placed_.at(index);
  placed.angle = angle;
  const auto [sine, cosine] = portable::sineAndCosine(angle);
  Matrix3 turn = Matrix3::Identity();  // about y
  turn(0, 0) = turn(2, 2) = cosine;
  turn(0, 2) = sine;
  turn(2, 0) = -sine;
  placed.pose.rotation = placed.axes * turn;
}

// Eq. (168), per unit rho/2 and area. `u`: velocity of the foil there, in its frame.
Vector3 Foils::byPolar(const Foil& foil, const Vector3& u) noexcept {
  const std::vector<FoilPoint>& polar = foil.polar;
  const double incidence = portable::atan2(-u.z(), u.x());
  const bool is_mirrored = incidence < 0 && polar.front().incidence == 0;
  const double at = is_mirrored ? -incidence : incidence;
  std::size_t i = 1;
  while (i + 1 < polar.size() && at > polar[i].incidence) ++i;
  const FoilPoint &a = polar[i - 1], &b = polar[i];
  const double share = std::clamp((at - a.incidence) / (b.incidence - a.incidence), 0.0, 1.0);
  const double lift = a.lift + share * (b.lift - a.lift);
  const double drag = a.drag + share * (b.drag - a.drag);
  const double speed = std::sqrt(u.x() * u.x() + u.z() * u.z());
  const Vector3 along(u.x(), 0, u.z()), across(-u.z(), 0, u.x());
  return speed * ((is_mirrored ? -lift : lift) * across - drag * along);
}

// Drag of the profile of half of a foil, eq. (167), and what its added mass lacks in K: Munk's
// moment, of which the law of wings takes a share, eq. (169).
Wrench Foils::atStation(const Placed& placed, const Vector3& station, const Twist& x) noexcept {
  const Foil& foil = placed.foil;
  const Vector3 u = x.at(station);
  const double half = foil.span * foil.chord / 4;  // rho/2 of half of the area
  if (!placed.law) return Wrench::ofForceAt(half * byPolar(foil, u), station);
  const Vector3 in_plane(u.x(), u.y(), 0), impulse(0, 0, placed.mass * u.z());
  const Vector3 drag = -foil.drag * in_plane.norm() * in_plane;
  Wrench load = Wrench::ofForceAt(half * drag + impulse.cross(x.angular), station);
  load.torque += impulse.cross(u);
  return load;
}

Wrench Foils::load(std::size_t index, const Twist& x, double density,
                   const WetPart* wet) const noexcept {
  const Placed& placed = placed_[index];
  const Twist seen = placed.pose.toF(x);
  std::optional<SurfaceElsewhere> surface;
  std::optional<WetPart> part;
  if (wet) {
    surface.emplace(seenFrom(wet->plane, placed.pose), placed.pose);
    part = WetPart{surface->plane, wet->share};
  }
  Wrench sum;
  if (placed.law) sum = part ? placed.law->wetLoad(seen, *part) : placed.law->load(seen);
  for (const WingHalf& half : placed.halves) {
    const double share = part ? half.wetShare(*part) : 1;
    if (share > 0) sum += share * atStation(placed, half.station, seen);
  }
  return density * placed.pose.toB(sum);
}

Wrench Foils::load(const Twist& x, double density, const WetPart* wet) const noexcept {
  Wrench sum;
  for (std::size_t i = 0; i < placed_.size(); ++i) sum += load(i, x, density, wet);
  return sum;
}

double Foils::reachFrom(const Vector3& point) const noexcept {
  double reach = 0;
  for (const Placed& placed : placed_) {
    const double half =
        std::sqrt(placed.foil.span * placed.foil.span + placed.foil.chord * placed.foil.chord) / 2;
    reach = std::max(reach, (placed.foil.position - point).norm() + half);
  }
  return reach;
}

namespace {

FrameOffset inversePose(const FrameOffset& pose) {
  const Matrix3 back = pose.rotation.transpose();
  return {back, -(back * pose.translation)};
}

/// Stands for the loads on a body that has none.
class NoLoads final : public LoadsOnPart {
 public:
  FaceLoads partsOn(const Twist&, const WetPart*) const noexcept override { return {}; }
  bool needsGuard() const noexcept override { return false; }
};

/// Loads on a body and its foils, in the frame of the loads on the body.
class WithFoils final : public LoadsOnPart {
 public:
  WithFoils(std::shared_ptr<const SurfaceLoads> on_body, std::shared_ptr<const Foils> foils,
            double density)
      : on_body_(std::move(on_body)),
        foils_(std::move(foils)),
        density_(density),
        pose_(inversePose(on_body_->frame({}))) {}

  Wrench sumOn(const Twist& x, const WetPart* wet) const noexcept override {
    return (wet ? on_body_->wetLoad(x, *wet) : on_body_->load(x)) + onFoils(x, wet);
  }
  FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept override {
    FaceLoads parts = wet ? on_body_->wetParts(x, *wet) : on_body_->parts(x);
    parts.pressure += onFoils(x, wet);
    return parts;
  }
  SplitLoad split(const Twist& x, const WetPart* wet) const noexcept override {
    SplitLoad split = on_body_->split(x, wet);
    split.wrench += onFoils(x, wet);
    return split;
  }
  const Resistance* resistance() const noexcept override { return on_body_->resistance(); }
  int faces() const noexcept override { return on_body_->faces(); }
  bool needsGuard() const noexcept override { return on_body_->needsGuard(); }
  double wakeShare() const noexcept override { return on_body_->wakeShare(); }
  FrameOffset frame(const FrameOffset& fluid_frame) const override {
    return on_body_->frame(fluid_frame);
  }

 private:
  Wrench onFoils(const Twist& x, const WetPart* wet) const noexcept {
    if (!wet) return pose_.toB(foils_->load(pose_.toF(x), density_, nullptr));
    const WetPart seen{seenFrom(wet->plane, pose_), wet->share};
    return pose_.toB(foils_->load(pose_.toF(x), density_, &seen));
  }

  std::shared_ptr<const SurfaceLoads> on_body_;
  std::shared_ptr<const Foils> foils_;
  double density_;
  FrameOffset pose_;  ///< of F in the frame of on_body_
};

}  // namespace

std::shared_ptr<const SurfaceLoads> addFoils(std::shared_ptr<const SurfaceLoads> on_body,
                                             std::shared_ptr<const Foils> foils, double density) {
  if (!on_body) on_body = std::make_shared<NoLoads>();
  return std::make_shared<WithFoils>(std::move(on_body), std::move(foils), density);
}

}  // namespace ambient
