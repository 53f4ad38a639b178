#include "demos/worlds/world_batch.h"

#include <algorithm>
#include <array>
#include <functional>

namespace ambient {
namespace {

constexpr int kMostTogether = 8;  // worlds of a group: as many as there are lanes

std::size_t sized(int count) { return static_cast<std::size_t>(count); }

}  // namespace

WorldBatch::WorldBatch(const Scene& scene, const BatchSettings& settings)
    : plan_(scene, settings),
      actions_(sized(settings.worlds) * sized(plan_.action_size), 0.0),
      parameters_(sized(settings.worlds) * sized(plan_.parameter_size), 0.0),
      observations_(sized(settings.worlds) * sized(plan_.observation_size), 0.0),
      failed_(sized(settings.worlds)),
      truncated_(failed_.size()),
      episodes_(failed_.size()),
      pool_(std::min(threadCount(settings.threads), settings.worlds)) {
  for (std::size_t i = 0; i < failed_.size(); ++i) {
    const BatchRows rows{actions_.data() + i * sized(plan_.action_size),
                         parameters_.data() + i * sized(plan_.parameter_size),
                         observations_.data() + i * sized(plan_.observation_size)};
    worlds_.push_back(std::make_unique<BatchWorld>(plan_, settings.seed + i, rows));
  }
  start_ = worlds_.front()->start();
  reset();
}

void WorldBatch::tell(std::size_t world) {
  failed_[world] = !worlds_[world]->fault().empty();
  truncated_[world] = worlds_[world]->isTruncated();
  episodes_[world] = worlds_[world]->episode();
}

template <class Work>
void WorldBatch::forGroups(const Work& work) {
  const std::size_t count = worlds_.size();
  const auto together = sized(std::min(plan_.settings.together, kMostTogether));
  const std::size_t groups =
      std::max((count + together - 1) / together, std::min(count, pool_.threads()));
  pool_.run(groups, [&](std::size_t i) { work(i * count / groups, (i + 1) * count / groups); });
}

void WorldBatch::stepGroup(std::size_t first, std::size_t end, const std::uint8_t* reset) {
  std::array<BatchWorld*, kMostTogether> moving;
  std::array<Fluid*, kMostTogether> fluids;
  int count = 0;
  for (std::size_t i = first; i < end; ++i) {
    BatchWorld& world = *worlds_[i];
    if (reset && reset[i]) {
      world.reset(start_, true);
    } else if (world.begin()) {
      moving[sized(count)] = &world;
      fluids[sized(count++)] = &world.simulation().fluid();
    }
  }
  for (int k = 0; k < plan_.settings.substeps && count > 0; ++k) {
    const auto substep = [&](int i) { moving[sized(i)]->substep(k); };
    if (count == 1)
      substep(0);
    else
      stepTogether(fluids.data(), count, std::cref(substep));  // allocates nothing
  }
  for (int i = 0; i < count; ++i) moving[sized(i)]->end();
  for (std::size_t i = first; i < end; ++i) tell(i);
}

void WorldBatch::step(const std::uint8_t* reset) {
  forGroups([&](std::size_t first, std::size_t end) { stepGroup(first, end, reset); });
}

void WorldBatch::reset(const std::uint8_t* mask, const std::uint64_t* seeds, bool draws) {
  pool_.run(worlds_.size(), [&](std::size_t i) {
    if (mask && !mask[i]) return;
    if (seeds) worlds_[i]->setSeed(seeds[i]);
    worlds_[i]->reset(start_, draws);
    tell(i);
  });
}

void WorldBatch::run(const double* actions, int steps, double* observations, int begin, int end) {
  const std::size_t taken = sized(plan_.action_size), given = sized(plan_.observation_size);
  forGroups([&](std::size_t first, std::size_t last) {
    for (std::size_t t = sized(begin); t < sized(end); ++t) {
      const auto placeOf = [&](std::size_t world) { return world * sized(steps) + t; };
      for (std::size_t i = first; i < last; ++i)
        std::copy_n(actions + placeOf(i) * taken, taken, actions_.data() + i * taken);
      stepGroup(first, last, nullptr);
      for (std::size_t i = first; i < last; ++i)
        std::copy_n(observations_.data() + i * given, given, observations + placeOf(i) * given);
    }
  });
}

void WorldBatch::restore(int world, std::string_view bytes) {
  at(world).restoreState(bytes);
  tell(sized(world));
}

}  // namespace ambient
