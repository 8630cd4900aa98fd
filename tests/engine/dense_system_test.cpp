// Systems and products of the contact solver, at sizes that fill whole vectors and at those that do not, against Eigen's.
#include "engine/solver/dense_system.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "engine/solver/wide_products.h"

namespace engine {
namespace {

TEST(DenseSystem, SolvesAsEigenWhateverWasSolvedBefore) {
  std::srand(7);
  DenseSystem system;
  system.reserve(50);
  for (const int n : {1, 2, 3, 4, 5, 7, 8, 9, 45, 50, 44, 6, 1}) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    if (n > 1) A(0, 0) = 0;  // asks for a change of rows
    const Eigen::VectorXd first = Eigen::VectorXd::Random(n), second = Eigen::VectorXd::Random(n);
    system.resize(n);
    for (int c = 0; c < n; ++c)
      for (int r = 0; r < n; ++r) system.A(r, c) = A(r, c);
    ASSERT_TRUE(system.factor()) << n;
    const auto lu = A.fullPivLu();
    for (const Eigen::VectorXd& b : {first, second}) {
      for (int r = 0; r < n; ++r) system.b(r) = b[r];
      system.solve();
      const Eigen::VectorXd x = lu.solve(b);
      // rounding in either, as far as the matrix can enlarge it
      for (int r = 0; r < n; ++r) EXPECT_NEAR(system.b(r), x[r], 1e-15 * n * (1 + x.norm()) / lu.rcond()) << n;
    }
  }
}

TEST(DenseSystem, SaysThatThereIsNoSolution) {
  DenseSystem system;
  system.resize(5);
  for (int c = 0; c < 5; ++c)
    for (int r = 0; r < 5; ++r) system.A(r, c) = c == 3 ? 0 : 1 / (1.0 + r + c);
  EXPECT_FALSE(system.factor());
}

TEST(WideProducts, AreThoseOfEigen) {
  std::srand(11);
  for (const int columns : {0, 1, 6, 90}) {
    const Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Random();
    const Eigen::MatrixXd in = Eigen::MatrixXd::Random(6, columns);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(6, columns);
    multiply_by_six(A.data(), in.data(), out.data(), static_cast<std::size_t>(columns));
    EXPECT_LE((out - A * in).norm(), 1e-14);
  }
  for (const int rows : {3, 4, 45}) {
    const Eigen::MatrixXd G = Eigen::MatrixXd::Random(rows, 3);
    const Eigen::Vector3d x = Eigen::Vector3d::Random();
    Eigen::VectorXd sum = Eigen::VectorXd::Random(rows);
    const Eigen::VectorXd expected = sum + G * x;
    add_three_columns(G.data(), x.data(), sum.data(), static_cast<std::size_t>(rows));
    EXPECT_LE((sum - expected).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace engine
