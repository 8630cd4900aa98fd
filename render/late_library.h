// Libraries that take long to load and that most runs do without are loaded where they are first needed: libav* and OSMesa.
#pragma once

namespace render {

/// A function of a shared library, which is loaded where it is not yet. Throws RenderError: no such library or function.
void* late_function(const char* library, const char* function);

/// What ends the program where a library fails in its constructors, as OSMesa does without memory: it follows a null pointer.
/// Called from a signal's handler, with the signal.
void end_failed_load_by(void (*end)(int));

/// What holds such a function.
template <auto& function>
using PointerTo = decltype(&function);

}  // namespace render
