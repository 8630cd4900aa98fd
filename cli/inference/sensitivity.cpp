// y = sum over a of c_a Phi_a(u), Phi_a the product of one-dimensional polynomials that are orthonormal for a uniform share u
// (Legendre) or for the choices' weights. Then Var y = sum over a != 0 of c_a^2 + scatter, first order of input i: sum of c_a^2
// with only a_i > 0; total: sum of c_a^2 with a_i > 0. The scatter is the mean square of the error at runs left out of the fit, in
// closed form r_k / (1 - h_k) with the leverage h_k.
#include "cli/inference/sensitivity.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/inference/sequence.h"
#include "cli/study/statistics.h"

namespace cli::inference {
namespace {

constexpr std::size_t kFewestRuns = 20;
constexpr int kHighestDegree = 5;
constexpr std::size_t kMostTerms = 120;
constexpr int kResamples = 50;

using Exponents = std::vector<int>;

/// Orthonormal polynomials 0..kHighestDegree at x in -1..1 for uniform x: sqrt(2k + 1) P_k.
std::vector<double> legendre(double x) {
  std::vector<double> p{1, x};
  for (int k = 1; k < kHighestDegree; ++k) p.push_back(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1));
  for (int k = 0; k <= kHighestDegree; ++k) p[k] *= std::sqrt(2.0 * k + 1);
  return p;
}

/// The same for every choice under the choices' weights, by Gram and Schmidt; as many as there are choices, zero beyond.
std::vector<std::vector<double>> for_choices(const std::vector<double>& weights) {
  const std::size_t n = weights.size();
  std::vector<std::vector<double>> out(n, std::vector<double>(kHighestDegree + 1, 0.0));
  for (int k = 0; k <= kHighestDegree && k < static_cast<int>(n); ++k) {
    std::vector<double> column(n);
    for (std::size_t i = 0; i < n; ++i) column[i] = std::pow(static_cast<double>(i), k);
    for (int j = 0; j < k; ++j) {
      double dot = 0;
      for (std::size_t i = 0; i < n; ++i) dot += weights[i] * column[i] * out[i][j];
      for (std::size_t i = 0; i < n; ++i) column[i] -= dot * out[i][j];
    }
    double norm = 0;
    for (std::size_t i = 0; i < n; ++i) norm += weights[i] * column[i] * column[i];
    for (std::size_t i = 0; i < n; ++i) out[i][k] = norm > 1e-12 ? column[i] / std::sqrt(norm) : 0;
  }
  return out;
}

void add_terms(int inputs, int degree, Exponents& sofar, std::vector<Exponents>& out) {
  if (static_cast<int>(sofar.size()) == inputs) {
    out.push_back(sofar);
    return;
  }
  const int used = std::accumulate(sofar.begin(), sofar.end(), 0);
  for (int k = 0; k <= degree - used; ++k) {
    sofar.push_back(k);
    add_terms(inputs, degree, sofar, out);
    sofar.pop_back();
  }
}

std::vector<Exponents> terms_of(int inputs, int degree) {
  std::vector<Exponents> out;
  Exponents sofar;
  add_terms(inputs, degree, sofar, out);
  return out;  // the first is the constant
}

/// One-dimensional polynomials of every run and input.
using Basis = std::vector<std::vector<std::vector<double>>>;

Basis basis_of(const std::vector<scenes::Uncertain>& inputs, const std::vector<std::vector<double>>& shares) {
  std::vector<std::vector<std::vector<double>>> choices;
  for (const auto& input : inputs)
    choices.push_back(input.spread == scenes::Spread::choice ? for_choices(input.weights) : std::vector<std::vector<double>>());
  Basis out;
  for (const std::vector<double>& u : shares) {
    out.emplace_back();
    for (std::size_t i = 0; i < inputs.size(); ++i)
      out.back().push_back(choices[i].empty() ? legendre(2 * u[i] - 1)
                                              : choices[i][static_cast<std::size_t>(quantile(inputs[i], u[i]))]);
  }
  return out;
}

Eigen::MatrixXd design(const Basis& basis, const std::vector<Exponents>& terms) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(basis.size()), static_cast<Eigen::Index>(terms.size()));
  for (Eigen::Index r = 0; r < out.rows(); ++r)
    for (Eigen::Index t = 0; t < out.cols(); ++t) {
      double product = 1;
      const auto& a = terms[static_cast<std::size_t>(t)];
      for (std::size_t i = 0; i < a.size(); ++i) product *= basis[static_cast<std::size_t>(r)][i][static_cast<std::size_t>(a[i])];
      out(r, t) = product;
    }
  return out;
}

