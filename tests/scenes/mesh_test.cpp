// Meshes through the cage: what comes back, what is warned of, and what cannot get out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <variant>

#include "scene_file.h"
#include "scenes/loader/mesh.h"

namespace scenes {
namespace {

using scenes::testing::SceneFolder;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A box as OBJ, outward faces, length x 1.8 x 1.4 m, from the ground up.
std::string box(double length, bool inside_out = false) {
  std::string out = "mtllib box.mtl\nusemtl paint\n";
  for (int i = 0; i < 8; ++i) {
    out += "v " + std::to_string((i & 1 ? 0.5 : -0.5) * length) + (i & 2 ? " 0.9" : " -0.9") + (i & 4 ? " 1.4\n" : " 0.0\n");
  }
  const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (const auto& q : quads) {
    out += "f";
    for (int k = 0; k < 4; ++k) out += " " + std::to_string(q[inside_out ? 3 - k : k]);
    out += "\n";
  }
  return out;
}

const std::string kCar = R"(
[[vehicle]]
name = "car"
mesh = "car.obj"
mass = "1500 kg"
cg = "0.1 0 0.5 m"
inertia = "500 2500 2600 kg m^2"
front = "-1 2 m"
speed = "36 km/h"
)";

TEST(MeshImport, BringsABoxBackWhole) {
  const SceneFolder folder;
  folder.write("car.obj", box(4));
  folder.write("box.mtl", "newmtl paint\nKd 0.5 0.1 0.1\n");
  const Scene scene = folder.load(kCar);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto& solid = *std::get<engine::MeshShape>(scene.model.bodies[0].shape).mesh;
  ASSERT_EQ(solid.triangles().size(), 12u);
  // faces that were apart for their normals are one closed surface again
  for (int t = 0; t < 12; ++t)
    for (int edge = 0; edge < 3; ++edge) EXPECT_GE(solid.neighbour(t, edge), 0);
  ASSERT_EQ(scene.stage.meshes.size(), 1u);
  const render::Mesh& look = *scene.stage.meshes[0].mesh;
  EXPECT_EQ(look.indices.size(), 36u);
  EXPECT_EQ(look.normals.size(), look.positions.size());
  EXPECT_EQ(look.materials[0].kind, render::MaterialKind::paint);
  // the front bumper's middle at (-1, 2): the box is 4 m long, its centre of mass 0.1 m ahead of its middle
  EXPECT_NEAR(scene.model.bodies[0].X_WB.p.x(), -1 - 2 + 0.1, 1e-9);
  EXPECT_NEAR(scene.model.bodies[0].X_WB.p.y(), 2, 1e-9);
  EXPECT_NEAR(scene.model.bodies[0].V_WB.v.x(), 10, 1e-12);
}

TEST(MeshImport, LoadsOneMeshForTenCars) {
  const SceneFolder folder;
  folder.write("car.obj", box(4));
  std::string text;
  for (int i = 0; i < 10; ++i) {
    std::string car = kCar;
    car.replace(car.find("\"car\""), 5, "\"car" + std::to_string(i) + "\"");
    text += car;
  }
  const Scene scene = folder.load(text);
  for (const render::MeshActor& actor : scene.stage.meshes) EXPECT_EQ(actor.mesh, scene.stage.meshes[0].mesh);
}

TEST(MeshAudit, WarnsOfScaleAndOfFacesTurnedInwards) {
  const SceneFolder folder;
  folder.write("car.obj", box(400, true));
  const Scene scene = folder.load(kCar);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("is 400 m long; is its scale right?")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("car.obj is inside out")));
}

