// Unit, axes and origin of a mesh file: given by the scene, or inferred for a vehicle, with a warning that says what was taken.
#pragma once

#include "scenes/loader/mesh.h"

namespace scenes {

enum class Axis { x, y, z, minus_x, minus_y, minus_z };

/// What the scene says of the file's frame.
struct MeshFrameGiven {
  std::optional<double> scale;  // [m]
  std::optional<Axis> up, forward;
  std::optional<engine::Vec3> centre;  // [m]
};

struct MeshFrame {
  double scale = 1;                              // [m] per unit of the file
  engine::Mat3 turn = engine::Mat3::Identity();  // from the file's axes to ours
  engine::Vec3 centre = engine::Vec3::Zero();    // [m] our origin, seen from the file's, in our axes
};

/// What the keys say; what they leave open stays as in the file.
MeshFrame given_frame(Reader&);
/// For a vehicle: what the keys leave open is inferred from the mesh where the file's own frame cannot be right for one. A car is
/// longest along its way, symmetric across it, some metres long and stands on the ground about its origin.
MeshFrame vehicle_frame(Reader&, const ImportedMesh&);

/// The mesh in that frame; the same one if the frame is the file's own. Kept, so that ten cars share one.
std::shared_ptr<const ImportedMesh> in_frame(Builder&, const std::shared_ptr<const ImportedMesh>&, const MeshFrame&);

/// Keys of a section with a mesh.
inline constexpr Key kMeshScale = bound<&MeshFrameGiven::scale>(
    {"mesh_scale", Type::number, Dimension::none, "",
     "Metres per unit of the mesh file: 0.001 for millimetres. Left out: 1, or inferred for a vehicle, with a warning.",
     kPositive});
inline constexpr Key kMeshUp = bound<&MeshFrameGiven::up>(
    {"mesh_up", Type::choice, Dimension::none, "",
     "The file's axis that points up (glTF and Collada files are turned to z up before). Left out: z, or inferred for a vehicle, "
     "with a warning.",
     kAny, "x|y|z|-x|-y|-z"});
inline constexpr Key kMeshForward = bound<&MeshFrameGiven::forward>(
    {"mesh_forward", Type::choice, Dimension::none, "",
     "The file's axis that points forward. Left out: x, or inferred for a vehicle, with a warning.", kAny, "x|y|z|-x|-y|-z"});
inline constexpr Key kMeshCentre = bound<&MeshFrameGiven::centre>(
    {"mesh_centre", Type::vector3, Dimension::length, "",
     "Where the origin is meant to be, in the file's frame after scale and axes. Left out: the file's origin, or inferred for a "
     "vehicle, with a warning."});
#define CRASHREEL_MESH_KEYS kMeshScale, kMeshUp, kMeshForward, kMeshCentre

}  // namespace scenes
