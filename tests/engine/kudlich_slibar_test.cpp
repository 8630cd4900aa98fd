// The impulse model against published numbers, its closed forms in a run, and the choice between the two collision models.
#include "engine/solver/kudlich_slibar.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "engine/geometry/mesh_overlap.h"
#include "engine/math/functions.h"
#include "engine/measure/metrics.h"
#include "tests/engine/experiment.h"

namespace engine::test {
namespace {

/// A car into a fixed barrier: geometry of test CF11002 of the Insurance Institute for Highway Safety, results of a published
/// spreadsheet (full impact) and of an independent three-dimensional computation (sliding impact), seven digits each.
struct Published {
  double mu;
  bool sliding;
  Vec3 P, dv;       // [N s], [m/s]
  double dw_z_deg;  // [deg/s]
  double energy;    // [J]
  double P_digit;   // [N s] one unit in the last printed digit, and so on
  double dv_digit, dw_digit, energy_digit;
};
const std::array kPublished{
    Published{0.82, false, {-25872.82, -5503.524, 0}, {-15.97163, -3.3974, 0}, 176.4298, 231060.6, 0.01, 1e-4, 1e-4, 0.1},
    Published{0.03, true, {-25800.649, -6280.763, 0}, {-15.92708, -3.8772, 0}, 160.11512, 230744.0, 1e-3, 1e-4, 1e-5, 0.1},
};
constexpr double kMass1 = 1619.923226, kMass2 = 4532267.992857;                     // [kg]
const Vec3 kInertia1(600, 2900, 3167.597473), kInertia2(9e7, 1.9e8, 235385060.47);  // roll, pitch take no part in a plane impact
const Vec3 kLever1(1.10365794, 0.611759, 0), kLever2(-1.27, -1.27, 0);
const Vec3 kVelocity1(17.86125968, 0, 0);
const Vec3 kNormal = Vec3(-0.9640954042, -0.2655561175, 0).normalized();

/// Identity, and turns about no axis in particular.
std::array<Mat3, 3> rotations() {
  return {Mat3::Identity(), Quat(0.3, -0.7, 0.2, 0.61).normalized().toRotationMatrix(),
          Quat(-0.5, 0.1, 0.83, 0.2).normalized().toRotationMatrix()};
}

TEST(KudlichSlibar, AgreesWithThePublishedNumbersHoweverTurnedAndInEitherOrder) {
  for (const Published& want : kPublished)
    for (const Mat3& R : rotations())
      for (const bool swapped : {false, true}) {
        const Vec3 r_1 = R * kLever1, r_2 = R * kLever2, v_1 = R * kVelocity1, n = R * kNormal;
        const Mat3 I_1 = R * kInertia1.asDiagonal() * R.transpose(), I_2 = R * kInertia2.asDiagonal() * R.transpose();
        const Mat3 K =
            swapped ? impact_matrix(kMass2, I_2, r_2, kMass1, I_1, r_1) : impact_matrix(kMass1, I_1, r_1, kMass2, I_2, r_2);
        const double sign = swapped ? -1 : 1;
        const PlaneImpact got = kudlich_slibar(K, sign * v_1, sign * n, want.mu, 0);
        const Vec3 P = R.transpose() * (sign * got.impulse);
        const Vec3 dw = R.transpose() * (I_1.inverse() * r_1.cross(sign * got.impulse));
        // input and output are printed to seven digits: two units of the last one
        EXPECT_EQ(got.sliding, want.sliding);
        EXPECT_LT((P - want.P).cwiseAbs().maxCoeff(), 2 * std::max(want.P_digit, 1e-6 * want.P.norm()));
        EXPECT_LT((P / kMass1 - want.dv).cwiseAbs().maxCoeff(), 1e-6 * want.dv.norm());
        EXPECT_NEAR(dw.z() * 180 / std::numbers::pi, want.dw_z_deg, 1e-6 * want.dw_z_deg);
        EXPECT_NEAR(got.energy_lost, want.energy, 1e-6 * want.energy);
      }
}

TEST(KudlichSlibar, NamesTheFrictionAFullImpactNeeds) {
  const Mat3 K = impact_matrix(kMass1, kInertia1.asDiagonal(), kLever1, kMass2, kInertia2.asDiagonal(), kLever2);
  EXPECT_NEAR(kudlich_slibar(K, kVelocity1, kNormal, 0.82, 0).required_friction, 0.0592593, 1e-7);
}

TEST(KudlichSlibar, RestitutionMultipliesTheWholeImpulse) {
  const Mat3 K = impact_matrix(kMass1, kInertia1.asDiagonal(), kLever1, kMass2, kInertia2.asDiagonal(), kLever2);
  for (const double mu : {0.82, 0.03}) {
    const Vec3 plastic = kudlich_slibar(K, kVelocity1, kNormal, mu, 0).impulse;
    EXPECT_LT((kudlich_slibar(K, kVelocity1, kNormal, mu, 0.3).impulse - 1.3 * plastic).norm(), 1e-9 * plastic.norm());
  }
}

TEST(KudlichSlibar, PartingBodiesExchangeNothing) {
  EXPECT_EQ(kudlich_slibar(Mat3::Identity(), Vec3(1, 5, 0), Vec3::UnitX(), 1, 0.5).impulse, Vec3::Zero());
}

TEST(KudlichSlibar, NeverCreatesEnergy) {
  // derived at the top of the header; seeded directions of approach, also with the impulse beyond the tangent
  std::srand(7);
  int sliding = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 r = Vec3::Random() * 3;
    const Mat3 K = impact_matrix(1000, Vec3(300, 1500, 1500).asDiagonal(), r, 1e9, Mat3::Identity() * 1e9, Vec3::Zero());
    const PlaneImpact got = kudlich_slibar(K, Vec3::Random() * 20, Vec3::Random().normalized(), 0.9, 0.95);
    EXPECT_GE(got.energy_lost, -1e-9 * 1e5) << "direction " << i;
    sliding += got.sliding;
  }
  EXPECT_GT(sliding, 500) << "full impacts have nothing to show";
}

/// A referee who knows neither K nor the formulas: velocities after the compression and the impulse as unknowns of one linear
/// system, 12 of momentum and 3 of the impact.
struct Collision {
  double m_1, m_2;
  Mat3 I_1, I_2;
  Vec3 r_1, r_2, v_1, v_2, w_1, w_2, n;
  double mu, e;
};

Vec3 compression_impulse(const Collision& c, const Mat3& impact_rows_on_u, const Mat3& impact_rows_on_P) {
  Eigen::Matrix<double, 15, 15> A = Eigen::Matrix<double, 15, 15>::Zero();
  Eigen::Matrix<double, 15, 1> b = Eigen::Matrix<double, 15, 1>::Zero();
  const auto put = [&](int row, int column, const Mat3& block) { A.block<3, 3>(row, column) = block; };
  const Mat3 one = Mat3::Identity();
  // m_1 v_1' - P = m_1 v_1, I_1 w_1' - r_1 x P = I_1 w_1, and opposite on 2
  put(0, 0, c.m_1 * one), put(0, 12, -one), b.segment<3>(0) = c.m_1 * c.v_1;
  put(3, 3, c.I_1), put(3, 12, -skew(c.r_1)), b.segment<3>(3) = c.I_1 * c.w_1;
  put(6, 6, c.m_2 * one), put(6, 12, one), b.segment<3>(6) = c.m_2 * c.v_2;
  put(9, 9, c.I_2), put(9, 12, skew(c.r_2)), b.segment<3>(9) = c.I_2 * c.w_2;
  // u' = v_1' + w_1' x r_1 - v_2' - w_2' x r_2
  put(12, 0, impact_rows_on_u), put(12, 3, -impact_rows_on_u * skew(c.r_1)), put(12, 6, -impact_rows_on_u);
  put(12, 9, impact_rows_on_u * skew(c.r_2)), put(12, 12, impact_rows_on_P);
  // rows of very different size: kilograms beside metres
  for (int i = 0; i < 15; ++i) {
    const double scale = A.row(i).cwiseAbs().maxCoeff();
    A.row(i) /= scale, b[i] /= scale;
  }
  return A.fullPivLu().solve(b).segment<3>(12);
}

Vec3 referee(const Collision& c, bool& sliding) {
  const Vec3 P_c = compression_impulse(c, Mat3::Identity(), Mat3::Zero());
  const double P_n = P_c.dot(c.n);
  const Vec3 P_t = P_c - P_n * c.n;
  sliding = P_n <= 0 || P_t.norm() > c.mu * P_n;
  if (!sliding) return (1 + c.e) * P_c;
  // no normal velocity at the end of the compression, P along n + mu t
  const Vec3 d = (c.n + c.mu * P_t.normalized()).normalized(), a = d.unitOrthogonal();
  Mat3 on_u = Mat3::Zero(), on_P = Mat3::Zero();
  on_u.row(0) = c.n.transpose();
  on_P.row(1) = a.transpose();
  on_P.row(2) = d.cross(a).transpose();
  return (1 + c.e) * compression_impulse(c, on_u, on_P);
}

TEST(KudlichSlibar, AgreesToSixDigitsWithOneLinearSystemOfAllUnknowns) {
  // eccentric, in space, spinning, restitution 0 to 1, friction 0 to 1.2, every fifth against a barrier; seeded
  std::srand(11);
  const auto random = [](double low, double high) { return low + (high - low) * std::rand() / RAND_MAX; };
  const auto tensor = [](const Vec3& principal) {
    const Mat3 R = Quat(Eigen::Vector4d(Eigen::Vector4d::Random())).normalized().toRotationMatrix();
    return Mat3(R * principal.asDiagonal() * R.transpose());
  };
  int slid = 0, full = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool barrier = i % 5 == 0;
    Collision c;
    c.m_1 = random(800, 12000), c.m_2 = barrier ? 1e9 : random(800, 12000);
    c.I_1 = tensor(c.m_1 * Vec3(random(0.3, 0.5), random(1.2, 2.0), random(1.2, 2.0)));
    c.I_2 = barrier ? Mat3(1e10 * Mat3::Identity()) : tensor(c.m_2 * Vec3(random(0.3, 0.5), random(1.2, 2.0), random(1.2, 2.0)));
    c.r_1 = Vec3::Random().cwiseProduct(Vec3(2.3, 0.9, 0.4)), c.r_2 = Vec3::Random().cwiseProduct(Vec3(2.3, 0.9, 0.4));
    c.v_1 = 20 * Vec3::Random().cwiseProduct(Vec3(1, 1, 0.05)), c.v_2 = barrier ? Vec3(Vec3::Zero()) : Vec3(15 * Vec3::Random());
    c.w_1 = 0.5 * Vec3::Random(), c.w_2 = barrier ? Vec3(Vec3::Zero()) : Vec3(0.5 * Vec3::Random());
    c.n = Vec3::Random().normalized(), c.mu = random(0, 1.2), c.e = random(0, 1);
    const Vec3 u = c.v_1 + c.w_1.cross(c.r_1) - c.v_2 - c.w_2.cross(c.r_2);
    if (u.dot(c.n) > 0) c.n = -c.n;
    bool sliding = false;
    const Vec3 want = referee(c, sliding);
    const PlaneImpact got = kudlich_slibar(impact_matrix(c.m_1, c.I_1, c.r_1, c.m_2, c.I_2, c.r_2), u, c.n, c.mu, c.e);
    EXPECT_EQ(got.sliding, sliding) << "collision " << i;
    EXPECT_LT((got.impulse - want).norm(), 1e-6 * want.norm()) << "collision " << i;
    ++(sliding ? slid : full);
  }
  EXPECT_GT(slid, 300);
  EXPECT_GT(full, 300);
}

