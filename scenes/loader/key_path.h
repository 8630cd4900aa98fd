// "vehicle.sedan.speed": which line of the value tables a path means.
#pragma once

#include <string>

#include "scenes/loader/table.h"
#include "scenes/loader/value.h"

namespace scenes {

struct KeyOfPath {
  const Key* key = nullptr;
  const Value* value = nullptr;  // what stands there; nullptr: the default, or the library's
  std::string problem;           // empty: found. Else what to say after the path
};

/// Lists of tables are walked by name or number, sections with or without a plural s, as in --set.
KeyOfPath key_of_path(const Value& root, const std::string& path);

}  // namespace scenes
