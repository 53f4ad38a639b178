#include "preprocess/potential_flow/results/added_mass_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/single_precision.h"
#include "bullet_ambient/spatial/cholesky.h"
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

/// Normals first: what faces up and what faces aside do not mix.
Vector6 coordinatesOf(const PanelInertia& panel, double size) {
  return stack(2 * panel.normal, panel.centroid / size);
}

Patch patchOf(const Panels& panels, std::vector<std::size_t> chosen, double size) {
  Patch patch;
  Vector6 low = coordinatesOf(panels[chosen.front()], size), high = low;
  double area = 0;
  for (const std::size_t i : chosen) {
    const Vector6 at = coordinatesOf(panels[i], size);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    area += panels[i].area;
  }
  const double width = (high - low).maxCoeff(&patch.axis);
  patch.middle = 0.5 * (low[patch.axis] + high[patch.axis]);
  patch.weight = area * width * width;
  patch.panels = std::move(chosen);
  return patch;
}

/// Divides the patch with the largest weight in the middle, again and again.
std::vector<Patch> dividedPatches(const Panels& panels, double size) {
  std::vector<std::size_t> all(panels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Patch> patches{patchOf(panels, std::move(all), size)};
  while (patches.size() < kMostParts) {
    const auto most =
        std::max_element(patches.begin(), patches.end(),
                         [](const Patch& a, const Patch& b) { return a.weight < b.weight; });
    if (!(most->weight > 0)) break;
    std::vector<std::size_t> halves[2];
    for (const std::size_t i : most->panels)
      halves[coordinatesOf(panels[i], size)[most->axis] > most->middle].push_back(i);
    if (halves[0].empty() || halves[1].empty()) {  // as wide as rounding
      most->weight = 0;
      continue;
    }
    *most = patchOf(panels, std::move(halves[0]), size);
    patches.push_back(patchOf(panels, std::move(halves[1]), size));
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

}  // namespace

std::vector<AddedMassPart> joinPanels(const std::vector<PanelInertia>& panels) {
  double size = 0;
  for (const PanelInertia& panel : panels)
    size = std::max(size, panel.centroid.cwiseAbs().maxCoeff());
  std::vector<AddedMassPart> parts;
  if (panels.empty()) return parts;
  for (const Patch& patch : dividedPatches(panels, size > 0 ? size : 1))
    parts.push_back(join(panels, patch.panels));
  return parts;
}

std::vector<AddedMassPart> withoutStillMotions(std::vector<AddedMassPart> parts,
                                               const Matrix6& added_mass,
                                               const Matrix6& displaced) {
  constexpr double kStill = 1e-3;
  const Cholesky<6> factor(displaced);
  AMBIENT_ASSERT(factor.isPositive());
  const Matrix6 to_motion = factor.inverseTransposed();  // of a motion in units of M
  const SymmetricEigen<6> eigen = symmetricEigen<6>(to_motion.transpose() * added_mass * to_motion);
  Matrix6 rest = Matrix6::Identity();
  for (int i = 0; i < 6 && eigen.values[i] < kStill; ++i) {
    const Vector6 motion = to_motion * eigen.vectors.col(i);  // x.Mx = 1
    rest -= motion * (displaced * motion).transpose();
  }
  for (AddedMassPart& part : parts) part.inertia = rest.transpose() * part.inertia * rest;
  return placed(std::move(parts), 1, Vector3::Zero());
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
