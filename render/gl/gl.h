// The one place that includes OpenGL: all GL 3.3 functions are exported by libOSMesa itself.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glext.h>
#include <GL/osmesa.h>
