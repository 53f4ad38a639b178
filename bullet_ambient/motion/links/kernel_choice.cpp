#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/links/link_kernel.h"
#include "bullet_ambient/motion/surface/flotation.h"

namespace ambient {

const Kernels<const FlightKernel*> kFlightKernels{AMBIENT_KERNELS(&kFlightKernel)};
const Kernels<const LinkKernel*> kLinkKernels{AMBIENT_KERNELS(&kLinkKernel)};
const Kernels<const SurfaceKernel*> kSurfaceKernels{AMBIENT_KERNELS(&kSurfaceKernel)};

}  // namespace ambient
