// What the air did in a run that is over.
#pragma once

#include <memory>

#include "engine/model/model.h"
#include "engine/recording.h"

namespace engine {

struct Air;

/// The air of a run; none where its plan had no air resistance.
class AirOfRun {
 public:
  AirOfRun(const Model&, const Recording&);
  ~AirOfRun();

  /// [N s] that it gave a body from one snapshot to another, by the trapezium rule.
  Vec3 impulse(int body, std::size_t from, std::size_t to) const;

 private:
  const Recording& recording_;
  std::unique_ptr<const Air> air_;
};

}  // namespace engine
