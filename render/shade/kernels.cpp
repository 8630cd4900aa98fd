#include "render/shade/kernels.h"

namespace render::shade {

extern const Kernels kPlainKernels;
extern const Kernels kAvx2Kernels;

const Kernels& kernels() {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  return wide ? kAvx2Kernels : kPlainKernels;
#else
  return kPlainKernels;
#endif
}

const Kernels& plain_kernels() {
  return kPlainKernels;
}

}  // namespace render::shade
