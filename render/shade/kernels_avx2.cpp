// The same source, compiled for processors with AVX2 (see CMakeLists.txt).
#include "render/shade/i420.h"
#include "render/shade/project.h"
#include "render/shade/surface.h"

namespace render::shade {

extern const Kernels kAvx2Kernels;
const Kernels kAvx2Kernels{background, surfaces, project, i420, occlusion};

}  // namespace render::shade
