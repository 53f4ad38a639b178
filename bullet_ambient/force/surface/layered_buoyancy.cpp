#include "bullet_ambient/force/surface/layered_buoyancy.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bullet_ambient/force/surface/hydrostatics.h"

namespace ambient {
namespace {

// Nodes and weights of Gauss on [0, 1], of degree 7.
constexpr double kNode[] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                            0.93056815579702629};
constexpr double kWeight[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                              0.17392742256872693};

// Excess of the fluid below one height after another.
class ExcessSum {
 public:
  explicit ExcessSum(const LayeredBody& body) : body_(body) {}

  void addAll(double density) noexcept {
    excess_.mass += density * body_.shape.volume;
    excess_.moment += density * body_.shape.volume * body_.shape.centre_of_volume;
  }
  /// Adds the moment of a density that grows evenly along `up` [kg/m^4].
  void addGrowth(double slope) noexcept {
    const Matrix3& inertia = body_.shape.uniform_mass.inertia;
    excess_.moment +=
        slope * body_.shape.volume * (inertia.trace() / 2 * body_.up - inertia * body_.up);
  }
  void addBelow(double height, double density) noexcept {
    SurfacePlane plane;
    plane.normal = body_.up;
    plane.height = height - body_.origin_height;
    const WetVolume wet = body_.hull ? computeWetVolume(*body_.hull, plane)
                                     : computeWetSphere(body_.shape.sphere_radius,
                                                        body_.shape.centre_of_volume, plane);
    excess_.mass += density * wet.volume;
    excess_.moment += density * wet.moment;
  }
  const ExcessFluid& result() const noexcept { return excess_; }

 private:
  const LayeredBody& body_;
  ExcessFluid excess_;
};

// Returns the lowest and the highest point of a body, as the layers count heights [m].
std::pair<double, double> heightsOf(const LayeredBody& body) noexcept {
  if (body.hull) {
    const auto [low, high] = computeExtent(*body.hull, body.up);
    return {body.origin_height + low, body.origin_height + high};
  }
  const double centre = body.origin_height + body.up.dot(body.shape.centre_of_volume);
  return {centre - body.shape.sphere_radius, centre + body.shape.sphere_radius};
}

// Returns the slope of the density between two heights [kg/m^4]; none: it bends there.
std::optional<double> slopeBetween(const DensityLayers& layers, double low, double high) noexcept {
  const auto& levels = layers.levels();
  if (high <= levels.front().height || low >= levels.back().height) return 0;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    if (low >= levels[i].height && high <= levels[i + 1].height && low < levels[i + 1].height)
      return (levels[i + 1].density - levels[i].density) /
             (levels[i + 1].height - levels[i].height);
  return std::nullopt;
}

bool knowsSpread(const LayeredBody& body) noexcept {
  return body.shape.uniform_mass.inertia.trace() > 0;
}

}  // namespace

ExcessFluid findExcessFluid(const LayeredBody& body, const DensityLayers& layers,
                            double reference) noexcept {
  const auto [low, high] = heightsOf(body);
  const double top = std::min(high, body.surface);
  const double middle = body.origin_height + body.up.dot(body.shape.centre_of_volume);
  ExcessSum sum(body);
  if (!(high > low)) sum.addAll(layers.density(std::min(middle, body.surface)) - reference);
  if (!(top > low)) return sum.result();
  if (const auto slope = slopeBetween(layers, low, high);
      slope && top == high && knowsSpread(body)) {
    sum.addAll(layers.density(middle) - reference);
    sum.addGrowth(*slope);
    return sum.result();
  }
  if (top < high)
    sum.addBelow(top, layers.density(top) - reference);
  else
    sum.addAll(layers.density(top) - reference);
  const auto& levels = layers.levels();
  for (std::size_t i = 0; i + 1 < levels.size() && levels[i].height < top; ++i) {
    const DensityLevel &from = levels[i], &to = levels[i + 1];
    const double fall = from.density - to.density, thickness = to.height - from.height;
    const double begin = std::max(low, from.height), end = std::min(top, to.height);
    if (fall == 0 || end < low) continue;
    if (!(thickness > 0)) {
      sum.addBelow(from.height, fall);
    } else if (end > begin) {
      for (int node = 0; node < 4; ++node)
        sum.addBelow(begin + kNode[node] * (end - begin),
                     kWeight[node] * fall * ((end - begin) / thickness));
    }
  }
  return sum.result();
}

}  // namespace ambient
