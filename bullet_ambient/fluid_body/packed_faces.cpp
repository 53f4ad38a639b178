#include "bullet_ambient/fluid_body/packed_faces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <unordered_map>

namespace ambient {
namespace {

double largestOf(const std::vector<double>& column) {
  double largest = 0;
  for (const double value : column) largest = std::max(largest, std::abs(value));
  return largest;
}

// The power of two at or above a value; 1 for 0 and what is not finite.
double unitFor(double largest) {
  if (!(largest > 0) || !std::isfinite(largest)) return 1;
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
}

void setColumn(float (&column)[3][FaceBlock::kFaces], std::size_t i, const Vector3& v) {
  for (int axis = 0; axis < 3; ++axis) column[axis][i] = static_cast<float>(v[axis]);
}

}  // namespace

PackedFaces::PackedFaces(const FaceTable& faces)
    : size_(faces.size()),
      length_unit_(unitFor(std::max({largestOf(faces.centroid_x), largestOf(faces.centroid_y),
                                     largestOf(faces.centroid_z)}))),
      area_unit_(unitFor(largestOf(faces.area))) {
  constexpr std::size_t kFaces = FaceBlock::kFaces;
  blocks_.resize((size_ + kFaces - 1) / kFaces);  // all zero
  for (std::size_t i = 0; i < size_; ++i) {
    FaceBlock& block = blocks_[i / kFaces];
    const Vector3 normal = faces.normal(i);
    const Vector3 centroid = faces.centroid(i) / length_unit_;
    setColumn(block.normal, i % kFaces, normal);
    setColumn(block.centroid, i % kFaces, centroid);
    setColumn(block.moment, i % kFaces, centroid.cross(normal));
    block.area[i % kFaces] = static_cast<float>(faces.area[i] / area_unit_);
  }
}

bool PackedFaces::isOf(const FaceTable& faces) const {
  if (faces.size() != size_) return false;
  const PackedFaces other(faces);
  return other.length_unit_ == length_unit_ && other.area_unit_ == area_unit_ &&
         (size_ == 0 || std::memcmp(static_cast<const void*>(other.blocks_.data()), blocks_.data(),
                                    blocks_.size() * sizeof(FaceBlock)) == 0);
}

std::shared_ptr<const PackedFaces> sharedPackedFaces(const FaceTable& faces) {
  static std::mutex mutex;
  static std::unordered_map<const FaceTable*, std::weak_ptr<const PackedFaces>> known;
  const std::lock_guard lock(mutex);
  if (const auto found = known.find(&faces); found != known.end()) {
    // A table that changed, or another one at its address, is packed anew.
    if (auto packed = found->second.lock(); packed && packed->isOf(faces)) return packed;
  }
  for (auto entry = known.begin(); entry != known.end();)
    entry = entry->second.expired() ? known.erase(entry) : std::next(entry);
  auto packed = std::make_shared<const PackedFaces>(faces);
  known[&faces] = packed;
  return packed;
}

}  // namespace ambient
