// Runs in lockstep: numbers of four runs in a vector each. What all runs do alike, whatever they touch, is the smooth motion and
// the closing of joints. There the elimination of a joint stands for the rest, and is taken both ways on the same bodies.
#include "tests/benchmark/lockstep.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "engine/math/types.h"
#include "engine/simulate.h"
#include "engine/solver/wide_links.h"
#include "scenes/loader/builder.h"
#include "scenes/scene.h"

// Vectors in and out of functions that are all in line: how a call would pass them does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace {

constexpr int kRuns = 4;
using Runs = double __attribute__((vector_size(kRuns * sizeof(double))));

/// As engine::eliminate_point has it.
struct Joint {
  std::array<double, 36> H, D, X, H_parent;
  std::array<double, 3> r, r_parent;
};
struct alignas(kRuns * sizeof(double)) FourJoints {
  std::array<Runs, 36> H, D, X, H_parent;
  std::array<Runs, 3> r, r_parent;
};

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

#if defined(__x86_64__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

/// engine::eliminate_point for four runs. S = [skew(r); 1] moves the body about the point, K = S^T H S; D = S K^-1 S^T,
/// X = (1 - D H) P and H_parent += P^T (H - H D H) P, with P = [1, -skew(r_parent); 0, 0].
void eliminate_in_lockstep(FourJoints& f) {
  const auto H = [&f](int r, int c) { return f.H[static_cast<std::size_t>(6 * c + r)]; };
  // columns of M skew(v)
  const auto times_skew = [](const Runs& x, const Runs& y, const Runs& z, const std::array<Runs, 3>& v) {
    return std::array<Runs, 3>{y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]};
  };
  Runs HS[6][3];
  for (int r = 0; r < 6; ++r) {
    const std::array<Runs, 3> turned = times_skew(H(r, 0), H(r, 1), H(r, 2), f.r);
    for (int c = 0; c < 3; ++c) HS[r][c] = turned[static_cast<std::size_t>(c)] + H(r, 3 + c);
  }
  // S^T = [-skew(r), 1]
  const auto [x, y, z] = f.r;
  Runs K[3][3];
  for (int c = 0; c < 3; ++c) {
    K[0][c] = HS[3][c] + z * HS[1][c] - y * HS[2][c];
    K[1][c] = HS[4][c] + x * HS[2][c] - z * HS[0][c];
    K[2][c] = HS[5][c] + y * HS[0][c] - x * HS[1][c];
  }
  const Runs c00 = K[1][1] * K[2][2] - K[2][1] * K[2][1], c10 = K[2][1] * K[2][0] - K[1][0] * K[2][2],
             c20 = K[1][0] * K[2][1] - K[1][1] * K[2][0];
  const Runs scale = 1.0 / (K[0][0] * c00 + K[1][0] * c10 + K[2][0] * c20);
  const Runs c11 = K[0][0] * K[2][2] - K[2][0] * K[2][0], c21 = K[1][0] * K[2][0] - K[0][0] * K[2][1],
             c22 = K[0][0] * K[1][1] - K[1][0] * K[1][0];
  const Runs Ki[3][3] = {
      {c00 * scale, c10 * scale, c20 * scale}, {c10 * scale, c11 * scale, c21 * scale}, {c20 * scale, c21 * scale, c22 * scale}};
  Runs SKi[6][3];
  for (int c = 0; c < 3; ++c) {
    SKi[0][c] = y * Ki[2][c] - z * Ki[1][c];
    SKi[1][c] = z * Ki[0][c] - x * Ki[2][c];
    SKi[2][c] = x * Ki[1][c] - y * Ki[0][c];
    for (int r = 0; r < 3; ++r) SKi[3 + r][c] = Ki[r][c];
  }
  for (int r = 0; r < 6; ++r) {
    const std::array<Runs, 3> turned = times_skew(SKi[r][0], SKi[r][1], SKi[r][2], f.r);
    for (int c = 0; c < 3; ++c) {
      f.D[static_cast<std::size_t>(6 * c + r)] = -turned[static_cast<std::size_t>(c)];
      f.D[static_cast<std::size_t>(6 * (3 + c) + r)] = SKi[r][c];
    }
  }
  // (1 - D H) and H - H D H, first three columns: D H = S K^-1 (H S)^T
  Runs A[3][3];
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 6; ++r)
      f.X[static_cast<std::size_t>(6 * c + r)] =
          (r == c ? 1.0 : 0.0) - (SKi[r][0] * HS[c][0] + SKi[r][1] * HS[c][1] + SKi[r][2] * HS[c][2]);
    Runs KiS[3];
    for (int k = 0; k < 3; ++k) KiS[k] = Ki[k][0] * HS[c][0] + Ki[k][1] * HS[c][1] + Ki[k][2] * HS[c][2];
    for (int r = 0; r < 3; ++r) A[r][c] = H(r, c) - (HS[r][0] * KiS[0] + HS[r][1] * KiS[1] + HS[r][2] * KiS[2]);
  }
  const std::array<Runs, 3>& p = f.r_parent;
  for (int r = 0; r < 6; ++r) {
    const std::array<Runs, 3> turned = times_skew(f.X[static_cast<std::size_t>(r)], f.X[static_cast<std::size_t>(6 + r)],
                                                  f.X[static_cast<std::size_t>(12 + r)], p);
    for (std::size_t c = 0; c < 3; ++c) f.X[6 * (3 + c) + static_cast<std::size_t>(r)] = -turned[c];
  }
  Runs B[3][3];  // -A skew(r_parent)
  for (int r = 0; r < 3; ++r) {
    const std::array<Runs, 3> turned = times_skew(A[r][0], A[r][1], A[r][2], p);
    for (int c = 0; c < 3; ++c) B[r][c] = -turned[static_cast<std::size_t>(c)];
  }
  const auto add = [&f](int r, int c, const Runs& v) { f.H_parent[static_cast<std::size_t>(6 * c + r)] += v; };
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      add(r, c, A[r][c]);
      add(r, 3 + c, B[r][c]);
      add(3 + c, r, B[r][c]);
    }
    add(3, 3 + c, p[1] * B[2][c] - p[2] * B[1][c]);
    add(4, 3 + c, p[2] * B[0][c] - p[0] * B[2][c]);
    add(5, 3 + c, p[0] * B[1][c] - p[1] * B[0][c]);
  }
}