// ---- runs ----

std::shared_ptr<const TriangleMesh> block(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  const std::vector<Triangle> faces{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return std::make_shared<TriangleMesh>(corners, faces);
}

/// A car-sized block that asks for Kudlich-Slibar.
Body car(const std::string& name, const Vec3& at, double heading, const Vec3& velocity) {
  Body body = inert(1496, {600, 2600, 2766}, at);
  body.name = name;
  body.shape = MeshShape{block({2.375, 0.889, 0.5}), {}};
  body.collision_model = CollisionModel::kudlich_slibar;
  body.surface.friction_body = 0.6;
  body.surface.restitution_body = 0.1;
  body.X_WB.q = Quat(Eigen::AngleAxisd(heading, Vec3::UnitZ()));
  body.V_WB.v = velocity;
  return body;
}

void add_vehicle(Model& model, Body body) {
  Vehicle vehicle;
  vehicle.name = body.name;
  vehicle.body = static_cast<int>(model.bodies.size());
  body.vehicle = static_cast<int>(model.vehicles.size());
  model.vehicles.push_back(vehicle);
  model.bodies.push_back(std::move(body));
}

double metric(const Model& model, const Recording& run, const std::string& key, const std::string& object) {
  for (const Metric& m : measure(model, run))
    if (m.key == key && m.object == object) return m.value;
  return std::nan("");
}

TEST(Overlap, OfTwoBlocksIsTheirCommonBlock) {
  const auto mesh = block({1, 1, 0.5});
  OverlapScratch scratch;
  const auto got = overlap_of(*mesh, {{0, 0, 0.5}, Quat::Identity()}, *mesh, {{1.8, 0.5, 0.7}, Quat::Identity()}, scratch);
  ASSERT_TRUE(got);
  // x 0.8..1, y -0.5..1, z 0.2..1; a grid line in 64 may fall on either side of a face
  EXPECT_NEAR(got->volume, 0.2 * 1.5 * 0.8, 0.05 * 0.24);
  EXPECT_LT((got->centroid - Vec3(0.9, 0.25, 0.6)).norm(), 0.02);
  // the outlines cross at (1, -0.5) and (0.8, 1): the plane stands on the line between them
  const Vec3 want = Vec3(-1.5, -0.2, 0).normalized();
  EXPECT_GT(got->normal_W.dot(want), std::cos(1.5 * std::numbers::pi / 180));
  const auto turned = overlap_of(*mesh, {{1.8, 0.5, 0.7}, Quat::Identity()}, *mesh, {{0, 0, 0.5}, Quat::Identity()}, scratch);
  EXPECT_LT((turned->normal_W + got->normal_W).norm(), 1e-12) << "swapped bodies have the opposite normal";
}

/// A graze at a small angle, whose overlap is centimetres wide: a grid that stood still would see another in every turned scene.
TEST(Overlap, TurnsWithTheWholeScene) {
  const auto mesh = block({2.3, 0.9, 0.7});
  const auto heading = [](double degrees) { return math::rotation(degrees * std::numbers::pi / 180, Vec3::UnitZ()); };
  OverlapScratch scratch;
  const Pose X_WA{{0, 0, 0.7}, heading(0)}, X_WB{{1.5, 1.75, 0.7}, heading(185)};
  const auto straight = overlap_of(*mesh, X_WA, *mesh, X_WB, scratch);
  ASSERT_TRUE(straight);
  for (const double turn : {17.0, 45.0, 90.0, 131.0, 180.0, -77.0}) {
    const Quat q = heading(turn);
    const auto got = overlap_of(*mesh, {q * X_WA.p, q * X_WA.q}, *mesh, {q * X_WB.p, q * X_WB.q}, scratch);
    ASSERT_TRUE(got) << turn;
    EXPECT_NEAR(got->volume, straight->volume, 1e-9) << turn;  // rounding only: lines meet the same faces
    EXPECT_LT((got->centroid - q * straight->centroid).norm(), 1e-9) << turn;
    EXPECT_LT((got->normal_W - q * straight->normal_W).norm(), 1e-9) << turn;
  }
}

TEST(KudlichSlibarRun, GivesThePublishedNumbersHoweverTheWorldIsTurnedAndTheBodiesOrdered) {
  // both bodies stand in each other when the run begins, and no time passes from touch to exchange: the levers are the published
  // ones
  for (const Published& want : kPublished)
    for (const Mat3& R : rotations())
      for (const bool swapped : {false, true}) {
        Model model = free_space(1e-3);
        model.settings.record_interval = 1e-3;
        Body car = inert(kMass1, kInertia1, {0, 0, 0}), barrier = inert(kMass2, kInertia2, R * (kLever1 - kLever2));
        car.name = "car";
        barrier.name = "barrier";
        car.shape = MeshShape{block({2.3, 0.9, 0.5}), {}};
        barrier.shape = MeshShape{block({1.5, 3, 1}), {}};
        car.V_WB.v = R * kVelocity1;
        for (Body* body : {&car, &barrier}) {
          body->X_WB.q = Quat(R);
          body->collision_model = CollisionModel::kudlich_slibar;
        }
        model.bodies = swapped ? std::vector<Body>{barrier, car} : std::vector<Body>{car, barrier};
        ImpactSettings settled;
        settled.body_a = 0;
        settled.body_b = 1;
        settled.penetration_time = 0;
        settled.point_W = R * kLever1;
        settled.normal_W = R * kNormal;
        settled.friction = want.mu;
        settled.restitution = 0;
        model.impacts.push_back(settled);
        const Recording run = simulate(model);
        const Twist& V = run.snapshots.back().bodies[swapped ? 1 : 0].V_WB;
        const Vec3 dv = R.transpose() * V.v - kVelocity1, w = R.transpose() * V.w;
        EXPECT_LT((dv - want.dv).cwiseAbs().maxCoeff(), 1e-6 * want.dv.norm());
        EXPECT_NEAR(w.z() * 180 / std::numbers::pi, want.dw_z_deg, 1e-6 * want.dw_z_deg);
        const double lost = run.snapshots.front().energies.kinetic - run.snapshots.back().energies.kinetic;
        EXPECT_NEAR(lost, want.energy, 1e-6 * want.energy);
      }
}

TEST(KudlichSlibarRun, InLineCollisionSharesMomentumAfterThePenetrationTime) {
  // equal masses, e = 0.1: the struck car leaves with (1 + e)/2 of the closing speed, the other with (1 - e)/2
  Model model = free_space(0.2);
  add_vehicle(model, car("bullet", {0, 0, 0}, 0, {10, 0, 0}));
  add_vehicle(model, car("target", {5.0, 0, 0}, 0, {0, 0, 0}));
  const Recording run = simulate(model);
  const auto& after = run.snapshots.back().bodies;
  EXPECT_NEAR(after[1].V_WB.v.x(), 5.5, 1e-9);
  EXPECT_NEAR(after[0].V_WB.v.x(), 4.5, 1e-9);
  const auto impact = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "impact"; });
  ASSERT_NE(impact, run.events.end());
  // 0.25 m apart: touch at 0.025 s, exchange 0.03 s later; the grid of the touch has 64 cells over a step's way of 10 mm
  EXPECT_NEAR(impact->time, 0.055, 1e-3 / 64);
  EXPECT_NEAR(metric(model, run, "delta_v_mps", "target"), 5.5, 1e-9);
  // lost: (1 - e^2) m/4 u^2, half to each
  EXPECT_NEAR(metric(model, run, "ees_mps", "bullet"), std::sqrt(0.99 * 100 / 4), 1e-9);
  EXPECT_NEAR(metric(model, run, "pdof_deg", "bullet"), 0, 1e-6);
  const Energies& e = run.snapshots.back().energies;
  EXPECT_NEAR(e.residual, 0, 1e-9 * 0.5 * 1496 * 100);
}

