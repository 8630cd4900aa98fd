// Libraries that take long to load and that most runs do without are loaded where they are first needed: libav* and OSMesa.
#pragma once

namespace render {

/// A function of a shared library, which is loaded where it is not yet. Throws RenderError: no such library or function.
void* late_function(const char* library, const char* function);

/// Whether a library is being loaded. Some end the program from their constructors where they get no memory.
bool is_loading_library();

/// What holds such a function.
template <auto& function>
using PointerTo = decltype(&function);

}  // namespace render
