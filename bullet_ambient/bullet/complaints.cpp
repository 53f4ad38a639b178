#include "bullet_ambient/bullet/complaints.h"

#include <utility>

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

const char* sentenceOf(Complaint complaint) {
  switch (complaint) {
    case Complaint::kNoAction:
      return "bullet_ambient: bodies in fluid moved without their AmbientAction; call "
             "Fluid::attachTo(world), or world->addAction(&action)";
    case Complaint::kNoSolver:
      return "bullet_ambient: bodies in fluid are awake but their AmbientSolver was not called; "
             "call Fluid::attachTo(world), construct the world with the solver or call "
             "world->setConstraintSolver(&solver)";
    case Complaint::kNoMultiBodySolver:
      return "bullet_ambient: bodies in fluid are awake but their AmbientSolver was not called: "
             "setConstraintSolver does not reach the bodies of a btMultiBodyDynamicsWorld; call "
             "world->setMultiBodyConstraintSolver(&solver) with an "
             "AmbientSolver<btMultiBodyConstraintSolver>, or Fluid::attachTo(world)";
    case Complaint::kNotFinite:
      return "bullet_ambient: a velocity, force or result of a body in fluid is not finite; the "
             "body kept its velocity or, where that is not finite, stopped";
    case Complaint::kNotPhysical:
      return "bullet_ambient: the mass properties of a body in fluid were changed to values that "
             "are not physical; it moves as in a vacuum until they are valid again";
    case Complaint::kCoarse:
      return "bullet_ambient: a step was too long for the motion of a body in fluid: its error "
             "stayed above the tolerance at the largest number of substeps; raise "
             "FlightSettings::max_substeps, or take shorter steps of the world";
    case Complaint::kInertia:  // these name the body
    case Complaint::kEmpty:
    case Complaint::kCount:
      break;
  }
  return "";
}

}  // namespace

void Complaints::say(Complaint complaint) noexcept { say(complaint, sentenceOf(complaint)); }

void Complaints::say(Complaint complaint, const char* sentence) noexcept {
  if (std::exchange(was_said_[static_cast<int>(complaint)], true)) return;
  try {
    if (report) report(sentence);
  } catch (...) {
    // A user's callback that throws must not unwind through Bullet's solver.
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
