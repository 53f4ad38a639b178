#pragma once

#include <string>

#include "bullet_ambient/bullet/precision_check.h"

class btDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// @throws std::invalid_argument, in one sentence that begins with `who`, if no fluid can act in
/// worlds of this kind.
void checkWorldKind(const std::string& who, const btDynamicsWorld& world);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
