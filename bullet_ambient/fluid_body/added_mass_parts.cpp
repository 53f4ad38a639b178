#include "bullet_ambient/fluid_body/added_mass_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

constexpr std::size_t kParts = PartBlock::kParts;
constexpr std::uint32_t kImages = 8;

using Order = std::vector<std::uint32_t>;

Eigen::Index widestAxis(const std::vector<Vector6>& coordinates, Order::iterator begin,
                        Order::iterator end) {
  Vector6 low = coordinates[*begin], high = low;
  for (auto at = begin; at != end; ++at) {
    low = low.cwiseMin(coordinates[*at]);
    high = high.cwiseMax(coordinates[*at]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

void sortInBlocks(const std::vector<Vector6>& coordinates, std::ptrdiff_t block_size,
                  Order::iterator begin, Order::iterator end) {
  const std::ptrdiff_t blocks = (end - begin + block_size - 1) / block_size;
  if (blocks <= 1) return std::sort(begin, end);
  const auto middle = begin + (blocks + 1) / 2 * block_size;
  const Eigen::Index axis = widestAxis(coordinates, begin, end);
  std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
    const double x = coordinates[a][axis], y = coordinates[b][axis];
    return x < y || (x == y && a < b);
  });
  sortInBlocks(coordinates, block_size, begin, middle);
  sortInBlocks(coordinates, block_size, middle, end);
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

bool areEqual(const AddedMassPart& a, const AddedMassPart& b) {
  return a.centre == b.centre && a.spread == b.spread && a.inertia == b.inertia;
}

bool isBefore(const Vector3& a, const Vector3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Returns the axes whose mirrors map the parts onto themselves.
int mirrorsOf(const std::vector<AddedMassPart>& parts) {
  constexpr std::size_t kMost = 256;  // more of one centre would have a quadratic cost
  const auto isFinite = [](const AddedMassPart& part) { return part.centre.allFinite(); };
  if (parts.size() > kMost || !std::all_of(parts.begin(), parts.end(), isFinite)) return 0;
  std::vector<const AddedMassPart*> sorted;  // by their centres
  for (const AddedMassPart& part : parts) sorted.push_back(&part);
  const auto precedes = [](const AddedMassPart* a, const AddedMassPart* b) {
    return isBefore(a->centre, b->centre);
  };
  std::sort(sorted.begin(), sorted.end(), precedes);
  const auto countImages = [&](const AddedMassPart& part, int turned) {
    const AddedMassPart image = imageOf(part, turned);
    const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), &image, precedes);
    return std::count_if(begin, end,
                         [&](const AddedMassPart* other) { return areEqual(*other, image); });
  };
  int mirrors = 0;
  for (const int turned : {1, 2, 4})
    if (std::all_of(parts.begin(), parts.end(), [&](const AddedMassPart& part) {
          const auto images = countImages(part, turned);
          return images > 0 && images == countImages(part, 0);  // 0: it is not finite
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
    : mirrors_(mirrorsOf(parts)) {
  places_.reserve(parts.size());
  std::vector<int> turned;
  std::vector<AddedMassPart> kept;
  for (const AddedMassPart& part : parts) {
    turned.push_back(0);
    for (int axis = 0; axis < 3; ++axis)
      if ((mirrors_ >> axis & 1) && part.centre[axis] < 0) turned.back() |= 1 << axis;
    if (turned.back() == 0) kept.push_back(part);
  }
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const AddedMassPart image = imageOf(parts[i], turned[i]);
    const auto same = [&](const AddedMassPart& part) { return areEqual(part, image); };
    const auto first =
        turned[i] == 0 ? next++ : std::find_if(kept.begin(), kept.end(), same) - kept.begin();
    places_.push_back(kImages * static_cast<std::uint32_t>(first) + turned[i]);
  }
  for (AddedMassPart& part : kept)  // images coincide
    part.inertia *= std::ldexp(1.0, -planesThrough(part, mirrors_));
  pack(kept);
}

void AddedMassParts::pack(const std::vector<AddedMassPart>& parts) {
  std::vector<std::uint32_t> places(parts.size());
  blocks_.assign((parts.size() + kParts - 1) / kParts, {});  // all zero
  // Neighbours in one half of a block: the water covers them together.
  std::vector<Vector3> centres;
  for (const AddedMassPart& part : parts)
    centres.push_back(part.centre.allFinite() ? part.centre : Vector3::Zero());
  std::uint32_t next = 0;
  for (const std::uint32_t part : orderInBlocks(centres, kParts / 2)) places[part] = next++;
  for (std::uint32_t& place : places_) place = kImages * places[place / kImages] + place % kImages;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const AddedMassPart& part = parts[i];
    PartBlock& block = blocks_[places[i] / kParts];
    const std::size_t lane = places[i] % kParts;
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

AddedMassPart AddedMassParts::unpacked(std::uint32_t place) const {
  const PartBlock& block = blocks_[place / kParts];
  const std::size_t lane = place % kParts;
  AddedMassPart part;
  for (int axis = 0; axis < 3; ++axis)
    part.centre[axis] = static_cast<double>(block.centre[axis][lane]);
  for (int k = 0; k < 6; ++k) part.spread[k] = static_cast<double>(block.spread[k][lane]);
  part.inertia = inertiaOf(block, lane);
  return part;
}

AddedMassPart AddedMassParts::operator[](std::size_t i) const {
  AddedMassPart part = unpacked(places_[i] / kImages);
  part.inertia *= std::ldexp(1.0, planesThrough(part, mirrors_));
  return imageOf(part, static_cast<int>(places_[i] % kImages));
}

std::vector<AddedMassPart> AddedMassParts::all() const {
  std::vector<AddedMassPart> parts;
  parts.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) parts.push_back((*this)[i]);
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
  AddedMassParts result;
  result.mirrors_ = mirrors_;
  std::vector<AddedMassPart> parts;
  std::vector<std::uint32_t> numbers(kParts * blocks_.size());  // of the parts, by place
  for (const std::uint32_t place : places_) {
    if (place % kImages != 0) continue;
    numbers[place / kImages] = static_cast<std::uint32_t>(parts.size());
    AddedMassPart part = unpacked(place / kImages);
    part.centre *= factor;
    part.spread *= factor * factor;
    part.inertia = scaleShape(part.inertia, factor);
    parts.push_back(part);
  }
  result.places_.reserve(size());
  for (const std::uint32_t place : places_)
    result.places_.push_back(kImages * numbers[place / kImages] + place % kImages);
  result.pack(parts);
  return result;
}

std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector6>& coordinates,
                                         std::size_t block_size) {
  Order order(coordinates.size());
  std::iota(order.begin(), order.end(), 0u);
  sortInBlocks(coordinates, static_cast<std::ptrdiff_t>(block_size), order.begin(), order.end());
  return order;
}

std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector3>& places,
                                         std::size_t block_size) {
  std::vector<Vector6> coordinates;
  coordinates.reserve(places.size());
  for (const Vector3& place : places) coordinates.push_back(stack({0, 0, 0}, place));
  return orderInBlocks(coordinates, block_size);
}

}  // namespace ambient
