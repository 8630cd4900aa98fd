// The same stills and films by this crashreel and by another, by turns.
#pragma once

#include <string>

namespace benchmark {

/// Prints memory and time of stills, with empty caches of files if we may empty them, then frames a second and processor time of
/// films from a fixed and a moving camera, medians of five; the film's is that of the whole program less that of `simulate`.
/// `other`: a command, "env CRASHREEL_HOME=... crashreel".
void beside(const std::string& scene, int frames, const std::string (&cameras)[2], const std::string& other,
            const std::string& its_scene);

}  // namespace benchmark
