// Whether the disk has room for a film: looked for before the work, where the film will be written.
#pragma once

#include <optional>
#include <string>

#include "render/film.h"

namespace cli {

/// A sentence where the disk that the job writes to has less room than `frames` pictures may take; nothing where it has enough, or
/// where that is not known. Folders of the output need not be there yet.
std::optional<std::string> short_of_room(const render::FilmJob&, int frames);

}  // namespace cli
