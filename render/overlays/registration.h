// What an overlay's file ends with: its class, and `template struct Drawn<...>`.
#pragma once

#include "render/overlays/overlay.h"

namespace render {

template <class T>
const Overlay Drawn<T>::overlay = T::kOverlay;

}  // namespace render