#if defined(__x86_64__) && !defined(__clang__)
#pragma GCC pop_options
#endif

/// Bodies of a person's size on joints.
std::vector<Joint> random_joints(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> one(-1, 1);
  std::vector<Joint> out(static_cast<std::size_t>(count));
  for (Joint& j : out) {
    const engine::Mat6 root = engine::Mat6::NullaryExpr([&] { return one(random); });
    const engine::Mat6 H = root * root.transpose() + engine::Mat6::Identity();
    std::copy_n(H.data(), 36, j.H.begin());
    j.H_parent.fill(0);
    for (auto* v : {&j.r, &j.r_parent})
      for (double& x : *v) x = 0.3 * one(random);
  }
  return out;
}

struct Elimination {
  double one_run = 0, lockstep = 0;  // [ns] of a joint of one run
  double apart = 0;                  // [-] the most that the two differ
};

Elimination eliminations() {
  constexpr int kTurns = 7, kSets = 16, kTimes = 20000;  // sixteen joints of four runs: they stay in the cache
  std::vector<Joint> joints = random_joints(kSets * kRuns);
  std::vector<FourJoints> fours(kSets);
  for (std::size_t s = 0; s < kSets; ++s)
    for (std::size_t run = 0; run < kRuns; ++run) {
      const Joint& j = joints[s * kRuns + run];
      for (std::size_t i = 0; i < 36; ++i) fours[s].H[i][run] = j.H[i], fours[s].H_parent[i][run] = 0;
      for (std::size_t i = 0; i < 3; ++i) fours[s].r[i][run] = j.r[i], fours[s].r_parent[i][run] = j.r_parent[i];
    }
  const auto eliminate = [](Joint& j) {
    engine::eliminate_point(j.H.data(), j.r.data(), j.r_parent.data(), j.D.data(), j.X.data(), j.H_parent.data());
  };
  Elimination out;
  for (Joint& j : joints) eliminate(j);
  for (FourJoints& f : fours) eliminate_in_lockstep(f);
  for (std::size_t s = 0; s < kSets; ++s)
    for (std::size_t run = 0; run < kRuns; ++run)
      for (std::size_t i = 0; i < 36; ++i) {
        const Joint& j = joints[s * kRuns + run];
        for (const double d : {fours[s].D[i][run] - j.D[i], fours[s].X[i][run] - j.X[i], fours[s].H_parent[i][run] - j.H_parent[i]})
          out.apart = std::max(out.apart, std::abs(d));
      }
  const auto quickest = [&](auto&& work) {
    double best = 1e300;
    for (int round = 0; round < kTurns; ++round) {
      const double start = seconds();
      for (int k = 0; k < kTimes / kSets; ++k) work();
      best = std::min(best, 1e9 * (seconds() - start) / (kTimes / kSets * kSets * kRuns));
    }
    return best;
  };
  out.one_run = quickest([&] {
    for (Joint& j : joints) eliminate(j);
  });
  out.lockstep = quickest([&] {
    for (FourJoints& f : fours) eliminate_in_lockstep(f);
  });
  return out;
}

/// Share [-] of a run of the flagship that goes into smooth motion and the closing of joints.
double share_alike() {
  const engine::Model model = scenes::load(scenes::home_folder() / "scenes/cases/sedan_pedestrian_40kmh.toml").model;
  engine::RunOptions options;
  options.clock = seconds;
  const engine::Recording run = engine::simulate(model, options);
  double alike = 0, all = 0;
  for (const auto* costs : {&run.costs, &run.phases})
    for (const engine::EffectCost& cost : *costs) {
      all += cost.wall_s;
      if (cost.effect == "integration" || cost.effect == "joint_projection") alike += cost.wall_s;
    }
  return alike / all;
}

}  // namespace

void runs_in_lockstep() {
#if defined(__x86_64__) && !defined(__clang__)
  if (!__builtin_cpu_supports("avx2")) {
    std::printf("runs in lockstep: this processor has no vectors of four\n\n");
    return;
  }
#endif
  const Elimination joint = eliminations();
  const double gain = joint.one_run / joint.lockstep, share = share_alike();
  std::printf(
      "runs in lockstep, four to a vector: a joint eliminated in %.1f ns, of one run at a time in %.1f ns: %.2f times; they differ "
      "by %.0e\n",
      joint.lockstep, joint.one_run, gain, joint.apart);
  std::printf(
      "%.0f %% of the flagship's time are smooth motion and closing of joints, which all runs do alike: at that gain %.2f times "
      "the runs of one a core, if nothing waited for another run\n\n",
      100 * share, 1 / (1 - share + share / gain));
}