struct LeastSquares {
  Eigen::VectorXd coefficients;
  double left_out = 0;  // mean square of the errors at runs left out
};

LeastSquares fitted(const Eigen::MatrixXd& X, const Eigen::VectorXd& y) {
  // choices have fewer polynomials than degrees: columns of zeros, which the pivoting leaves out
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(X);
  LeastSquares out;
  out.coefficients = qr.solve(y);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(X.rows(), qr.rank());
  const Eigen::VectorXd residual = y - X * out.coefficients;
  for (Eigen::Index r = 0; r < X.rows(); ++r) {
    const double leverage = std::min(0.999, Q.row(r).squaredNorm());
    out.left_out += std::pow(residual[r] / (1 - leverage), 2);
  }
  out.left_out /= static_cast<double>(X.rows());
  return out;
}

/// first, then total, then scatter.
std::vector<double> shares_of(const LeastSquares& fit, const std::vector<Exponents>& terms, std::size_t inputs) {
  std::vector<double> out(2 * inputs + 1, 0);
  double sum = fit.left_out;
  for (std::size_t t = 1; t < terms.size(); ++t) {
    const double square = std::pow(fit.coefficients[static_cast<Eigen::Index>(t)], 2);
    sum += square;
    const auto active = std::count_if(terms[t].begin(), terms[t].end(), [](int k) { return k > 0; });
    for (std::size_t i = 0; i < inputs; ++i) {
      if (terms[t][i] == 0) continue;
      out[inputs + i] += square;
      if (active == 1) out[i] += square;
    }
  }
  out.back() = fit.left_out;
  for (double& x : out) x /= sum;
  return out;
}

}  // namespace

Sensitivity sensitivity(const std::vector<scenes::Uncertain>& inputs, const std::vector<std::vector<double>>& shares,
                        const std::vector<double>& output, std::uint64_t seed) {
  std::vector<std::vector<double>> u;
  std::vector<double> values;
  for (std::size_t r = 0; r < output.size(); ++r) {
    if (!std::isfinite(output[r])) continue;
    u.push_back(shares[r]);
    values.push_back(output[r]);
  }
  Sensitivity out;
  const std::size_t n = values.size();
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (inputs.empty() || n < kFewestRuns || !(*most - *least > 1e-9 * std::max(std::abs(*most), std::abs(*least)))) return out;
  const Eigen::VectorXd y = Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(n));
  const Basis basis = basis_of(inputs, u);
  std::vector<Exponents> terms;
  Eigen::MatrixXd X;
  LeastSquares best;
  for (int degree = 1; degree <= kHighestDegree; ++degree) {
    std::vector<Exponents> candidate = terms_of(static_cast<int>(inputs.size()), degree);
    if (degree > 1 && (candidate.size() > kMostTerms || 3 * candidate.size() > n)) break;
    Eigen::MatrixXd matrix = design(basis, candidate);
    const LeastSquares fit = fitted(matrix, y);
    if (degree > 1 && fit.left_out >= best.left_out) continue;
    best = fit;
    terms = std::move(candidate);
    X = std::move(matrix);
    out.degree = degree;
  }
  const std::vector<double> own = shares_of(best, terms, inputs.size());
  std::vector<std::vector<double>> clouds(own.size());
  for (int b = 0; b < kResamples; ++b) {
    Eigen::MatrixXd Xb(X.rows(), X.cols());
    Eigen::VectorXd yb(y.size());
    for (Eigen::Index r = 0; r < X.rows(); ++r) {
      const auto pick =
          static_cast<Eigen::Index>(mixed(seed ^ mixed(static_cast<std::uint64_t>(b) * 1000003 + static_cast<std::uint64_t>(r))) %
                                    static_cast<std::uint64_t>(n));
      Xb.row(r) = X.row(pick);
      yb[r] = y[pick];
    }
    const std::vector<double> again = shares_of(fitted(Xb, yb), terms, inputs.size());
    for (std::size_t k = 0; k < own.size(); ++k) clouds[k].push_back(again[k]);
  }
  const auto share = [&](std::size_t k) {
    return Share{own[k], std::min(own[k], study::percentile(clouds[k], 0.05)),
                 std::max(own[k], study::percentile(clouds[k], 0.95))};
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    out.first.push_back(share(i));
    out.total.push_back(share(inputs.size() + i));
  }
  out.scatter = share(own.size() - 1);
  out.runs = n;
  return out;
}

}  // namespace cli::inference
