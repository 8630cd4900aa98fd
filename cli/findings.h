// How errors and warnings of scenes are shown: for people with the line of the file and a mark under the place, for scripts as
// fields.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenes/error.h"

namespace cli {

/// "file:line:column: what", and below it the line with a caret under the column, where the file can still be read. What an option
/// set is told as the program's other errors are: "crashreel: --set ...: what".
std::string finding_text(const scenes::Finding&);

/// file, line and column (null where there is none), code, message.
nlohmann::ordered_json finding_json(const scenes::Finding&);

/// "file:line:column: what" taken apart again, as warnings are kept.
scenes::Finding finding_of(const std::string& line, const std::string& code);

}  // namespace cli
