#include "preprocess/potential_flow/results/added_mass_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

constexpr std::size_t kMostParts = 96;

Vector6 productsOf(const Vector3& r) {
  Vector6 products;
  products << r.x() * r.x(), r.y() * r.y(), r.z() * r.z(), r.x() * r.y(), r.x() * r.z(),
      r.y() * r.z();
  return products;
}

using Panels = std::vector<PanelInertia>;

/// Panels that become a part, or are divided.
struct Patch {
  std::vector<std::size_t> panels;
  Eigen::Index axis = 0;  ///< the widest of their coordinates
  double middle = 0;      ///< of it
  double weight = 0;      ///< how much there is to be gained by dividing it
};

using Coordinates = std::vector<Vector6>;  // of panels

/// Normals first: what faces up and what faces aside do not mix.
Vector6 coordinatesOf(const Vector3& normal, const Vector3& centroid, double size) {
  return stack(2 * normal, centroid / size);
}

Patch patchOf(const Panels& panels, const Coordinates& places, std::vector<std::size_t> chosen) {
  Patch patch;
  Vector6 low = places[chosen.front()], high = low;
  double area = 0;
  for (const std::size_t i : chosen) {
    low = low.cwiseMin(places[i]);
    high = high.cwiseMax(places[i]);
    area += panels[i].area;
  }
  const double width = (high - low).maxCoeff(&patch.axis);
  patch.middle = 0.5 * (low[patch.axis] + high[patch.axis]);
  patch.weight = area * width * width;
  patch.panels = std::move(chosen);
  return patch;
}

