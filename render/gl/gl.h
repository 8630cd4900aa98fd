// The one place that includes OpenGL: all GL 3.3 functions are exported by libOSMesa itself.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>

// after osmesa.h, whose types it needs
#include <GL/glext.h>
