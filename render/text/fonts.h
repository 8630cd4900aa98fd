// Whether letters can be drawn at all: without a font the text library draws none and says nothing.
#pragma once

#include <string>

namespace render {

inline constexpr const char* kFont = "DejaVu Sans";

/// Throws RenderError where the system has no font: a picture without its caption and its disclaimer would say too much.
void require_font();

/// The letters of a text that the font of pictures lacks, each once: they are drawn as boxes.
std::string without_glyph(const std::string& text);

/// The text with U+FFFD in place of what is no UTF-8, as in names of files: the text library would complain of it on standard
/// error.
std::string drawable(const std::string& text);

}  // namespace render
