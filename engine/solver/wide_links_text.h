// Text of wide_links.cpp, which compiles it once for every kind of processor: no guard, no includes.

using Four = double __attribute__((vector_size(4 * sizeof(double))));
using Two = double __attribute__((vector_size(2 * sizeof(double))));
using Lanes = long long __attribute__((vector_size(4 * sizeof(double))));

/// A 3x3 matrix by columns, or three columns of another; the last lane has no meaning.
struct Three {
  Four c0, c1, c2;
};

inline Four load(const double* p) {
  Two upper;
  std::memcpy(&upper, p, sizeof upper);
  const Two third = {p[2], p[2]};
  return __builtin_shufflevector(upper, third, 0, 1, 2, 3);
}

inline void store(double* p, const Four& v) {
  const Two upper = __builtin_shufflevector(v, v, 0, 1);
  std::memcpy(p, &upper, sizeof upper);
  p[2] = v[2];
}

/// Blocks of a 6x6 matrix: `p` is where the block begins.
inline Three load_block(const double* p) {
  return {load(p), load(p + 6), load(p + 12)};
}

inline void store_block(double* p, const Three& m) {
  store(p, m.c0), store(p + 6, m.c1), store(p + 12, m.c2);
}

inline void add_to_block(double* p, const Three& m) {
  store(p, load(p) + m.c0), store(p + 6, load(p + 6) + m.c1), store(p + 12, load(p + 12) + m.c2);
}

inline Three operator+(const Three& a, const Three& b) {
  return {a.c0 + b.c0, a.c1 + b.c1, a.c2 + b.c2};
}

inline Three operator-(const Three& a, const Three& b) {
  return {a.c0 - b.c0, a.c1 - b.c1, a.c2 - b.c2};
}

inline Three operator-(const Three& a) {
  return {-a.c0, -a.c1, -a.c2};
}

inline Three transpose(const Three& m) {
  const Four even = __builtin_shufflevector(m.c0, m.c1, 0, 4, 2, 6), odd = __builtin_shufflevector(m.c0, m.c1, 1, 5, 3, 7);
  return {__builtin_shufflevector(even, m.c2, 0, 1, 4, 7), __builtin_shufflevector(odd, m.c2, 0, 1, 5, 7),
          __builtin_shufflevector(even, m.c2, 2, 3, 6, 7)};
}

inline Four cross(const Four& a, const Four& b) {
  return __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(b, b, 2, 0, 1, 3) -
         __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(b, b, 1, 2, 0, 3);
}

inline Three skew_times(const Four& r, const Three& m) {
  return {cross(r, m.c0), cross(r, m.c1), cross(r, m.c2)};
}

inline Three times_skew(const Three& m, const Four& r) {
  return {r[2] * m.c1 - r[1] * m.c2, r[0] * m.c2 - r[2] * m.c0, r[1] * m.c0 - r[0] * m.c1};
}

/// a b^T.
inline Three outer(const Four& a, const Four& b) {
  return {a * b[0], a * b[1], a * b[2]};
}

// The third row of a product is summed from its end, as products of plain code are: one set of bits.
inline Four combined(const Three& m, const Four& v) {
  constexpr Lanes kThird = {0, 0, -1, 0};
  const Four p0 = m.c0 * v[0], p1 = m.c1 * v[1], p2 = m.c2 * v[2];
  return ((kThird ? p2 : p0) + p1) + (kThird ? p0 : p2);
}

inline Three operator*(const Three& m, const Three& n) {
  return {combined(m, n.c0), combined(m, n.c1), combined(m, n.c2)};
}

inline Three inverse(const Three& m) {
  // its rows are cross products of columns over the determinant
  const Four row0 = cross(m.c1, m.c2), row1 = cross(m.c2, m.c0), row2 = cross(m.c0, m.c1);
  const Four terms = row0 * m.c0;
  const double scale = 1 / ((terms[0] + terms[1]) + terms[2]);
  return transpose({row0 * scale, row1 * scale, row2 * scale});
}

