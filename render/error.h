#pragma once

#include <stdexcept>

namespace render {

/// The machine failed (no GL, encoder, disk full): what was being done, to which path, why.
struct RenderError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace render