/// A wedge like a car: 4.2 m long, 1.8 m wide, 1.4 m high over the ground at 0.2 m; a low bonnet makes it lopsided in height.
/// Corners pass through `place` into the file.
template <typename Place>
std::string wedge(Place place) {
  std::string out = "usemtl paint\n";
  for (int i = 0; i < 8; ++i) {
    const engine::Vec3 p(i & 1 ? 2.1 : -2.1, i & 2 ? 0.9 : -0.9, i & 4 ? (i & 1 ? 0.7 : 1.6) : 0.2);
    const engine::Vec3 q = place(p);
    out += "v " + std::to_string(q.x()) + " " + std::to_string(q.y()) + " " + std::to_string(q.z()) + "\n";
  }
  const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (const auto& q : quads) {
    out += "f";
    for (const int k : q) out += " " + std::to_string(k);
    out += "\n";
  }
  return out;
}

engine::Aabb box_of_car(const Scene& scene) {
  const auto& shape = std::get<engine::MeshShape>(scene.model.bodies[0].shape);
  engine::Aabb box = shape.mesh->bounds();
  return box;
}

void expect_upright(const Scene& scene) {
  const engine::Aabb box = box_of_car(scene);
  EXPECT_LT((box.lower - engine::Vec3(-2.1, -0.9, 0.2)).norm(), 0.03);
  EXPECT_LT((box.upper - engine::Vec3(2.1, 0.9, 1.6)).norm(), 0.03);
  // the low end is in front: seen along x, the highest point lies behind the middle
  const auto& mesh = *std::get<engine::MeshShape>(scene.model.bodies[0].shape).mesh;
  for (const engine::Vec3& v : mesh.vertices()) EXPECT_TRUE(v.z() < 1.5 || v.x() < 0);
}

TEST(MeshFrame, IsTakenFromTheKeys) {
  const SceneFolder folder;
  // millimetres, y up, z forward, origin at the front bumper on the ground
  folder.write("car.obj",
               wedge([](const engine::Vec3& p) { return engine::Vec3(1000 * p.y(), 1000 * p.z(), 1000 * (p.x() - 2.1)); }));
  const Scene scene =
      folder.load(kCar + "mesh_scale = 0.001\nmesh_up = \"y\"\nmesh_forward = \"z\"\nmesh_centre = \"-2.1 0 0 m\"\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  expect_upright(scene);
}

TEST(MeshFrame, IsInferredWithAWarningEach) {
  const SceneFolder folder;
  folder.write("car.obj", wedge([](const engine::Vec3& p) { return engine::Vec3(100 * p.y(), 100 * p.z(), 100 * (p.x() - 2.1)); }));
  const Scene scene = folder.load(kCar);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("taken to be in centimetres; write mesh_scale = 0.01")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("write mesh_up = \"y\" and mesh_forward = \"z\"")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("write mesh_centre = \"-2.1 0 0 m\"")));
  expect_upright(scene);
}

TEST(MeshFrame, InInchesWithYUpAlongX) {
  const SceneFolder folder;
  // y up and x forward: left is -z
  folder.write("car.obj",
               wedge([](const engine::Vec3& p) { return engine::Vec3(p.x() / 0.0254, p.z() / 0.0254, -p.y() / 0.0254); }));
  const Scene scene = folder.load(kCar);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("taken to be in inches")));
  expect_upright(scene);
}

TEST(MeshFrame, NeedsTwoAxes) {
  const SceneFolder folder;
  folder.write("car.obj", box(4));
  EXPECT_THAT(folder.errors(kCar + "mesh_up = \"x\"\nmesh_forward = \"-x\"\n"),
              ::testing::ElementsAre(HasSubstr("must be another axis than mesh_up")));
}

TEST(MeshFrame, HoldsForBodiesToo) {
  const SceneFolder folder;
  folder.write("block.obj", box(400));
  const Scene scene = folder.load(
      "[[body]]\nname = \"block\"\nmesh = \"block.obj\"\nfixed = true\nmesh_scale = 0.01\nmesh_centre = \"0 0 0.7 cm\"\n");
  const engine::Aabb box = box_of_car(scene);
  EXPECT_LT((box.upper - engine::Vec3(2, 0.009, 0.007)).norm(), 1e-6);
}

