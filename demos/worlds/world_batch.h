#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "demos/worlds/batch_plan.h"
#include "demos/worlds/batch_world.h"
#include "demos/worlds/thread_pool.h"

namespace ambient {

/// N worlds of one scene that step by one call: actions in, observations out. The same bits at any
/// number of threads, and as N batches of one world each. One thread at a time may use it.
///
/// An env step is BatchSettings::substeps steps of the scene under one action. A world whose state
/// is not finite, or whose step throws, fails: it stands still, with observations of NaN, until its
/// reset; the others go on.
class WorldBatch {
 public:
  /// Makes the worlds, all on this thread, and begins their first episodes.
  /// @throws std::runtime_error or std::invalid_argument, one line that names the key, the value
  /// and the limit.
  WorldBatch(const Scene& scene, const BatchSettings& settings);

  int worlds() const { return plan_.settings.worlds; }
  const BatchPlan& plan() const { return plan_; }

  // Memory of the worlds, row-major, at fixed addresses.
  double* actions() { return actions_.data(); }            ///< N x A
  double* parameters() { return parameters_.data(); }      ///< N x P; what the episodes have drawn
  double* observations() { return observations_.data(); }  ///< N x O
  std::uint8_t* failed() { return failed_.data(); }        ///< N
  std::uint8_t* truncated() { return truncated_.data(); }  ///< N
  std::uint64_t* episodes() { return episodes_.data(); }   ///< N; episodes begun since the seed

  /// Makes one env step of all worlds; those with reset[i] != 0 are reset in its place. `reset`:
  /// N flags; null: none.
  void step(const std::uint8_t* reset = nullptr);
  /// Resets worlds. `mask`: N flags; null: all. `seeds`: N; null: the seeds stay, and the next
  /// episode is drawn. `draws`: false: takes the parameters that are in their memory.
  void reset(const std::uint8_t* mask = nullptr, const std::uint64_t* seeds = nullptr,
             bool draws = true);
  /// Makes env steps open loop, without resets: those from `begin` to `end` of `steps` T.
  /// `actions`: N x T x A; `observations`: N x T x O.
  void run(const double* actions, int steps, double* observations, int begin, int end);

  /// Bytes of a world for restore(). @throws std::runtime_error if it has failed
  std::string state(int world) const { return at(world).saveState(); }
  /// Goes on from there in this world; bit for bit where Simulation::restoreState() does.
  /// @throws std::runtime_error or std::invalid_argument if the bytes are damaged or of another
  /// batch
  void restore(int world, std::string_view bytes);
  /// A world, numbered from 0.
  BatchWorld& world(int number) { return at(number); }
  /// Why a world has failed; empty: it has not.
  const std::string& fault(int world) const { return at(world).fault(); }

 private:
  BatchWorld& at(int world) const { return *worlds_.at(static_cast<std::size_t>(world)); }
  void tell(std::size_t world);
  /// Calls work(first, end) for groups of worlds that step together, on all threads.
  template <class Work>
  void forGroups(const Work& work);
  /// Makes one env step of the worlds of a group; those with reset[i] != 0 are reset in its place.
  void stepGroup(std::size_t first, std::size_t end, const std::uint8_t* reset);

  const BatchPlan plan_;
  std::vector<double> actions_, parameters_, observations_;
  std::vector<std::uint8_t> failed_, truncated_;
  std::vector<std::uint64_t> episodes_;
  std::vector<std::unique_ptr<BatchWorld>> worlds_;
  SimulationState start_;
  ThreadPool pool_;
};

}  // namespace ambient
