#include "bullet_ambient/immersed/region_call.h"

AMBIENT_BEGIN
namespace {

thread_local RegionCall* innermost_call = nullptr;

}  // namespace

RegionCall::RegionCall(const FluidRegions& regions) noexcept
    : regions_(regions), outer_(innermost_call) {
  innermost_call = this;
}

RegionCall::~RegionCall() { innermost_call = outer_; }

RegionCall* RegionCall::current(const FluidRegions& regions) noexcept {
  RegionCall* call = innermost_call;
  while (call && &call->regions_ != &regions) call = call->outer_;
  return call;
}

AMBIENT_END