TEST(MeshAudit, WarnsOfHoles) {
  const SceneFolder folder;
  const std::string whole = box(4);
  // without its last face, a quad
  folder.write("car.obj", whole.substr(0, whole.rfind("f")));
  EXPECT_THAT(folder.load(kCar).warnings, Contains(HasSubstr("is open at 4 edges")));
}

TEST(MeshAudit, RefusesWhatCannotBeTouched) {
  // what has no surface has no bounds either, and would stand nowhere
  const SceneFolder folder;
  folder.write("car.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_THAT(folder.errors(kCar), ::testing::ElementsAre(HasSubstr("has no triangle with an area; there is nothing to touch")));
  folder.write("car.obj", box(4));
  EXPECT_THAT(folder.errors(kCar + "mesh_scale = 1e-12\n"),
              ::testing::ElementsAre(HasSubstr("mesh_scale is 1e-12: leaves no triangle with an area")));
}

TEST(MeshAudit, CountsDegenerateAndDuplicateTriangles) {
  RawPart part;
  part.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0};
  part.indices = {0, 1, 2, 0, 1, 2, 0, 1, 3};
  EXPECT_THAT(audit({part}, "m"), ::testing::ElementsAre("m has 1 degenerate triangles; they are left out of contact",
                                                         "m has 1 duplicate triangles; they are left out of contact"));
}

TEST(MeshCage, OpensNothingOutsideItsFolder) {
  const SceneFolder folder;
  folder.write("secret/colour.mtl", "newmtl paint\nKd 1 0 0\n");
  const auto file = folder.write("inner/car.obj", "mtllib ../secret/colour.mtl\n" + box(4));
  const CageResult caged = import_in_cage(file, folder.path() / "inner");
  ASSERT_EQ(caged.problem, "");
  // the material's red never arrived
  EXPECT_NE(caged.parts[0].colour[1], 0.0f);
  const CageResult open = import_in_cage(file, folder.path());
  ASSERT_EQ(open.problem, "");
  EXPECT_EQ(open.parts[0].colour[1], 0.0f);
}

TEST(MeshCage, IsAsTightForAFileInTheWorkingFolder) {
  // a scene given as "case.toml" has an empty folder name; that must not mean the whole disk
  const SceneFolder folder;
  folder.write("secret/colour.mtl", "newmtl paint\nKd 1 0 0\n");
  folder.write("inner/car.obj", "mtllib ../secret/colour.mtl\n" + box(4));
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path() / "inner");
  const CageResult caged = import_in_cage("car.obj", "");
  std::filesystem::current_path(before);
  ASSERT_EQ(caged.problem, "");
  EXPECT_NE(caged.parts[0].colour[1], 0.0f);
}

TEST(MeshCage, SurvivesRubbish) {
  const SceneFolder folder;
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.3ds", "a.glb", "a.fbx"}) {
    std::string bytes;
    for (int i = 0; i < 3000; ++i) bytes += static_cast<char>((i * 7919 + i * i * 31) >> 3);
    const CageResult result = import_in_cage(folder.write(name, bytes), folder.path());
    EXPECT_TRUE(!result.problem.empty() || result.parts.empty() || result.parts[0].indices.size() % 3 == 0) << name;
  }
}

TEST(MeshCage, EndsAnImportThatNeverEnds) {
  // four thousand million vertices announced and none there: the reader of this format asks for each of them
  const SceneFolder folder;
  const auto file = folder.write("bomb.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\nrubbish\n");
  const CageResult result = import_in_cage(file, folder.path(), {.cpu_time = 1});
  // whichever comes first on this machine
  EXPECT_THAT(result.problem,
              ::testing::AnyOf("the import took more than 1 s of processor time; convert the file to OBJ, or thin it out",
                               "it needs more memory than the import may take"));
}

