#include "bullet_ambient/force/loads/sphere_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

struct CubicStencil {
  int first;
  double weights[4];
};

// Lagrange's cubic through the four nodes around x, all of them in [begin, end].
CubicStencil stencilAt(double x, int begin, int end) noexcept {
  CubicStencil stencil;
  stencil.first = std::clamp(static_cast<int>(x) - 1, begin, end - 3);
  const double s = x - stencil.first;
  stencil.weights[0] = -(s - 1) * (s - 2) * (s - 3) / 6;
  stencil.weights[1] = s * (s - 2) * (s - 3) / 2;
  stencil.weights[2] = -s * (s - 1) * (s - 3) / 2;
  stencil.weights[3] = s * (s - 1) * (s - 2) / 6;
  return stencil;
}

}  // namespace

SphereTable::SphereTable(double separation_cosine)
    : closing_share_(separation_cosine < 0 ? 1 / (1 - separation_cosine) : 0.5) {
  AMBIENT_ASSERT(separation_cosine >= -1 && separation_cosine <= 0);
  double* node = values_.data();
  for (int i = 0; i < kShares; ++i) {
    for (int j = 0; j < kCosines; ++j, node += kValues) {
      const SphereIntegrals integrals = integrateSphere(shareAt(i), cosineAt(j), separation_cosine);
      int value = 0;
      for (const Vector3* vector :
           {&integrals.detached, &integrals.friction_force, &integrals.friction_torque})
        for (const double factor : *vector) node[value++] = factor;
    }
  }
}

double SphereTable::shareAt(int node) const noexcept {
  const double x = static_cast<double>(node - kMiddle) / kMiddle;
  return closing_share_ + x * std::abs(x) * (x < 0 ? closing_share_ : 1 - closing_share_);
}

double SphereTable::cosineAt(int node) noexcept {
  const double y = static_cast<double>(node) / (kCosines - 1);
  return y * y;
}

SphereIntegrals SphereTable::at(double spin_share, double cosine) const noexcept {
  AMBIENT_ASSERT(spin_share >= 0 && spin_share <= 1 && cosine >= 0 && cosine <= 1);
  const double rest = spin_share - closing_share_;
  const CubicStencil share =
      rest < 0
          ? stencilAt(kMiddle * (1 - std::sqrt(-rest / closing_share_)), 0, kMiddle)
          : stencilAt(kMiddle * (1 + std::sqrt(rest / (1 - closing_share_))), kMiddle, kShares - 1);
  const CubicStencil direction = stencilAt((kCosines - 1) * std::sqrt(cosine), 0, kCosines - 1);
  std::array<double, kValues> sums{};
  for (int i = 0; i < 4; ++i) {
    const double* row =
        values_.data() + ((share.first + i) * kCosines + direction.first) * std::ptrdiff_t{kValues};
    for (int j = 0; j < 4; ++j) {
      const double weight = share.weights[i] * direction.weights[j];
      for (int value = 0; value < kValues; ++value)
        sums[value] += weight * row[j * kValues + value];
    }
  }
  return {{sums[0], sums[1], sums[2]}, {sums[3], sums[4], sums[5]}, {sums[6], sums[7], sums[8]}};
}

std::shared_ptr<const SphereTable> sharedSphereTable(double separation_cosine) {
  static std::mutex mutex;
  static std::map<double, std::shared_ptr<const SphereTable>> tables;
  const std::lock_guard<std::mutex> lock(mutex);
  if (const auto found = tables.find(separation_cosine); found != tables.end())
    return found->second;
  for (auto entry = tables.begin(); entry != tables.end();)
    entry = entry->second.use_count() == 1 ? tables.erase(entry) : std::next(entry);
  return tables[separation_cosine] = std::make_shared<const SphereTable>(separation_cosine);
}

}  // namespace ambient
