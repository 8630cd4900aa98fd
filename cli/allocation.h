// What becomes of libraries that do not ask whether they got the memory they wanted, or cannot say so.
#pragma once

namespace cli {

/// From the first OpenGL context of a process on, an allocation that fails ends it with exit code 3 and a line on standard error.
/// Mesa goes on where memory ended and leaves out a shadow or a shader; such a picture must not be taken for one. Not in builds
/// with sanitizers, which have allocators of their own. And so ends a std::bad_alloc where nothing may be thrown, as within
/// std::filesystem::directory_iterator, in place of an abort.
void end_where_memory_ends();

}  // namespace cli