TEST(MeshCage, SaysThatMemoryEnded) {
  const SceneFolder folder;
  const auto file = folder.write("car.obj", box(4));
  std::string many = box(4);
  for (int i = 0; i < 300'000; ++i) many += "v 1 2 3\nf 1 2 " + std::to_string(9 + i) + "\n";
  EXPECT_EQ(import_in_cage(folder.write("many.obj", many), folder.path(), {.memory = 40u << 20}).problem,
            "it needs more memory than the import may take");
  EXPECT_EQ(import_in_cage(file, folder.path(), {.largest = 100}).problem, "what stands in it needs more than 0 MB; thin it out");
}

TEST(KeptImport, IsWhatTheCageSaysOfEveryMeshOfTheLibrary) {
  const std::filesystem::path library = std::string(CRASHREEL_SOURCE_DIR) + "/assets/vehicles";
  int meshes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(library)) {
    if (entry.path().extension() != ".obj") continue;
    const auto kept = imported_before(entry.path(), library);
    ASSERT_TRUE(kept) << entry.path();
    EXPECT_EQ(kept->sha256, import_in_cage(entry.path(), library).sha256) << entry.path();
    EXPECT_FALSE(kept->parts.empty());
    ++meshes;
  }
  EXPECT_GT(meshes, 20);
}

TEST(KeptImport, IsNotTakenOfAnotherMeshOrDamaged) {
  const SceneFolder folder;
  const auto car = folder.write("car.obj", box(4));
  folder.write("car.mtl", "newmtl paint\nKd 1 0 0\n");
  const std::string kept = kept_import(car);
  const auto taken = [&] { return imported_before(car, folder.path()).has_value(); };
  EXPECT_FALSE(taken()) << "none is there";
  folder.write("car.obj.imported", kept);
  EXPECT_TRUE(taken());
  EXPECT_FALSE(imported_before(car, folder.path() / "..")) << "not of the library";
  folder.write("car.obj.imported", kept.substr(0, kept.size() - 1));
  EXPECT_FALSE(taken()) << "cut off";
  std::string other = kept;
  other.back() = static_cast<char>(other.back() ^ 1);
  folder.write("car.obj.imported", other);
  EXPECT_FALSE(taken()) << "one bit";
  folder.write("car.obj.imported", kept);
  folder.write("car.mtl", "newmtl paint\nKd 0 1 0\n");
  EXPECT_FALSE(taken()) << "another colour";
  folder.write("car.mtl", "newmtl paint\nKd 1 0 0\n");
  EXPECT_TRUE(taken());
  folder.write("car.obj", box(4.5));
  EXPECT_FALSE(taken()) << "another shape";
}

TEST(MeshAudit, TakesSecondsForMillionsOfTriangles) {
  // 4 million triangles, each twice: 20 s with a sorted set
  RawPart part;
  for (std::uint32_t i = 0; i < 2'000'000; ++i) {
    for (const float x : {static_cast<float>(i), 0.0f, 0.0f}) part.positions.push_back(x);
    if (i < 2) continue;
    for (int twice = 0; twice < 2; ++twice)
      for (const std::uint32_t k : {i - 2, i - 1, i}) part.indices.push_back(k);
  }
  const std::clock_t before = std::clock();
  const auto found = audit({part}, "m");
  EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 6);
  EXPECT_THAT(found, Contains("m has 1999998 duplicate triangles; they are left out of contact"));
}

