// Friction ends the slip of a free body, or turns it, at an instant within the step.
#pragma once

#include "engine/step_context.h"

namespace engine {

/// When the slip of a contact would be spent.
struct SlipEnd {
  std::uint64_t key = 0;  // of the contact
  double time = 0;        // [s] after the start of the step, were friction spent all along against the slip there was
};

/// The first slip that a step taken ended or turned, of rigid contacts between free bodies. With `key` of that contact alone,
/// whether it slips still or not.
std::optional<SlipEnd> slip_end(const StepContext&, std::optional<std::uint64_t> key = std::nullopt);

}  // namespace engine