/// A car that clips the tail of one that crosses is past it within 22 ms of the touch: it gives its impulse halfway.
TEST(KudlichSlibarRun, ACollisionShorterThanThePenetrationTimeIsNotDropped) {
  constexpr double kSpeed = 25, kOverlap = 0.55;  // [m/s], [m] of the tail still in the way as the front comes
  Model model = free_space(0.4);
  add_vehicle(model, car("a", {-5, 0, 0}, 0, {kSpeed, 0, 0}));
  const double meets = (5 - 2.375 - 0.889) / kSpeed;  // [s]
  const double tail = 0.889 - kOverlap;               // [m] y of the tail then
  add_vehicle(model, car("b", {0, tail + 2.375 - kSpeed * meets, 0}, std::numbers::pi / 2, {0, kSpeed, 0}));
  const Recording run = simulate(model);
  const auto impact = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "impact"; });
  ASSERT_NE(impact, run.events.end());
  EXPECT_GT(impact->time, meets);
  EXPECT_LT(impact->time, meets + kOverlap / kSpeed);
  EXPECT_GT(metric(model, run, "delta_v_mps", "a"), 1);
  EXPECT_TRUE(run.diagnostics.warnings.empty());
}

TEST(KudlichSlibarRun, ObliqueCollisionKeepsMomentum) {
  Model model = free_space(0.4);
  add_vehicle(model, car("a", {-6, 0, 0}, 0, {14, 0, 0}));
  add_vehicle(model, car("b", {1, -6, 0.1}, 1.4, {2, 12, 0}));
  const Recording run = simulate(model);
  ASSERT_FALSE(std::none_of(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "impact"; }));
  const Snapshot &first = run.snapshots.front(), &last = run.snapshots.back();
  const Vec3 p_before = 1496 * (first.bodies[0].V_WB.v + first.bodies[1].V_WB.v);
  const Vec3 p_after = 1496 * (last.bodies[0].V_WB.v + last.bodies[1].V_WB.v);
  EXPECT_LT((p_after - p_before).norm(), 1e-9 * p_before.norm());
  EXPECT_LT((angular_momentum(model, last) - angular_momentum(model, first)).norm(), 1e-6 * 1496 * 14 * 6);
  EXPECT_LT(last.energies.kinetic, first.energies.kinetic);
}