TEST(Panels, NothingBelowTheMiddleOfTheWindscreenIsARoof) {
  for (const std::string model : {"sedan", "suv", "van"}) {
    const Scene scene = scenes::testing::folder().load("[[vehicle]]\nname = \"car\"\nmodel = \"" + model +
                                                       "\"\nfront = \"0 0 m\"\nspeed = \"10 km/h\"\n");
    const auto& shape = std::get<engine::MeshShape>(scene.model.bodies[0].shape);
    ASSERT_TRUE(shape.panels) << model;
    const auto& mesh = *shape.mesh;
    const auto centre = [&](std::size_t t) {
      engine::Vec3 sum = engine::Vec3::Zero();
      for (const int v : mesh.triangles()[t]) sum += mesh.vertices()[static_cast<std::size_t>(v)] / 3;
      return sum;
    };
    double low = 1e9, high = -1e9;
    for (std::size_t t = 0; t < shape.panels->size(); ++t)
      if ((*shape.panels)[t] == engine::Panel::windscreen) low = std::min(low, centre(t).z()), high = std::max(high, centre(t).z());
    ASSERT_LT(low, high) << model;
    int wings = 0, roofs = 0;
    for (std::size_t t = 0; t < shape.panels->size(); ++t) {
      const engine::Vec3 p = centre(t);
      const bool up = mesh.face_normals()[t].z() > 0.6;
      // the frame of the pane is of it, and moves its middle by some centimetres
      if ((*shape.panels)[t] == engine::Panel::roof) {
        ++roofs;
        EXPECT_GT(p.z(), 0.5 * (low + high) - 0.1) << model << " " << p.transpose();
      }
      if ((*shape.panels)[t] == engine::Panel::bonnet && up && std::abs(p.y()) > 0.7) ++wings;
    }
    EXPECT_GT(roofs, 0) << model;
    EXPECT_GT(wings, 0) << model << ": the wings beside the bonnet count as bonnet";
  }
}

TEST(MeshKinds, OutsideTheListAreRefused) {
  const SceneFolder folder;
  folder.write("car.blend", "BLENDER");
  std::string car = kCar;
  car.replace(car.find("car.obj"), 7, "car.blend");
  const auto errors = folder.errors(car);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_THAT(errors[0], HasSubstr("must be a mesh file of a known kind: .obj .stl"));
}

TEST(LibraryVehicles, AreClosedAtTheWheelsSeenFromBelow) {
  const SceneFolder folder;
  for (const std::string model : {"small_car", "sedan", "suv"}) {
    const Scene scene = folder.load("[[vehicle]]\nname = \"car\"\nmodel = \"" + model + "\"\n");
    const render::MeshActor& actor = scene.stage.meshes[0];
    std::vector<engine::Vec3> vertices;
    for (std::size_t i = 0; i + 2 < actor.mesh->positions.size(); i += 3)
      vertices.emplace_back(actor.mesh->positions[i], actor.mesh->positions[i + 1], actor.mesh->positions[i + 2]);
    std::vector<engine::Triangle> triangles;
    for (std::size_t i = 0; i + 2 < actor.mesh->indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) { return static_cast<std::int32_t>(actor.mesh->indices[i + k]); };
      triangles.push_back({corner(0), corner(1), corner(2)});
    }
    const engine::TriangleMesh look(vertices, triangles);
    for (const engine::Wheel& wheel : scene.model.vehicles[0].wheels) {
      const engine::Vec3 hub = actor.X_BM.inverse() * wheel.hub_B;
      const double inwards = hub.y() > 0 ? -1 : 1;
      for (int i = -15; i <= 15; ++i)
        for (int k = 0; k <= 20; ++k) {
          // from beside the tyre to well under the floor
          const engine::Vec3 below(hub.x() + 0.02 * i + 0.001, hub.y() + inwards * (0.1 + 0.02 * k) + 0.0005, -1);
          double up = 0;
          int triangle = -1;
          ASSERT_TRUE(look.raycast(below, engine::Vec3::UnitZ(), 5, up, triangle)) << model;
          // the well is at most 0.42 m round; through a hole one sees the roof, or the bonnet 0.5 m over the hub
          EXPECT_LT(up - 1 - hub.z(), 0.43) << model << " at " << below.transpose();
        }
    }
  }
}

}  // namespace
}  // namespace scenes
