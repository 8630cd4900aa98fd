// Sixteen segments, fifteen undamped joints, 77.4 kg, 1.74 m: the scenes other engines are measured on too. The figures are those
// of the comparison (spherical joints and four hinges with limits, friction 0.6, restitution 0); segments are hyper-ellipsoids.
#pragma once

#include <string>

#include "engine/model/model.h"

namespace benchmark {

/// flight: free motion of every joint, 1 s. drop: at rest, lowest point 1 m up. throw: the same at 10 m/s.
/// vehicle: standing, struck from the side by a braked car of 1500 kg at 11 m/s with a box of 20,000 triangles as its body.
/// `shift` [m] moves the start sideways: an ensemble of micrometres shows how much of an answer is chance.
engine::Model common_scene(const std::string& name, double step, double shift = 0);

/// Turns the first person about the y axis through its first body [rad].
void tilt(engine::Model&, double angle);

/// Each segment of the first person as three balls of its radius, fixed to it: the capsules of the comparison, as far as a row of
/// balls is one. Neighbours' balls may meet where capsules of one joint may not.
void give_capsules(engine::Model&);

/// Figures lying on the ground, thrown, or struck, `count` of them 5 m apart, from number `first` on. Each starts a little faster
/// or higher than the one before it: what limbs do after a blow hangs on last digits, and of equal starts all would do the same.
engine::Model crowd(const std::string& what, int first, int count, double step);

/// The vehicle scene with a mesh of about `triangles`.
engine::Model struck_by_mesh(int triangles, double step);

/// A box as a mesh with every face divided; about `triangles` of them.
std::shared_ptr<const engine::TriangleMesh> box_mesh(const engine::Vec3& half, int triangles);

}  // namespace benchmark
