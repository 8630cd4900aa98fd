// The one place that includes OpenGL. Its functions are found when the first context is made: from libOSMesa, or through EGL.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>

// after osmesa.h, whose types it needs
#include <GL/glext.h>

#include "render/late_library.h"

// clang-format off
#define RENDER_GL_FUNCTIONS(X) \
  X(glActiveTexture) X(glAttachShader) X(glBindBuffer) X(glBindBufferBase) X(glBindFramebuffer) X(glBindRenderbuffer) \
  X(glBindTexture) X(glBindVertexArray) X(glBlendFunc) X(glBlitFramebuffer) X(glBufferData) X(glCheckFramebufferStatus) \
  X(glClear) X(glClearBufferfv) X(glClearBufferiv) X(glCompileShader) X(glCreateProgram) X(glCreateShader) X(glDeleteBuffers) \
  X(glDeleteFramebuffers) X(glDeleteProgram) X(glDeleteRenderbuffers) X(glDeleteShader) X(glDeleteTextures) \
  X(glDeleteVertexArrays) X(glDepthFunc) X(glDepthMask) X(glDisable) X(glDrawArrays) X(glDrawBuffer) X(glDrawElements) \
  X(glEnable) X(glEnableVertexAttribArray) X(glFramebufferRenderbuffer) X(glFramebufferTexture2D) X(glGenBuffers) \
  X(glGenFramebuffers) X(glGenRenderbuffers) X(glGenTextures) X(glGenVertexArrays) X(glGetAttribLocation) X(glGetError) \
  X(glGetIntegerv) X(glGetProgramInfoLog) X(glGetProgramiv) X(glGetShaderInfoLog) X(glGetShaderiv) X(glGetString) \
  X(glGetUniformLocation) X(glLinkProgram) X(glPixelStorei) X(glPolygonOffset) X(glReadBuffer) X(glReadPixels) \
  X(glRenderbufferStorageMultisample) X(glScissor) X(glShaderSource) X(glTexImage2D) X(glTexParameteri) X(glUniform1f) \
  X(glUniform1i) X(glUniform3f) X(glUniform3i) X(glUniformMatrix4fv) X(glUseProgram) X(glVertexAttribIPointer) \
  X(glVertexAttribPointer) X(glViewport)
// clang-format on

namespace render {

// In this namespace a call finds these and not the functions of a library that would be loaded at every start.
#define RENDER_DECLARE(name) inline PointerTo<::name> name = nullptr;
RENDER_GL_FUNCTIONS(RENDER_DECLARE)
#undef RENDER_DECLARE

}  // namespace render
