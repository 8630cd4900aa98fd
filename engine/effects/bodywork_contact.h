#pragma once

#include <vector>

#include "engine/contact/contact.h"

namespace engine {

/// Contacts of two bodies with meshes as they stand, normals from b to a; none if the two may not meet. Valid until the next call.
const std::vector<SurfaceContact>& contacts_of_meshes(const Outlook&, int a, int b);

}  // namespace engine
