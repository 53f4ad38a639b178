#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

namespace ambient {

struct AttachDef;

/// Names a body in a sentence: "body 'crate'", or "body with fluid body 'box'" without a name.
/// @pre it has a fluid body
std::string nameOf(const AttachDef& def);

/// Kinds of reports about what cannot be right. Each is reported once.
enum class Warning {
  kNoAction,
  kNoSolver,
  kNoMultiBodySolver,
  kNotFinite,
  kNotPhysical,
  kRegion,
  kUp,
  kOtherLinks,
  kRungeKutta,
  kInertia,
  kEmpty,
  kAngle,
  kNoResistance,
  kLight,
  kShortPeriod,
  kTooLong,
  kFastJoint,
  kChange,
  kDuration,
  kOpenJoint,
  kCount
};

/// Reports each warning once. Solvers on several threads may warn at the same time; the report
/// hears one after the other. Takes a lock only where a warning is new.
class Warnings {
 public:
  /// Reports a warning, in a sentence that fits all bodies or in the given one.
  void warnOnce(Warning warning) noexcept;
  void warnOnce(Warning warning, const char* sentence) noexcept;
  /// Names the first body whose steps are too long; AmbientCounters::too_long counts them.
  void warnOfLongSteps(const AttachDef& def) noexcept;
  /// Names the first link that its joint turns by half a turn or more in a step, by a number of
  /// `turns` in one of `step` [s].
  void warnOfFastJoint(const AttachDef& def, double turns, double step) noexcept;
  /// Names a floating body moved by constraint rows whose step [s] is too long for its natural
  /// frequency [rad/s].
  void warnOfShortPeriod(const AttachDef& def, double frequency, double step) noexcept;
  /// Names a body whose joint comes apart, and the other body of the joint; null: that one has no
  /// fluid.
  void warnOfOpenJoint(const AttachDef& def, const AttachDef* other) noexcept;
  /// Names a vessel that is too heavy to float, and its hold of a number that has filled. Reported
  /// as often as it is called.
  void warnOfSunkVessel(const AttachDef& def, std::size_t hold) noexcept;

  /// Passes a sentence to the report function, every time. Drops exceptions of that function, which
  /// must not unwind through Bullet's step.
  void report(const std::string& sentence) noexcept;
  /// Sets the report function. Call between steps; null: reports are dropped.
  void setReport(std::function<void(const std::string&)> report) { report_ = std::move(report); }

 private:
  /// Reports what make() returns, which is asked for only if the warning is new.
  template <class MakeSentence>
  void warnByMaking(Warning warning, const MakeSentence& make) noexcept;

  std::atomic<bool> was_reported_[static_cast<int>(Warning::kCount)] = {};
  std::recursive_mutex reporting_;  // recursive: a report may attach, and that may warn
  std::function<void(const std::string&)> report_;
};

}  // namespace ambient