/// The matrix of a unit quaternion (x, y, z, w), its numbers as Eigen has them.
inline Three rotation(const Four& q) {
  constexpr Lanes kFirst = {-1, 0, 0, 0}, kSecond = {0, -1, 0, 0}, kThird = {0, 0, -1, 0};
  const Four t = q + q;
  const Four a0 = __builtin_shufflevector(t, t, 1, 1, 2, 3) * __builtin_shufflevector(q, q, 1, 0, 0, 3);
  const Four b0 = __builtin_shufflevector(t, t, 2, 2, 1, 3) * __builtin_shufflevector(q, q, 2, 3, 3, 3);
  const Four a1 = __builtin_shufflevector(t, t, 1, 0, 2, 3) * __builtin_shufflevector(q, q, 0, 0, 1, 3);
  const Four b1 = __builtin_shufflevector(t, t, 2, 2, 0, 3) * __builtin_shufflevector(q, q, 3, 2, 3, 3);
  const Four a2 = __builtin_shufflevector(t, t, 2, 2, 0, 3) * __builtin_shufflevector(q, q, 0, 1, 0, 3);
  const Four b2 = __builtin_shufflevector(t, t, 1, 0, 1, 3) * __builtin_shufflevector(q, q, 3, 3, 1, 3);
  const Four s0 = kThird ? a0 - b0 : a0 + b0, s1 = kFirst ? a1 - b1 : a1 + b1, s2 = kSecond ? a2 - b2 : a2 + b2;
  return {kFirst ? 1 - s0 : s0, kSecond ? 1 - s1 : s1, kThird ? 1 - s2 : s2};
}

inline void turn_inertia(const double* q_in, const double* inertia, double* out) {
  Four q;
  std::memcpy(&q, q_in, sizeof q);
  const Three R = rotation(q), RI = {R.c0 * inertia[0], R.c1 * inertia[4], R.c2 * inertia[8]};
  const Three I = RI * transpose(R);
  store(out, I.c0), store(out + 3, I.c1), store(out + 6, I.c2);
}

/// X0^T rest X0 of what is left of a body's inertia without the joint's freedoms, P, Q above R.
inline void add_rest(double* H_parent, const Four& d, const Three& P, const Three& Q, const Three& R) {
  const Three Pd = -times_skew(P, d), dQ = skew_times(d, Q), upper = Q + Pd;
  add_to_block(H_parent, P);
  add_to_block(H_parent + 3, transpose(upper));
  add_to_block(H_parent + 18, upper);
  add_to_block(H_parent + 21, ((R + dQ) + transpose(dQ)) + skew_times(d, Pd));
}

inline void eliminate_point(const double* H, const double* r_in, const double* r_parent_in, double* D, double* X,
                            double* H_parent) {
  // the point's motion turns the body: S = [skew(r); 1], and what passes through the joint is a force at the point
  const Four r = load(r_in);
  const Three M = load_block(H);
  const Three HS = times_skew(M, r) + load_block(H + 18);
  const Three K = (times_skew(load_block(H + 3), r) + load_block(H + 21)) - skew_times(r, HS);
  const Three Ki = inverse(K);
  const Three RK = skew_times(r, Ki);
  store_block(D, -times_skew(RK, r));
  store_block(D + 3, transpose(RK));
  store_block(D + 18, RK);
  store_block(D + 21, Ki);
  if (!H_parent) {
    std::memset(X, 0, 36 * sizeof(double));
    return;
  }
  const Three U = HS * Ki, Ut = transpose(U);
  const Three A = M - U * transpose(HS);  // of an acceleration of the point, the force at it
  // the body's motion when the point moves, then the point's with the parent
  const Four r_parent = load(r_parent_in);
  const Three one = {Four{1, 0, 0, 0}, Four{0, 1, 0, 0}, Four{0, 0, 1, 0}};
  const Three upper = one - skew_times(r, Ut), lower = -Ut;
  store_block(X, upper);
  store_block(X + 3, lower);
  store_block(X + 18, -times_skew(upper, r_parent));
  store_block(X + 21, -times_skew(lower, r_parent));
  const Three AP = -times_skew(A, r_parent);
  add_to_block(H_parent, A);
  add_to_block(H_parent + 3, transpose(AP));
  add_to_block(H_parent + 18, AP);
  add_to_block(H_parent + 21, skew_times(r_parent, AP));
}

