// The implicit surface of a person: negative inside.
#pragma once

#include <vector>

#include "render/stage.h"
#include "render/surface/anatomy.h"

namespace render {

class SkinField {
 public:
  explicit SkinField(const PersonActor&);

  /// [m], zero on the surface, grows along rays from the segments' centres; `distances` gets that to each segment alone.
  double at(const Vec3&, std::vector<double>& distances) const;
  Vec3 normal(const Vec3&) const;
  /// The point of the surface near x.
  Vec3 onto_surface(Vec3 x) const;

  /// Box around the surface.
  void bounds(Vec3& lower, Vec3& upper) const;
  const std::vector<Pose>& poses() const { return X_MS_; }
  int parent(std::size_t segment) const { return person_.segments[segment].parent; }

 private:
  struct Joint {
    std::size_t parent, child;
    Vec3 centre;
    double radius;  // [m] of the ball
    double blend;   // [m] width of the fillet
  };

  struct Look {
    const Anatomy* anatomy;
    bool mirrored;
    engine::Mat3 R_SM;
    Vec3 p_SM;
  };

  const PersonActor& person_;
  std::vector<Look> looks_;
  std::vector<Pose> X_MS_;
  std::vector<Joint> joints_;
};

}  // namespace render
