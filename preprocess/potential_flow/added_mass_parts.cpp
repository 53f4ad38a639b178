#include "preprocess/potential_flow/added_mass_parts.h"

#include <algorithm>

#include "bullet_ambient/fluid_body/block_order.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

constexpr std::size_t kPanelsOfAPart = 16, kMostParts = 96;

Vector6 productsOf(const Vector3& r) {
  Vector6 products;
  products << r.x() * r.x(), r.y() * r.y(), r.z() * r.z(), r.x() * r.y(), r.x() * r.z(),
      r.y() * r.z();
  return products;
}

AddedMassPart join(const std::vector<PanelInertia>& panels, const std::uint32_t* chosen,
                   std::size_t count) {
  AddedMassPart part;
  double area = 0;
  for (std::size_t i = 0; i < count; ++i) area += panels[chosen[i]].area;
  for (std::size_t i = 0; i < count; ++i)
    part.centre += panels[chosen[i]].area / area * panels[chosen[i]].centroid;
  for (std::size_t i = 0; i < count; ++i) {
    const PanelInertia& panel = panels[chosen[i]];
    part.spread += panel.area / area * (panel.spread + productsOf(panel.centroid - part.centre));
    part.inertia += 0.5 * (panel.inertia + panel.inertia.transpose());
  }
  return part;
}

template <class Values>
void roundToSingle(Values& values) {
  values = values.template cast<float>().template cast<double>().eval();
}

}  // namespace

std::vector<AddedMassPart> joinPanels(const std::vector<PanelInertia>& panels) {
  double size = 0;
  for (const PanelInertia& panel : panels)
    size = std::max(size, panel.centroid.cwiseAbs().maxCoeff());
  std::vector<Vector6> coordinates;
  coordinates.reserve(panels.size());
  for (const PanelInertia& panel : panels)
    coordinates.push_back(stack(panel.normal, panel.centroid / (size > 0 ? size : 1)));
  const std::size_t each = std::max(kPanelsOfAPart, (panels.size() + kMostParts - 1) / kMostParts);
  const std::vector<std::uint32_t> order = orderInBlocks(coordinates, each);
  std::vector<AddedMassPart> parts;
  for (std::size_t begin = 0; begin < order.size(); begin += each)
    parts.push_back(join(panels, &order[begin], std::min(each, order.size() - begin)));
  return parts;
}

std::vector<AddedMassPart> placed(std::vector<AddedMassPart> parts, double length,
                                  const Vector3& centre) {
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
