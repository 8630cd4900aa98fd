// A run's whole recording as a file beside its tables, so that pictures of the run need no second simulation.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/bytes.h"
#include "engine/model/model.h"
#include "engine/recording.h"
#include "scenes/scene.h"

namespace cli {

constexpr const char* kRecordingFile = "recording.bin";

/// What the file holds behind its key: the recording as bytes, without the times of computing. And back; nothing when they are
/// damaged, or of no run of this model.
engine::Bytes payload_of(const engine::Recording&);
std::optional<engine::Recording> recording_of(const engine::Bytes& payload, const engine::Model&);

/// The recording as bytes, for one scene and one program. Times of computing are left out: equal runs, equal files.
std::string recording_bytes(const scenes::Scene&, const engine::Recording&);

/// The recording in such a file; nothing when there is none, when another program or another scene made it, or when it is damaged.
std::optional<engine::Recording> read_recording(const std::filesystem::path&, const scenes::Scene&);

}  // namespace cli