TEST(KudlichSlibarRun, BodiesSwappedGiveTheSameMotion) {
  std::array<Vec3, 2> v_of_a, w_of_a;
  for (const int order : {0, 1}) {
    Model model = free_space(0.3);
    const Body a = car("a", {-6, 0, 0}, 0, {14, 0, 0}), b = car("b", {1, -6, 0.1}, 1.4, {2, 12, 0});
    add_vehicle(model, order == 0 ? a : b);
    add_vehicle(model, order == 0 ? b : a);
    const Recording run = simulate(model);
    v_of_a[order] = run.snapshots.back().bodies[order].V_WB.v;
    w_of_a[order] = run.snapshots.back().bodies[order].V_WB.w;
  }
  EXPECT_LT((v_of_a[0] - v_of_a[1]).norm(), 1e-9);
  EXPECT_LT((w_of_a[0] - w_of_a[1]).norm(), 1e-9);
}

TEST(KudlichSlibarRun, BarrierTakesTheWholeNormalVelocityAndPointPlaneAndCoefficientsCanBeSettled) {
  Model model = free_space(0.3);
  add_vehicle(model, car("car", {-3, 0, 0}, 0, {15, 3, 0}));
  Body barrier = inert(1, {1, 1, 1}, {1, 0, 0});
  barrier.name = "barrier";
  barrier.fixed = true;
  barrier.shape = MeshShape{block({0.5, 10, 1}), {}};
  barrier.collision_model = CollisionModel::kudlich_slibar;
  model.bodies.push_back(barrier);
  ImpactSettings settled;
  settled.body_a = 1;
  settled.body_b = 0;
  settled.penetration_time = 0.04;
  settled.normal_W = Vec3::UnitX();
  settled.friction = 0;
  settled.restitution = 0.2;
  settled.point_W = Vec3(0.5, 0.045 * 15, 0);
  // frictionless and at the height and side of the centre of mass: the point is set to move no lever arm in y
  const double touch = (3 - 2.375 + 0.5) / 15;
  settled.point_W->y() = 3 * (touch + 0.04);
  model.impacts.push_back(settled);
  const Recording run = simulate(model);
  const Twist& V = run.snapshots.back().bodies[0].V_WB;
  EXPECT_NEAR(V.v.x(), -0.2 * 15, 1e-4);  // the touch is placed to a fraction of a millimetre: a lever of 1e-8 of K
  EXPECT_NEAR(V.v.y(), 3, 1e-12);
  EXPECT_NEAR(metric(model, run, "ees_mps", "car"), 15 * std::sqrt(1 - 0.04), 0.01);
}

