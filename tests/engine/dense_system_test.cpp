// Systems and products of the contact solver, at sizes that fill whole vectors and at those that do not, against Eigen's.
#include "engine/solver/dense_system.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/math/types.h"
#include "engine/solver/wide_links.h"
#include "engine/solver/wide_products.h"

namespace engine {
namespace {

void write(const Eigen::MatrixXd& A, DenseSystem& system) {
  system.resize(static_cast<int>(A.rows()));
  for (int c = 0; c < A.cols(); ++c) std::copy_n(A.col(c).data(), A.rows(), system.column(c));
}

/// Of a system that has been factored: some right-hand sides, one after the other.
void expect_solutions_of_eigen(const Eigen::MatrixXd& A, DenseSystem& system) {
  const auto n = static_cast<int>(A.rows());
  const auto lu = A.fullPivLu();
  for (int again = 0; again < 2; ++again) {
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    for (int r = 0; r < n; ++r) system.b(r) = b[r];
    system.solve();
    const Eigen::VectorXd x = lu.solve(b);
    // rounding in either, as far as the matrix can enlarge it
    for (int r = 0; r < n; ++r) EXPECT_NEAR(system.b(r), x[r], 1e-15 * n * (1 + x.norm()) / lu.rcond()) << n;
  }
}

TEST(DenseSystem, SolvesAsEigenWhateverWasSolvedBefore) {
  std::srand(7);
  DenseSystem system;
  system.reserve(50);
  for (const int n : {1, 2, 3, 4, 5, 7, 8, 9, 45, 50, 44, 6, 1}) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    if (n > 1) A(0, 0) = 0;  // asks for a change of rows
    write(A, system);
    ASSERT_TRUE(system.factor()) << n;
    expect_solutions_of_eigen(A, system);
  }
}

/// Blocks of seven of which some meet; small numbers on the diagonal ask for changes of rows.
template <class Meet>
void expect_solved_as_by_eigen(int blocks, Meet meet) {
  constexpr int kBlock = 7;
  const int n = blocks * kBlock;
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
  for (int c = 0; c < n; ++c)
    for (int r = 0; r < n; ++r)
      if (r / kBlock != c / kBlock && !meet(r / kBlock, c / kBlock)) A(r, c) = 0;
  A.diagonal() *= 1e-3;
  DenseSystem system;
  write(A, system);
  ASSERT_TRUE(system.factor());
  expect_solutions_of_eigen(A, system);
}

TEST(DenseSystem, SolvesBandsAsEigen) {
  std::srand(17);
  for (const int blocks : {12, 30}) expect_solved_as_by_eigen(blocks, [](int r, int c) { return std::abs(r - c) <= 1; });
}

TEST(DenseSystem, SolvesWhatIsMostlyZerosAsEigen) {
  std::srand(19);
  // as persons on a heap, in the order of their elimination: rows behind a panel stand here and there
  for (const int blocks : {14, 29, 56})
    expect_solved_as_by_eigen(blocks, [blocks](int r, int c) { return (r * c) % 11 == 3 || std::max(r, c) >= blocks - 3; });
}

/// How contacts answer each other, with a share added to the diagonal. Every third slips and drags friction along.
Eigen::MatrixXd answers_of_contacts(const Eigen::MatrixXd& root) {
  Eigen::MatrixXd A = root * root.transpose();
  A.diagonal() *= 1.001;
  for (int c = 0; c + 1 < A.cols(); c += 3) A.col(c) += 0.1 * A.col(c + 1);
  return A;
}

TEST(DenseSystem, SolvesInOrderAsEigen) {
  std::srand(23);
  DenseSystem system;
  for (const int n : {1, 2, 3, 4, 5, 8, 11, 12, 36, 45, 97, 203, 6}) {
    const Eigen::MatrixXd A = answers_of_contacts(Eigen::MatrixXd::Random(n, n));
    write(A, system);
    ASSERT_TRUE(system.factor_in_order()) << n;
    expect_solutions_of_eigen(A, system);
  }
}

TEST(DenseSystem, SolvesInOrderWhatIsMostlyZerosAsEigen) {
  std::srand(29);
  constexpr int kBlock = 9;
  DenseSystem system;
  for (const int blocks : {12, 31}) {
    // each has a part in itself and in the one after the next, the last in all
    Eigen::MatrixXd root = Eigen::MatrixXd::Random(blocks * kBlock, blocks * kBlock);
    for (int c = 0; c < root.cols(); ++c)
      for (int r = 0; r < root.rows(); ++r) {
        const int row = r / kBlock, column = c / kBlock;
        if (row != column && row != column + 2 && row != blocks - 1) root(r, c) = 0;
      }
    const Eigen::MatrixXd A = answers_of_contacts(root);
    write(A, system);
    ASSERT_TRUE(system.factor_in_order());
    expect_solutions_of_eigen(A, system);
  }
}

TEST(DenseSystem, SaysWherePivotsInOrderVanish) {
  DenseSystem system;
  for (const double left : {1e-3, 1e-5, 0.0, -1e-3}) {
    // the pivot of the last is what the others leave of its diagonal
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(7, 7);
    A(2, 6) = A(6, 2) = std::sqrt(1 - left);
    write(A, system);
    EXPECT_EQ(system.factor_in_order(), left == 1e-3) << left;
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
  for (const int rows : {3, 4, 45}) {
    const Eigen::MatrixXd G = Eigen::MatrixXd::Random(rows, 3);
    const Eigen::Vector3d x = Eigen::Vector3d::Random();
    Eigen::VectorXd sum = Eigen::VectorXd::Random(rows);
    const Eigen::VectorXd expected = sum + G * x;
    add_three_columns(G.data(), static_cast<std::size_t>(rows), x.data(), sum.data(), static_cast<std::size_t>(rows));
    EXPECT_LE((sum - expected).norm(), 1e-14);
  }
}

TEST(WideLinks, EliminatePointsAndAHingeAsTheirFormulasSay) {
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  using Eigen::MatrixXd;
  std::srand(13);
  for (const std::string kind : {"point", "damped point", "hinge"})
    for (const bool has_parent : {false, true}) {
      SCOPED_TRACE(kind + (has_parent ? " on a parent" : " on the world"));
      const bool hinge = kind == "hinge";
      const Mat6 root = Mat6::Random();
      const Mat6 H = root * root.transpose() + Mat6::Identity();
      const Vec3 r = Vec3::Random(), r_parent = Vec3::Random(), axis = Vec3::Random().normalized();
      const double damping = 0.3;
      const Mat3 half = Mat3::Random();
      const Mat3 damper = half * half.transpose();
      const Mat6 before = Mat6::Random();
      Mat6 D, X, H_parent = before;
      double* onto = has_parent ? H_parent.data() : nullptr;
      if (hinge) {
        eliminate_hinge(H.data(), r.data(), r_parent.data(), axis.data(), damping, D.data(), X.data(), onto);
      } else if (kind == "damped point") {
        eliminate_damped_point(H.data(), r.data(), r_parent.data(), damper.data(), D.data(), X.data(), onto);
      } else {
        eliminate_point(H.data(), r.data(), r_parent.data(), D.data(), X.data(), onto);
      }

      MatrixXd S(6, hinge ? 1 : 3);
      const MatrixXd turning = hinge ? MatrixXd(axis) : MatrixXd(Mat3::Identity());
      S << skew(r) * turning, turning;
      MatrixXd K = S.transpose() * H * S;
      if (hinge) K(0, 0) += damping;
      if (kind == "damped point") K += damper;
      const Mat6 answer = S * K.inverse() * S.transpose();
      Mat6 locked = Mat6::Identity();
      locked.topRightCorner<3, 3>() = -skew(r_parent - r);
      EXPECT_LE((D - answer).norm(), 1e-13 * answer.norm());
      const Mat6 motion = locked - answer * H * locked;
      EXPECT_LE((X - (has_parent ? motion : Mat6::Zero())).norm(), 1e-12);
      const Mat6 felt = locked.transpose() * H * motion;
      EXPECT_LE((H_parent - before - (has_parent ? felt : Mat6::Zero())).norm(), 1e-12 * H.norm());
    }
}

TEST(WideLinks, CarryForcesAndMotionsAsTheirFormulasSay) {
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  std::srand(31);
  const Mat6 H = Mat6::Random(), X = Mat6::Random(), D = Mat6::Random();
  const Vec3 bias = Vec3::Random();
  const Vec6 force = Vec6::Random(), parent = Vec6::Random(), motion = Vec6::Random(), above = Vec6::Random();
  Vec6 left = force, carried = parent, moved = motion, alone = motion;
  take_bias(H.data(), bias.data(), left.data());
  pass_up(X.data(), force.data(), carried.data());
  answer(D.data(), force.data(), X.data(), above.data(), moved.data());
  answer(D.data(), force.data(), X.data(), nullptr, alone.data());
  EXPECT_LE((left - (force - H.leftCols<3>() * bias)).norm(), 1e-14);
  EXPECT_LE((carried - (parent + X.transpose() * force)).norm(), 1e-14);
  EXPECT_LE((moved - (motion + D * force + X * above)).norm(), 1e-14);
  EXPECT_LE((alone - (motion + D * force)).norm(), 1e-14);
}

}  // namespace
}  // namespace engine
