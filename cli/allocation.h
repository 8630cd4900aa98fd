// Memory for libraries that do not ask whether they got it.
#pragma once

namespace cli {

/// From the first OpenGL context of a process on, an allocation that fails ends it with exit code 3 and a line on standard error.
/// Mesa goes on where memory ended and leaves out a shadow or a shader; such a picture must not be taken for one. Not in builds
/// with sanitizers, which have allocators of their own.
void end_drawing_where_memory_ends();

}  // namespace cli