TEST(KudlichSlibarRun, DoesNotHangOnWhereTheStepsEnd) {
  // touch and exchange are placed inside the step: what is left is how finely the grid of the touch is laid, some 50 us by the
  // step, hence 0.7 mm of way and 1e-4 of the impulse
  struct Seen {
    double time, delta_v, pdof;
    Vec3 end;
  };
  std::vector<Seen> seen;
  for (const double step : {2e-3, 1e-3, 0.7e-3, 0.5e-3, 0.25e-3}) {
    Model model = free_space(0.7, step);
    add_vehicle(model, car("a", {-6, 0, 0}, 0, {14, 0, 0}));
    add_vehicle(model, car("b", {1, -6, 0.1}, 1.4, {2, 12, 0}));
    const Recording run = simulate(model);
    const auto impact = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "impact"; });
    ASSERT_NE(impact, run.events.end());
    seen.push_back({impact->time, metric(model, run, "delta_v_mps", "a"), metric(model, run, "pdof_deg", "a"),
                    run.at(0.6999).bodies[0].X_WB.p});
  }
  for (const Seen& one : seen) {
    EXPECT_NEAR(one.time, seen.back().time, 5e-5);
    EXPECT_NEAR(one.delta_v, seen.back().delta_v, 1e-4 * seen.back().delta_v);
    EXPECT_NEAR(one.pdof, seen.back().pdof, 0.02);
    EXPECT_LT((one.end - seen.back().end).norm(), 2e-3);
  }
}

