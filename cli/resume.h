// --resume: what a run with the same fingerprint has finished is kept, the rest is done. Frames say themselves whose they are, so
// there is no journal that could be wrong: a file has its final name only when it is whole.
#pragma once

#include <filesystem>

#include "cli/film_plan.h"

namespace cli {

/// Whether `picture` is there, drawn by a run with the job's fingerprint at this moment. Throws UsageError when it is somebody
/// else's.
bool is_finished(const std::filesystem::path& picture, const render::Moment&, const render::FilmJob&);

/// The film without the frames that are finished.
render::Film unfinished(const render::Film&, const render::FilmJob&);

/// The frames a film was made of, where they have this job's fingerprint, and their folder; what else lies there is left and told.
void remove_frames(const render::FilmJob& frames, bool quiet);

/// Frames of an earlier, longer run, which would go on where a whole film replaces it: those this program made are removed, others
/// are told of and left.
void remove_surplus(const render::Film&, const render::FilmJob&, bool quiet);
/// The same before --resume, which replaces nothing: throws UsageError when there is one.
void refuse_surplus(const render::Film&, const render::FilmJob&);

/// Whether the film is there, whole, with the job's fingerprint. Throws UsageError when it is another film.
bool film_is_finished(const render::FilmJob&);

/// Where the frames of a film are kept until it is whole: OUT.mp4.frames, removed afterwards.
std::filesystem::path frames_folder(const render::FilmJob&);
/// The job of drawing those frames.
render::FilmJob frames_job(const render::FilmJob& film);

}  // namespace cli
