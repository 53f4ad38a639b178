#include "bullet_ambient/immersed/warnings.h"

#include <cstdio>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/immersed/attach_def.h"

namespace ambient {
namespace {

const char* sentenceOf(Warning warning) {
  switch (warning) {
    case Warning::kNoAction:
      return "bullet_ambient: bodies in fluid moved in another world than that of their Fluid; "
             "give each world a Fluid, and each Fluid solvers of its own";
    case Warning::kNoSolver:
      return "bullet_ambient: bodies in fluid are awake but no solver of their Fluid was called; "
             "leave the world the solver that Fluid has given it, or call "
             "world->setConstraintSolver() with one of makeSolver<Base>(fluid)";
    case Warning::kNoMultiBodySolver:
      return "bullet_ambient: bodies in fluid are awake but no solver of their Fluid was called: "
             "setConstraintSolver does not reach the bodies of a btMultiBodyDynamicsWorld; call "
             "world->setMultiBodyConstraintSolver() with one of "
             "makeSolver<btMultiBodyConstraintSolver>(fluid)";
    case Warning::kNotFinite:
      return "bullet_ambient: a velocity, force or result of a body in fluid is not finite; the "
             "body kept its velocity or, where that is not finite, stopped";
    case Warning::kNotPhysical:
      return "bullet_ambient: the mass properties of a body in fluid were changed to values that "
             "are not physical; it moves as in a vacuum until they are valid again";
    case Warning::kOtherLinks:
      return "bullet_ambient: a btMultiBody in fluid has other links or joints than when it was "
             "attached, or stands where another one was destroyed; its links have no fluid until "
             "they are attached again";
    case Warning::kRungeKutta:
      return "bullet_ambient: a btMultiBody in fluid has useRK4Integration, which moves it by its "
             "dry mass; it moves as if that was switched off";
    case Warning::kDuration:
      return "bullet_ambient: the world was stepped by a time that is not finite; bodies in fluid "
             "and the time of regions stay as they were";
    case Warning::kUp:
    case Warning::kRegion:  // these name the region or the body
    case Warning::kInertia:
    case Warning::kEmpty:
    case Warning::kAngle:
    case Warning::kNoResistance:
    case Warning::kLight:
    case Warning::kShortPeriod:
    case Warning::kTooLong:
    case Warning::kFastJoint:
    case Warning::kChange:
    case Warning::kOpenJoint:
    case Warning::kCount:
      break;
  }
  return "";
}

}  // namespace

std::string nameOf(const AttachDef& def) {
  if (!def.name.empty()) return "body '" + def.name + "'";
  return "body with fluid body '" + def.fluid_body->name + "'";
}

void Warnings::warnOnce(Warning warning) noexcept { warnOnce(warning, sentenceOf(warning)); }

void Warnings::warnOnce(Warning warning, const char* sentence) noexcept {
  std::atomic<bool>& was_reported = was_reported_[static_cast<int>(warning)];
  if (was_reported.load(std::memory_order_relaxed) || was_reported.exchange(true)) return;
  try {
    report(sentence);
  } catch (...) {
    // Out of memory for the sentence, which must not unwind through Bullet's solver.
  }
}

template <class MakeSentence>
void Warnings::warnByMaking(Warning warning, const MakeSentence& make) noexcept {
  if (was_reported_[static_cast<int>(warning)].load(std::memory_order_relaxed)) return;
  try {
    warnOnce(warning, make().c_str());
  } catch (...) {
    // A failure to make the sentence must not unwind through the step.
  }
}

void Warnings::warnOfShortPeriod(const AttachDef& def, double frequency, double step) noexcept {
  warnByMaking(Warning::kShortPeriod, [&] {
    return "bullet_ambient: a " + nameOf(def) + " floats with a period of " +
           std::to_string(2 * kPi / frequency) + " s and is moved by joints or " +
           "contacts in steps of " + std::to_string(step) +
           " s: in less than four steps a period it swings too slowly; take shorter steps";
  });
}

void Warnings::warnOfOpenJoint(const AttachDef& def, const AttachDef* other) noexcept {
  warnByMaking(Warning::kOpenJoint, [&] {
    const std::string partner = !other ? "one without fluid"
                                : other->name.empty()
                                    ? "one with fluid body '" + other->fluid_body->name + "'"
                                    : nameOf(*other);
    return "bullet_ambient: a joint of a " + nameOf(def) + " and " + partner +
           " comes apart: the solver does not hold it; take more iterations, " +
           "btContactSolverInfo::m_numIterations, shorter steps, or a btMultiBody";
  });
}

void Warnings::warnOfFastJoint(const AttachDef& def, double turns, double step) noexcept {
  warnByMaking(Warning::kFastJoint, [&] {
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, "%.3g turns in a step of %.3g s", turns, step);
    return "bullet_ambient: the world's step is too long for the motion of a " + nameOf(def) +
           ": its joint turns it by " + numbers +
           "; from half a turn on it meets the flow from few sides; take shorter steps; further "
           "bodies of which this is true are only counted";
  });
}

void Warnings::warnOfSunkVessel(const AttachDef& def, std::size_t hold) noexcept {
  try {
    const Hold& filled = def.fluid_body->holds[hold];
    char volume[32];
    std::snprintf(volume, sizeof volume, "%.4g m^3", filled.volume);
    report("bullet_ambient: a " + nameOf(def) + " sinks: its hold '" + filled.name + "' of " +
           volume + " is full of water");
  } catch (...) {
    // A failure to make the sentence must not unwind through the step.
  }
}

void Warnings::warnOfLongSteps(const AttachDef& def) noexcept {
  warnByMaking(Warning::kTooLong, [&] {
    const bool may_chatter = def.flow.law == PressureLaw::kPublished && !def.flow.own_law;
    return "bullet_ambient: the world's step is too long for the motion of a " + nameOf(def) +
           ": errors of its velocity add up to more than 5 per cent; take shorter steps, or allow "
           "it more substeps, say flight.max_substeps = 256" +
           (may_chatter
                ? "; if it has flat sides, the default law, PressureLaw::kForm, needs neither"
                : "") +
           "; further bodies of which this is true are only counted";
  });
}

void Warnings::report(const std::string& sentence) noexcept {
  try {
    const std::lock_guard<std::recursive_mutex> lock(reporting_);
    if (report_) report_(sentence);
  } catch (...) {
    // A user's callback that throws must not unwind through Bullet's solver.
  }
}

}  // namespace ambient