/// It exchanges at an instant and makes no contact: a plan used to say after the run that it still waits.
TEST(KudlichSlibarRun, TellsInThePlanWhenItActed) {
  for (const double speed : {14.0, 1.0}) {  // that the second is not there in time is proved: off
    Model model = free_space(0.5);
    add_vehicle(model, car("a", {-6, 0, 0}, 0, {speed, 0, 0}));
    add_vehicle(model, car("b", {0, 0, 0}, 0, {0, 0, 0}));
    const Recording run = simulate(model);
    const auto line =
        std::find_if(run.plan.begin(), run.plan.end(), [](const PlanLine& l) { return l.effect == "kudlich_slibar"; });
    ASSERT_NE(line, run.plan.end());
    EXPECT_EQ(line->acted.told, speed > 10);
    const auto impact = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "impact"; });
    EXPECT_EQ(impact != run.events.end(), speed > 10);
    EXPECT_EQ(line->acted.first, impact == run.events.end() ? -1 : impact->time);
    EXPECT_EQ(line->acted.in_reach, line->acted.first);
    if (speed > 10) {
      EXPECT_GT(line->acted.first, line->not_before);
    }
  }
}

TEST(KudlichSlibarRun, StillPushingBodiesHaveASecondaryImpact) {
  // the second car, e = 0, is pushed into a third: bodies 0 and 1 move on in contact and close again
  Model model = free_space(0.6);
  for (int i = 0; i < 3; ++i) {
    Body body = car("car" + std::to_string(i), {4.85 * i, 0, 0}, 0, {i == 0 ? 12.0 : 0.0, 0, 0});
    body.surface.restitution_body = 0;
    add_vehicle(model, body);
  }
  const Recording run = simulate(model);
  const auto of_first = std::count_if(run.events.begin(), run.events.end(),
                                      [](const Event& e) { return e.kind == "impact" && e.body_a == 0 && e.body_b == 1; });
  EXPECT_GE(of_first, 2);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(run.snapshots.back().bodies[i].V_WB.v.x(), 4, 0.15);  // 3 kSecondary/2
}

/// Default-Auto if either object asks for it, Kudlich-Slibar only if both do.
TEST(ChoiceOfModel, TableOfBothObjects) {
  using enum CollisionModel;
  struct Row {
    CollisionModel a, b, used;
  };
  for (const auto& [a, b, used] :
       {Row{default_auto, default_auto, default_auto}, Row{default_auto, kudlich_slibar, default_auto},
        Row{kudlich_slibar, default_auto, default_auto}, Row{kudlich_slibar, kudlich_slibar, kudlich_slibar}}) {
    EXPECT_EQ(model_between(a, b), used);
    Model model = free_space(0.1);
    add_vehicle(model, car("a", {0, 0, 0}, 0, {10, 0, 0}));
    add_vehicle(model, car("b", {6, 0, 0}, 0, {0, 0, 0}));
    model.bodies[0].collision_model = a;
    model.bodies[1].collision_model = b;
    const Plan plan = compile(model);
    const bool planned = std::any_of(plan.lines.begin(), plan.lines.end(),
                                     [](const PlanLine& l) { return l.effect == "kudlich_slibar" && l.active; });
    EXPECT_EQ(planned, used == kudlich_slibar);
  }
}

}  // namespace
}  // namespace engine::test
