#include "tests/benchmark/dense_algebra.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

#include "engine/solver/dense_system.h"

namespace {

constexpr int kRounds = 5;

/// Quickest of some rounds [us] of one call.
template <class Call>
double quickest(int calls, Call&& call) {
  double best = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call();
    best = std::min(best, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / calls);
  }
  return best;
}

Eigen::MatrixXd random_matrix(int rows, int columns) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> one(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return one(random); });
}

void systems() {
  std::printf(
      "dense system, factored and solved, us: unknowns, ours in order, ours, Eigen::PartialPivLU in place, over ours in order\n");
  for (const int n : {6, 12, 24, 48, 96, 200}) {
    const Eigen::MatrixXd root = random_matrix(n, n);
    const Eigen::MatrixXd A = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd b = random_matrix(n, 1);
    Eigen::MatrixXd work(n, n);
    Eigen::VectorXd x(n);
    engine::DenseSystem system;
    const int calls = 20000000 / (n * n * n + 2000);
    const auto timed = [&](bool (engine::DenseSystem::*factor)()) {
      return quickest(calls, [&] {
        system.resize(n);
        for (int c = 0; c < n; ++c) {
          std::copy_n(A.col(c).data(), n, system.column(c));
          system.b(c) = b[c];
        }
        (system.*factor)();
        system.solve();
      });
    };
    const double in_order = timed(&engine::DenseSystem::factor_in_order), ours = timed(&engine::DenseSystem::factor);
    const double theirs = quickest(calls, [&] {
      work = A;
      x = Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>>(work).solve(b);
    });
    std::printf("  %3d  %7.2f  %7.2f  %7.2f  %.2f\n", n, in_order, ours, theirs, theirs / in_order);
  }
}

}  // namespace

void dense_algebra_beside_eigen() {
  systems();
}
