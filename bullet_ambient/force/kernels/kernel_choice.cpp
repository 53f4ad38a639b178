#include "bullet_ambient/force/kernels/hull_sums.h"
#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/force/kernels/single_sums.h"

namespace ambient {

const Kernels<SumBlocks> kSumBlocks{AMBIENT_KERNELS(sumBlocks)};
const Kernels<const HullKernel*> kHullKernels{AMBIENT_KERNELS(&kHullKernel)};
const Kernels<const PartKernel*> kPartKernels{AMBIENT_KERNELS(&kPartKernel)};

}  // namespace ambient
