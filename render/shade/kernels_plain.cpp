// For every x86-64 processor, and for others.
#include "render/shade/i420.h"
#include "render/shade/project.h"
#include "render/shade/surface.h"

namespace render::shade {

extern const Kernels kPlainKernels;
const Kernels kPlainKernels{background, surfaces, project, i420, occlusion};

}  // namespace render::shade
