#include "bullet_ambient/fluid_body/added_mass_parts.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/fluid_body/block_order.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

constexpr std::size_t kParts = PartBlock::kParts;

/// Neighbours in one half of a block: the water covers them together.
std::vector<std::uint32_t> orderByPlace(const std::vector<AddedMassPart>& parts) {
  std::vector<Vector6> places;
  places.reserve(parts.size());
  for (const AddedMassPart& part : parts)
    places.push_back(stack({0, 0, 0}, part.centre.allFinite() ? part.centre : Vector3::Zero()));
  return orderInBlocks(places, kParts / 2);
}

/// Returns the largest distance from the centre, along any direction, of the Gauss points of a part
/// [m]; a little more, against rounding.
double reachOf(const AddedMassPart& part) {
  constexpr double kNode = 9.0 / 5, kRounding = 1e-6;
  const Vector6& c = part.spread;
  Matrix3 spread;
  spread << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  const double largest = symmetricEigen<3>(spread).values.maxCoeff();
  return (1 + kRounding) * std::sqrt(kNode * std::max(0.0, largest));
}

Matrix6 inertiaOf(const PartBlock& block, std::size_t lane) {
  Matrix6 inertia;
  int entry = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      inertia(row, column) = inertia(column, row) =
          static_cast<double>(block.inertia[entry++][lane]);
  return inertia;
}

double signIn(int turned, int of) { return __builtin_popcount(turned & of) % 2 == 0 ? 1 : -1; }

/// Returns the axes whose mirrors map the parts onto themselves.
int mirrorsOf(const std::vector<AddedMassPart>& parts) {
  constexpr std::size_t kMost = 256;  // the cost is quadratic
  if (parts.size() > kMost) return 0;
  const auto countOf = [&](const AddedMassPart& part) {
    return std::count_if(parts.begin(), parts.end(), [&](const AddedMassPart& other) {
      return other.centre == part.centre && other.spread == part.spread &&
             other.inertia == part.inertia;
    });
  };
  int mirrors = 0;
  for (const int turned : {1, 2, 4})
    if (std::all_of(parts.begin(), parts.end(), [&](const AddedMassPart& part) {
          return countOf(imageOf(part, turned)) == countOf(part);
        }))
      mirrors |= turned;
  return mirrors;
}

/// Returns how many of the axes have their plane through the centre of a part.
int planesThrough(const AddedMassPart& part, int axes) {
  int planes = 0;
  for (int axis = 0; axis < 3; ++axis) planes += (axes >> axis & 1) && part.centre[axis] == 0;
  return planes;
}

}  // namespace

AddedMassPart imageOf(AddedMassPart part, int turned) {
  constexpr int kSpreads[6] = {0, 0, 0, 3, 5, 6};  // axes of xx, yy, zz, xy, xz, yz that count
  for (int axis = 0; axis < 3; ++axis) part.centre[axis] *= signIn(turned, 1 << axis);
  for (int k = 0; k < 6; ++k) part.spread[k] *= signIn(turned, kSpreads[k]);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) part.inertia(i, j) *= signIn(turned, kTurnedBy[i] ^ kTurnedBy[j]);
  return part;
}

AddedMassParts::AddedMassParts(const std::vector<AddedMassPart>& parts)
    : size_(parts.size()), mirrors_(mirrorsOf(parts)) {
  std::vector<AddedMassPart> kept;
  for (const AddedMassPart& part : parts) {
    bool is_first = true;
    for (int axis = 0; axis < 3; ++axis)
      is_first = is_first && !((mirrors_ >> axis & 1) && part.centre[axis] < 0);
    if (!is_first) continue;
    kept.push_back(part);
    kept.back().inertia *= std::ldexp(1.0, -planesThrough(part, mirrors_));  // images coincide
  }
  pack(kept);
}

void AddedMassParts::pack(const std::vector<AddedMassPart>& parts) {
  places_.resize(parts.size());
  blocks_.resize((parts.size() + kParts - 1) / kParts);  // all zero
  std::uint32_t place = 0;
  for (const std::uint32_t part : orderByPlace(parts)) places_[part] = place++;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const AddedMassPart& part = parts[i];
    PartBlock& block = blocks_[places_[i] / kParts];
    const std::size_t lane = places_[i] % kParts;
    for (int axis = 0; axis < 3; ++axis)
      block.centre[axis][lane] = static_cast<float>(part.centre[axis]);
    block.reach[lane] = static_cast<float>(reachOf(part));
    for (int k = 0; k < 6; ++k) block.spread[k][lane] = static_cast<float>(part.spread[k]);
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        block.inertia[entry++][lane] = static_cast<float>(part.inertia(row, column));
  }
}

std::vector<AddedMassPart> AddedMassParts::packed() const {
  std::vector<AddedMassPart> parts(places_.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartBlock& block = blocks_[places_[i] / kParts];
    const std::size_t lane = places_[i] % kParts;
    for (int axis = 0; axis < 3; ++axis)
      parts[i].centre[axis] = static_cast<double>(block.centre[axis][lane]);
    for (int k = 0; k < 6; ++k) parts[i].spread[k] = static_cast<double>(block.spread[k][lane]);
    parts[i].inertia = inertiaOf(block, lane);
  }
  return parts;
}

std::vector<AddedMassPart> AddedMassParts::all() const {
  std::vector<AddedMassPart> parts;
  parts.reserve(size());
  for (AddedMassPart& part : packed()) {
    part.inertia *= std::ldexp(1.0, planesThrough(part, mirrors_));
    for (int image = 0; image < blocks().images(); ++image) {
      const int turned = imageOf(mirrors_, image);
      if (planesThrough(part, turned) == 0) parts.push_back(imageOf(part, turned));
    }
  }
  return parts;
}

Matrix6 AddedMassParts::sum() const {
  Matrix6 sum = Matrix6::Zero();
  for (const PartBlock& block : blocks_)
    for (std::size_t lane = 0; lane < kParts; ++lane) sum += inertiaOf(block, lane);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      sum(i, j) *= (kTurnedBy[i] ^ kTurnedBy[j]) & mirrors_ ? 0 : blocks().images();
  return sum;
}

AddedMassParts AddedMassParts::scaled(double factor) const {
  std::vector<AddedMassPart> parts = packed();
  for (AddedMassPart& part : parts) {
    part.centre *= factor;
    part.spread *= factor * factor;
    part.inertia = scaleShape(part.inertia, factor);
  }
  AddedMassParts result;
  result.size_ = size_;
  result.mirrors_ = mirrors_;
  result.pack(parts);
  return result;
}

}  // namespace ambient
