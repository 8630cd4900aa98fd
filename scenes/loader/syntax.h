// What a TOML error means to the author of a scene: the parser's words become the slip that was made and what to write instead.
#pragma once

#include <string>
#include <string_view>

#include "scenes/error.h"
#include "scenes/loader/value.h"

namespace scenes {

/// Refuses what is no text in UTF-8: pictures, archives, UTF-16, other encodings. Throws SceneErrors.
void refuse_other_files(std::string_view text, const std::string& name);

/// The error of a text the parser refused at `place` with `description`: forgotten or typographic quotes, a decimal comma, a text
/// or a bracket that is not closed, a key given twice, and the like. What is none of these is told in the parser's words.
Finding syntax_error(std::string_view text, const Place& place, const std::string& description);

}  // namespace scenes
