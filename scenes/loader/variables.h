// [variables]: names for quantities, and every value of the scene that is reckoned from them.
#pragma once

#include "scenes/loader/reader.h"

namespace scenes {

extern const Section kVariablesSection;

/// Puts the value in place of every expression of the scene, each checked for the dimension its key asks for. What remains is a
/// scene without variables. Throws SceneErrors with all of them where an expression is wrong.
void resolve_variables(Value& root, Errors&);

}  // namespace scenes
