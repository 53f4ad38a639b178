#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "demos/simulation/simulation.h"
#include "demos/worlds/batch_plan.h"
#include "demos/worlds/batch_random.h"

namespace ambient {

/// Rows of one world in the arrays of a batch.
struct BatchRows {
  double* action = nullptr;
  double* parameters = nullptr;
  double* observation = nullptr;
};

/// One world of a batch. It reads and writes its own rows and simulation only.
class BatchWorld {
 public:
  /// Stands at the start of the scene; reset() comes before the first step.
  BatchWorld(const BatchPlan& plan, std::uint64_t seed, const BatchRows& rows);

  /// State of the simulation as it was made.
  SimulationState start() const { return simulation_->state(); }
  /// Goes back to the start of the scene, draws the parameters of the next episode and sets the
  /// sensors. `draws`: false: takes the parameters that are in its row.
  void reset(const SimulationState& start, bool draws);
  /// Begins again with another seed, before reset().
  void setSeed(std::uint64_t seed);
  /// Begins an env step, or sets the sensors if the world has failed. Returns whether it has begun.
  bool begin();
  /// Makes the k-th substep, or nothing if the world has failed since. Between begin() and end().
  void substep(int k) noexcept;
  /// Ends the env step, and sets the sensors.
  void end();

  bool isTruncated() const;
  const std::string& fault() const { return fault_; }  ///< empty: the world has not failed
  /// Episodes begun since the seed was set.
  std::uint64_t episode() const { return episodes_; }
  long long steps() const { return steps_; }  ///< env steps of this episode

  Simulation& simulation() { return *simulation_; }
  /// Present current and gust, as a flow that stays.
  FlowField flowNow() const;
  /// Puts a simulation of the same scene into the state of this world.
  /// @throws std::runtime_error if this one has failed
  void copyTo(Simulation& other) const;

  std::string saveState() const;
  /// @throws std::runtime_error if the bytes are damaged or of another batch.
  void restoreState(std::string_view bytes);

 private:
  /// Flow beside that of the scene, as the regions of the simulation see it.
  struct Flow {
    Vector3 current{0, 0, 0};
    FlowField gusts;                              ///< of this episode; null: none
    Vector3 gust_before{0, 0, 0}, gust{0, 0, 0};  ///< at both ends of the env step [m/s]
    FlowSample now;
    void at(double share, double env_step);
  };
  struct Head;

  RandomNumbers numbers(RandomStream stream) const;
  void draw();
  /// Parameters of a variation; null: it has none.
  const double* find(VariationKind kind, std::size_t body = kAny) const;
  void apply();
  void applyMass(std::size_t body);
  void moveCentre(std::size_t body);
  void placeBody(std::size_t body);
  void setFlowAndThrusters();
  /// Sets what a state of a simulation has not: factors of thrusters, centres of mass.
  void setHardware(Simulation& simulation) const;
  std::string saveSimulation() const;
  /// Makes the gusts of this episode.
  void makeGusts();
  Vector3 gustAfter(long long steps) const;
  bool isActionFinite();
  void command(const ActionField& field);
  void setMotors(const ActionField& field);
  void push(const ActionField& field);
  void act(bool is_first);
  /// Reads wrenches of the fluid anew, in the present state.
  void readWrenches();
  void observe();
  void addNoise();
  void fail(std::string sentence);

  static constexpr std::size_t kAny = static_cast<std::size_t>(-1);

  const BatchPlan& plan_;
  std::uint64_t seed_;
  BatchRows rows_;
  std::unique_ptr<Flow> flow_;  // its address is in functions of regions
  std::unique_ptr<Simulation> simulation_;
  Vector3 target_{0, 0, 0};
  double gust_factor_ = 1;
  std::uint64_t episodes_ = 0;
  long long steps_ = 0;
  std::string fault_;
  std::vector<double> numbers_;  // of one field, before its rows are taken
  std::vector<Twist> before_;    // of BatchPlan::accelerated before the last substep
};

}  // namespace ambient
