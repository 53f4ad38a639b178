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

/// Kinds of reports about what cannot be right. Each is said once.
enum class Complaint {
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

/// Says each complaint once. Solvers on several threads may say them at the same time; the report
/// hears one after the other. Takes a lock only where a complaint is said for the first time.
class Complaints {
 public:
  /// Says a complaint, in a sentence that fits all bodies or in the given one.
  void say(Complaint complaint) noexcept;
  void say(Complaint complaint, const char* sentence) noexcept;
  /// Names the first body whose steps are too long; AmbientCounters::too_long counts them.
  void sayTooLong(const AttachDef& def) noexcept;
  /// Names the first link that its joint turns by half a turn or more in a step, by a number of
  /// `turns` in one of `step` [s].
  void sayFastJoint(const AttachDef& def, double turns, double step) noexcept;
  /// Names a floating body moved by constraint rows whose step [s] is too long for its natural
  /// frequency [rad/s].
  void sayShortPeriod(const AttachDef& def, double frequency, double step) noexcept;
  /// Names a body whose joint comes apart, and the other body of the joint; null: that one has no
  /// fluid.
  void sayOpenJoint(const AttachDef& def, const AttachDef* other) noexcept;
  /// Names a vessel that is too heavy to float, and its hold of a number that has filled. Said as
  /// often as it is called.
  void saySunk(const AttachDef& def, std::size_t hold) noexcept;

  /// Passes a sentence to the report function, every time. Drops exceptions of that function, which
  /// must not unwind through Bullet's step.
  void tell(const std::string& sentence) noexcept;
  /// Sets the report function. Call between steps; null: reports are dropped.
  void setReport(std::function<void(const std::string&)> report) { report_ = std::move(report); }

 private:
  bool wasSaid(Complaint complaint) const noexcept;
  /// Says what make() returns, which is asked for only if the complaint is new.
  template <class MakeSentence>
  void sayMade(Complaint complaint, const MakeSentence& make) noexcept;

  std::atomic<bool> was_said_[static_cast<int>(Complaint::kCount)] = {};
  std::recursive_mutex telling_;  // recursive: a report may attach, and that may say more
  std::function<void(const std::string&)> report_;
};

}  // namespace ambient
