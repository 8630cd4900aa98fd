// What a result depends on, as one number: two results with the same fingerprint are the same result.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/arguments.h"
#include "scenes/scene.h"

namespace cli {

/// A frame does not change with the part of the film that is asked for; a film does.
enum class ResultKind { frame, whole };

/// SHA-256 over version and libraries, scene file with overrides, library files and meshes read, and every option given that a
/// result of this kind depends on. An option unknown here counts. Of pictures also the hash of the recording they show: frames of
/// two runs that differ, for whatever reason, never join.
std::string fingerprint(ResultKind, const scenes::Scene&, const Arguments&, std::optional<std::uint64_t> recording = {});

}  // namespace cli
