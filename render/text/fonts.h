// Whether letters can be drawn at all: without a font the text library draws none and says nothing.
#pragma once

namespace render {

inline constexpr const char* kFont = "DejaVu Sans";

/// Throws RenderError where the system has no font: a picture without its caption and its disclaimer would say too much.
void require_font();

}  // namespace render