/// m v, all three rows summed in the order of the columns, as products of larger matrices are.
inline Four in_order(const Three& m, const Four& v) {
  return (m.c0 * v[0] + m.c1 * v[1]) + m.c2 * v[2];
}

inline Three in_order(const Three& m, const Three& n) {
  return {in_order(m, n.c0), in_order(m, n.c1), in_order(m, n.c2)};
}

inline void eliminate_damped_point(const double* H, const double* r_in, const double* r_parent_in, const double* damping, double* D,
                                   double* X, double* H_parent) {
  const Four r = load(r_in);
  const Three M = load_block(H), Q0 = load_block(H + 18), R0 = load_block(H + 21);
  const Three HS0 = times_skew(M, r) + Q0, HS1 = times_skew(load_block(H + 3), r) + R0;
  const Four first = {-r[1], -r[2], r[1], 0}, second = {r[2], r[0], -r[0], 0};
  const auto asked = [&](const Four& of_force, const Four& of_moment) {
    return first * __builtin_shufflevector(of_force, of_force, 2, 0, 0, 3) +
           (second * __builtin_shufflevector(of_force, of_force, 1, 2, 1, 3) + of_moment);
  };
  const Three K = {asked(HS0.c0, HS1.c0) + load(damping), asked(HS0.c1, HS1.c1) + load(damping + 3),
                   asked(HS0.c2, HS1.c2) + load(damping + 6)};
  const Three Ki = inverse(K), SKi = skew_times(r, Ki);
  store_block(D, -times_skew(SKi, r));
  store_block(D + 3, -times_skew(Ki, r));
  store_block(D + 18, SKi);
  store_block(D + 21, Ki);
  if (!H_parent) {
    std::memset(X, 0, 36 * sizeof(double));
    return;
  }
  const Four d = load(r_parent_in) - r;
  const Three one = {Four{1, 0, 0, 0}, Four{0, 1, 0, 0}, Four{0, 0, 1, 0}};
  const Three skew_d = {Four{0, d[2], -d[1], 0}, Four{-d[2], 0, d[0], 0}, Four{d[1], -d[0], 0, 0}};
  const Three U0 = in_order(HS0, Ki), U1 = in_order(HS1, Ki);
  const Three U0t = transpose(U0), UXt = transpose(U1 + skew_times(d, U0));
  store_block(X, one - skew_times(r, U0t));
  store_block(X + 3, -U0t);
  store_block(X + 18, -skew_times(r, UXt) - skew_d);
  store_block(X + 21, one - UXt);
  const Three HS0t = transpose(HS0), HS1t = transpose(HS1);
  add_rest(H_parent, d, M - in_order(U0, HS0t), Q0 - in_order(U0, HS1t), R0 - in_order(U1, HS1t));
}

