#pragma once

#include <functional>
#include <string>

#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

struct AttachDef;

/// What cannot be right.
enum class Complaint {
  kNoAction,
  kNoSolver,
  kNoMultiBodySolver,
  kNotFinite,
  kNotPhysical,
  kRegion,
  kOtherLinks,
  kRungeKutta,
  kInertia,
  kEmpty,
  kLight,
  kSwing,
  kGaping,
  kCount
};

/// Says each complaint once, but for those that are said once of each body.
class Complaints {
 public:
  /// In a sentence that fits all bodies, or in one that names the body.
  void say(Complaint complaint) noexcept;
  void say(Complaint complaint, const char* sentence) noexcept;
  /// Of a body whose steps are too long.
  void sayTooLong(const AttachDef& def) noexcept;
  /// Of a floating body that rows move, whose largest natural frequency [rad/s] the step [s] is too
  /// long for.
  void sayCoarseSwing(const AttachDef& def, double frequency, double step) noexcept;
  /// Of a body whose joint comes apart; `other`: null if it has no fluid.
  void sayGaping(const AttachDef& def, const AttachDef* other) noexcept;

  std::function<void(const std::string&)> report;  ///< null: nobody hears

 private:
  bool was_said_[static_cast<int>(Complaint::kCount)] = {};
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
