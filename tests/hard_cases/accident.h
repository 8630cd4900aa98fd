// Accidents nobody thought of, as the text of a scene: for the tests of them, and for lists of hashes.
#pragma once

#include <string>

namespace hard_cases {

/// A library vehicle and a person or two, some against a second vehicle, on a bicycle, lying or sitting on the road, at 5 to
/// 100 km/h and one of three steps; x > 0 is where the first vehicle goes. The same number gives the same text everywhere.
std::string accident(unsigned number, const char* law);

}  // namespace hard_cases