/// Divides the patch with the largest weight in the middle, again and again, into up to
/// `most_patches`.
std::vector<Patch> dividedPatches(const Panels& panels, const Coordinates& places,
                                  std::size_t most_patches) {
  std::vector<std::size_t> all(panels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Patch> patches{patchOf(panels, places, std::move(all))};
  while (patches.size() < most_patches) {
    const auto most =
        std::max_element(patches.begin(), patches.end(),
                         [](const Patch& a, const Patch& b) { return a.weight < b.weight; });
    if (!(most->weight > 0)) break;
    std::vector<std::size_t> halves[2];
    for (const std::size_t i : most->panels)
      halves[places[i][most->axis] > most->middle].push_back(i);
    if (halves[0].empty() || halves[1].empty()) {  // as wide as rounding
      most->weight = 0;
      continue;
    }
    *most = patchOf(panels, places, std::move(halves[0]));
    patches.push_back(patchOf(panels, places, std::move(halves[1])));
  }
  return patches;
}

AddedMassPart join(const Panels& panels, const std::vector<std::size_t>& chosen) {
  AddedMassPart part;
  double area = 0;
  for (const std::size_t i : chosen) area += panels[i].area;
  AMBIENT_ASSERT(area > 0);
  for (const std::size_t i : chosen) part.centre += panels[i].area / area * panels[i].centroid;
  for (const std::size_t i : chosen) {
    const PanelInertia& panel = panels[i];
    part.spread += panel.area / area * (panel.spread + productsOf(panel.centroid - part.centre));
    part.inertia += 0.5 * (panel.inertia + panel.inertia.transpose());
  }
  return part;
}

template <class Values>
void roundToSingle(Values& values) {
  for (double& value : values.reshaped()) value = roundedToSingle(value);
}

double sizeOf(const Panels& panels) {
  double size = 0;
  for (const PanelInertia& panel : panels)
    size = std::max(size, panel.centroid.cwiseAbs().maxCoeff());
  return size > 0 ? size : 1;
}

/// Joins panels whose places are alike into parts.
std::vector<AddedMassPart> joined(const Panels& panels, const Coordinates& places,
                                  std::size_t most_parts) {
  std::vector<AddedMassPart> parts;
  for (const Patch& patch : dividedPatches(panels, places, most_parts))
    parts.push_back(join(panels, patch.panels));
  return parts;
}

struct Axis {
  Vector3 point, direction;
};

/// Whether the surface about an axis through the centroid is one of revolution: spin moves next to
/// no panel along its normal, and the distance from the axis is alike all around, as seen by its
/// first harmonics. A flat plate, whatever its outline, meets the first alone.
bool isRoundAbout(const Vector3& axis, const Vector3& centroid, const Panels& panels) {
  constexpr double kRound = 0.01;  // polygon of 16 sides: 0.013, of 24: 0.006
  constexpr int kHarmonics = 6;
  const Vector3 first = axis.unitOrthogonal(), second = axis.cross(first);
  double along = 0, all = 0;
  std::complex<double> harmonics[kHarmonics] = {};
  for (const PanelInertia& panel : panels) {
    const Vector3 r = panel.centroid - centroid;
    const std::complex<double> way(first.dot(r), second.dot(r));
    const double square = std::norm(way);
    const double speed = panel.normal.dot(axis.cross(r));  // of unit spin, along the normal
    along += panel.area * speed * speed;
    all += panel.area * square;
    if (!(square > 0)) continue;
    const std::complex<double> direction = way / std::sqrt(square);
    std::complex<double> turning = panel.area * square;
    for (std::complex<double>& harmonic : harmonics) harmonic += turning *= direction;
  }
  return along < kRound * all &&
         std::all_of(harmonics, harmonics + kHarmonics,
                     [&](const auto& harmonic) { return std::abs(harmonic) < kRound * all; });
}

/// Finds the principal axis that a surface is one of revolution about; a ball has none.
std::optional<Axis> axisOf(const Panels& panels) {
  double area = 0;
  Vector3 centroid = Vector3::Zero();
  for (const PanelInertia& panel : panels) {
    area += panel.area;
    centroid += panel.area * panel.centroid;
  }
  centroid /= area;
  Matrix3 squares = Matrix3::Zero();
  for (const PanelInertia& panel : panels) {
    const Vector3 r = panel.centroid - centroid;
    squares += panel.area * r * r.transpose();
  }
  const Matrix3 axes = symmetricEigen<3>(squares).vectors;
  std::optional<Axis> found;
  for (int i = 0; i < 3; ++i) {
    if (!isRoundAbout(axes.col(i), centroid, panels)) continue;
    if (found) return std::nullopt;
    found = Axis{centroid, axes.col(i)};
  }
  return found;
}

Vector6 productsTurned(const Vector6& products, const Matrix3& turn) {
  Matrix3 square;
  square << products[0], products[3], products[4], products[3], products[1], products[5],
      products[4], products[5], products[2];
  square = turn * square * turn.transpose();
  Vector6 turned;
  turned << square(0, 0), square(1, 1), square(2, 2), square(0, 1), square(0, 2), square(1, 2);
  return turned;
}

constexpr int kSectors = 12;

/// Turn about an axis through the origin.
Matrix3 turnAbout(const Vector3& axis, double angle) {
  const double cosine = portable::cos(angle), sine = portable::sin(angle);
  return cosine * Matrix3::Identity() + sine * crossMatrix(axis) +
         (1 - cosine) * axis * axis.transpose();
}

/// Turns by multiples of the angle between sectors.
std::vector<Matrix3> turnsAbout(const Vector3& axis) {
  std::vector<Matrix3> turns;
  for (int k = 0; k < kSectors; ++k) turns.push_back(turnAbout(axis, 2 * kPi * k / kSectors));
  return turns;
}

/// Rings of alike parts. All panels are turned into one sector, each with its share of them all,
/// and divided by where they are along the meridian.
std::vector<AddedMassPart> joinedAbout(const Axis& axis, const Panels& panels) {
  const std::vector<Matrix3> turns = turnsAbout(axis.direction);
  const Vector3 first = axis.direction.unitOrthogonal(), second = axis.direction.cross(first);
  // Takes the spin about the axis out of a motion about the point of the axis.
  Matrix6 rest = Matrix6::Identity();
  rest.topLeftCorner<3, 3>() -= axis.direction * axis.direction.transpose();
  const double size = sizeOf(panels);
  Panels folded;
  Coordinates on_meridian;
  folded.reserve(panels.size());
  on_meridian.reserve(panels.size());
  for (PanelInertia panel : panels) {
    const Vector3 way = panel.centroid - axis.point;
    const double angle = portable::atan2(second.dot(way), first.dot(way));
    const Matrix3 to_meridian = turnAbout(axis.direction, -angle);
    on_meridian.push_back(coordinatesOf(to_meridian * panel.normal, to_meridian * way, size));
    const int sector = static_cast<int>(std::lround(angle / (2 * kPi) * kSectors));
    const Matrix3& back = turns[static_cast<std::size_t>((kSectors - sector) % kSectors)];
    panel.normal = back * panel.normal;
    panel.centroid = back * way;
    panel.spread = productsTurned(panel.spread, back);
    const Matrix6 about_axis = rest * shiftOrigin(panel.inertia, axis.point) * rest;
    panel.inertia = rotateAxes(about_axis, back) / kSectors;
    folded.push_back(panel);
  }
  std::vector<AddedMassPart> parts;
  for (const AddedMassPart& part : joined(folded, on_meridian, kMostParts / kSectors))
    for (const Matrix3& turn : turns) {
      AddedMassPart& copy = parts.emplace_back();
      copy.centre = turn * part.centre + axis.point;
      copy.spread = productsTurned(part.spread, turn);
      copy.inertia = shiftOrigin(rotateAxes(part.inertia, turn), -axis.point);
    }
  return parts;
}

}  // namespace