inline void eliminate_hinge(const double* H, const double* r_in, const double* r_parent_in, const double* axis, double damping,
                            double* D, double* X, double* H_parent) {
  const Four r = load(r_in);
  const Four S1 = load(axis), S0 = cross(r, S1);
  const Three H00 = load_block(H), H10 = load_block(H + 3), H01 = load_block(H + 18), H11 = load_block(H + 21);
  const Four HS0 = H00.c0 * S0[0] + H00.c1 * S0[1] + H00.c2 * S0[2] + H01.c0 * S1[0] + H01.c1 * S1[1] + H01.c2 * S1[2];
  const Four HS1 = H10.c0 * S0[0] + H10.c1 * S0[1] + H10.c2 * S0[2] + H11.c0 * S1[0] + H11.c1 * S1[1] + H11.c2 * S1[2];
  const Four k0 = S0 * HS0, k1 = S1 * HS1;
  const double ki = 1 / (((k0[0] + (k0[2] + k1[1])) + (k0[1] + (k1[0] + k1[2]))) + damping);
  const Four Sk0 = S0 * ki, Sk1 = S1 * ki;
  store_block(D, outer(Sk0, S0));
  store_block(D + 3, outer(Sk1, S0));
  store_block(D + 18, outer(Sk0, S1));
  store_block(D + 21, outer(Sk1, S1));
  if (!H_parent) {
    std::memset(X, 0, 36 * sizeof(double));
    return;
  }
  // X0 = [1, -skew(d); 0, 1] carries the parent's motion as if the joint were locked
  const Four d = load(r_parent_in) - r;
  const Four U0 = HS0 * ki, U1 = HS1 * ki, UX = U1 + cross(d, U0);
  const Three one = {Four{1, 0, 0, 0}, Four{0, 1, 0, 0}, Four{0, 0, 1, 0}};
  const Three skew_d = {Four{0, d[2], -d[1], 0}, Four{-d[2], 0, d[0], 0}, Four{d[1], -d[0], 0, 0}};
  store_block(X, one - outer(S0, U0));
  store_block(X + 3, -outer(S1, U0));
  store_block(X + 18, -outer(S0, UX) - skew_d);
  store_block(X + 21, one - outer(S1, UX));
  add_rest(H_parent, d, H00 - outer(U0, HS0), H01 - outer(U0, HS1), H11 - outer(U1, HS1));
}

/// A force above a moment, or a velocity above an angular velocity.
struct Six {
  Four upper;
  Two lower;
};

inline Six load_six(const double* p) {
  Six six;
  std::memcpy(&six.upper, p, sizeof six.upper);
  std::memcpy(&six.lower, p + 4, sizeof six.lower);
  return six;
}

inline void store_six(double* p, const Six& six) {
  std::memcpy(p, &six.upper, sizeof six.upper);
  std::memcpy(p + 4, &six.lower, sizeof six.lower);
}

inline Six operator+(const Six& a, const Six& b) {
  return {a.upper + b.upper, a.lower + b.lower};
}

/// Columns k and k + 1 of a matrix of six rows by the numbers that go with them.
inline Six two_columns(const double* m, const double* by, int k) {
  const Six a = load_six(m + 6 * k), b = load_six(m + 6 * k + 6);
  return {a.upper * by[k] + b.upper * by[k + 1], a.lower * by[k] + b.lower * by[k + 1]};
}

inline Six times(const double* m, const double* by) {
  return (two_columns(m, by, 0) + two_columns(m, by, 2)) + two_columns(m, by, 4);
}

inline void take_bias(const double* H, const double* bias, double* force) {
  const Six f = load_six(force), two = two_columns(H, bias, 0), third = load_six(H + 12);
  store_six(force, {(f.upper - two.upper) - third.upper * bias[2], (f.lower - two.lower) - third.lower * bias[2]});
}

/// A column's products with a force, summed up to two.
inline Two summed(const double* column, const Six& force) {
  const Six x = load_six(column);
  const Four upper = x.upper * force.upper;
  return (__builtin_shufflevector(upper, upper, 0, 1) + __builtin_shufflevector(upper, upper, 2, 3)) + x.lower * force.lower;
}

inline void pass_up(const double* X, const double* force, double* force_parent) {
  const Six f = load_six(force);
  for (int k = 0; k < 6; k += 2) {
    const Two a = summed(X + 6 * k, f), b = summed(X + 6 * k + 6, f);
    Two sum;
    std::memcpy(&sum, force_parent + k, sizeof sum);
    sum += __builtin_shufflevector(a, b, 0, 2) + __builtin_shufflevector(a, b, 1, 3);
    std::memcpy(force_parent + k, &sum, sizeof sum);
  }
}

inline void answer(const double* D, const double* force, const double* X, const double* a_parent, double* a) {
  Six out = load_six(a) + times(D, force);
  if (a_parent) out = out + times(X, a_parent);
  store_six(a, out);
}
