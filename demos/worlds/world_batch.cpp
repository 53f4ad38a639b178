#include "demos/worlds/world_batch.h"

#include <algorithm>

namespace ambient {
namespace {

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

void WorldBatch::step(const std::uint8_t* reset) {
  pool_.run(worlds_.size(), [&](std::size_t i) {
    if (reset && reset[i]) {
      worlds_[i]->reset(start_, true);
    } else {
      worlds_[i]->step();
    }
    tell(i);
  });
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
  pool_.run(worlds_.size(), [&](std::size_t i) {
    for (std::size_t t = sized(begin); t < sized(end); ++t) {
      const std::size_t place = i * sized(steps) + t;
      std::copy_n(actions + place * taken, taken, actions_.data() + i * taken);
      worlds_[i]->step();
      std::copy_n(observations_.data() + i * given, given, observations + place * given);
    }
    tell(i);
  });
}

void WorldBatch::restore(int world, std::string_view bytes) {
  at(world).restoreState(bytes);
  tell(sized(world));
}

}  // namespace ambient