std::vector<AddedMassPart> joinPanels(const std::vector<PanelInertia>& panels) {
  if (panels.empty()) return {};
  if (const std::optional<Axis> axis = axisOf(panels)) return joinedAbout(*axis, panels);
  const double size = sizeOf(panels);
  Coordinates places;
  places.reserve(panels.size());
  for (const PanelInertia& panel : panels)
    places.push_back(coordinatesOf(panel.normal, panel.centroid, size));
  return joined(panels, places, kMostParts);
}

namespace {

/// Returns the parts in the first octant, or what the turned axes leave of one, with all images.
std::vector<AddedMassPart> imagesOfFirst(const std::vector<AddedMassPart>& parts, int mirrors,
                                         double rounding) {
  std::vector<AddedMassPart> images;
  for (AddedMassPart part : parts) {
    int apart = 0;  // axes whose planes do not go through the part
    bool is_first = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(mirrors >> axis & 1)) continue;
      is_first = is_first && part.centre[axis] > -rounding;
      if (part.centre[axis] > rounding) apart |= 1 << axis;
      if (part.centre[axis] > rounding) continue;
      const AddedMassPart image = imageOf(part, 1 << axis);
      part.centre = (part.centre + image.centre) / 2;
      part.spread = (part.spread + image.spread) / 2;
      part.inertia = (part.inertia + image.inertia) / 2;
    }
    for (int turned = 0; is_first && turned < 8; ++turned)
      if ((turned & apart) == turned) images.push_back(imageOf(part, turned));
  }
  return images;
}

}  // namespace

std::vector<AddedMassPart> mirrored(const std::vector<AddedMassPart>& parts) {
  constexpr double kRounding = 1e-5;
  double size = 0;
  for (const AddedMassPart& part : parts) size = std::max(size, part.centre.cwiseAbs().maxCoeff());
  const auto isThere = [&](const AddedMassPart& image) {
    return std::any_of(parts.begin(), parts.end(), [&](const AddedMassPart& part) {
      return (image.centre - part.centre).norm() <= kRounding * size &&
             (image.inertia - part.inertia).norm() <= kRounding * part.inertia.norm();
    });
  };
  for (const int mirrors : {7, 3, 5, 6, 1, 2, 4}) {
    std::vector<AddedMassPart> images = imagesOfFirst(parts, mirrors, kRounding * size);
    if (images.size() == parts.size() && std::all_of(images.begin(), images.end(), isThere))
      return images;
  }
  return parts;
}

std::vector<AddedMassPart> placed(std::vector<AddedMassPart> parts, double length,
                                  const Vector3& centre) {
  AMBIENT_ASSERT(length > 0 && centre.allFinite());
  for (AddedMassPart& part : parts) {
    part.centre = length * part.centre + centre;
    part.spread *= length * length;
    part.inertia = shiftOrigin(scaleShape(part.inertia, length), -centre);
    part.inertia = (0.5 * (part.inertia + part.inertia.transpose())).eval();
    roundToSingle(part.centre);
    roundToSingle(part.spread);
    roundToSingle(part.inertia);
  }
  return parts;
}

}  // namespace ambient
