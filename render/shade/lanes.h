// Eight pixels at a time: arithmetic on vectors of eight, for the files that are compiled once for every processor and once for
// those with wider registers. Every operation rounds as IEEE 754 says and none is fused, so both give the same bits. No function of
// the standard library: a copy compiled for the wider registers must not be linked into the rest of the program.
#pragma once

#include <cstdint>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define LANES inline __attribute__((always_inline))
#define LANES_BODY __attribute__((always_inline))  // of a lambda

namespace render::shade {
namespace {

constexpr int kLanes = 8;
typedef float F __attribute__((vector_size(32)));
typedef std::int32_t I __attribute__((vector_size(32)));  // also the answer of a comparison: all bits or none

LANES F all(float x) {
  return F{} + x;
}
LANES I all(int x) {
  return I{} + x;
}
LANES F count_up(float from) {
  return F{0, 1, 2, 3, 4, 5, 6, 7} + from;
}

LANES bool any(I mask) {
#if defined(__AVX2__)
  return _mm256_movemask_ps(reinterpret_cast<__m256>(mask)) != 0;
#else
  for (int i = 0; i < kLanes; ++i)
    if (mask[i]) return true;
  return false;
#endif
}

LANES I load_int(const std::int32_t* from) {
  I v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
LANES F load(const float* from) {
  F v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
LANES void store(F v, float* to) {
  __builtin_memcpy(to, &v, sizeof v);
}
LANES void store(I v, std::int32_t* to) {
  __builtin_memcpy(to, &v, sizeof v);
}

LANES F to_float(I x) {
  return __builtin_convertvector(x, F);
}
LANES I to_int(F x) {
  return __builtin_convertvector(x, I);
}  // towards zero

LANES F min(F a, F b) {
  return a < b ? a : b;
}
LANES F max(F a, F b) {
  return a > b ? a : b;
}
LANES F min(F a, float b) {
  return min(a, all(b));
}
LANES F max(F a, float b) {
  return max(a, all(b));
}
LANES I clamp(I x, int low, int high) {
  x = x < low ? all(low) : x;
  return x > high ? all(high) : x;
}
LANES F clamp(F x, float low, float high) {
  return min(max(x, low), high);
}
LANES F saturate(F x) {
  return clamp(x, 0, 1);
}
LANES F abs(F x) {
  return reinterpret_cast<F>(reinterpret_cast<I>(x) & 0x7fffffff);
}
LANES F mix(F a, F b, F s) {
  return a + (b - a) * s;
}
LANES F mix(float a, float b, F s) {
  return a + (b - a) * s;
}
LANES F floor(F x) {  // |x| < 2^31
#if defined(__AVX__)
  return reinterpret_cast<F>(_mm256_floor_ps(reinterpret_cast<__m256>(x)));
#else
  const F t = to_float(to_int(x));
  return t > x ? t - 1.0f : t;
#endif
}
LANES F fract(F x) {
  return x - floor(x);
}
LANES F smoothstep(float low, float high, F x) {
  const F t = saturate((x - low) * (1 / (high - low)));
  return t * t * (3.0f - 2.0f * t);
}
LANES F step(F edge, F x) {
  return x < edge ? all(0.0f) : all(1.0f);
}

LANES F sqrt(F x) {
#if defined(__AVX__)
  return reinterpret_cast<F>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#else
  F r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrtf(x[i]);
  return r;
#endif
}

/// 2^x to 2e-7, for x within the exponents of a float.
LANES F exp2(F x) {
  x = clamp(x, -126, 126);
  const F whole = floor(x + 0.5f), f = x - whole;
  const F p =
      1.0f + f * (0.69314718f + f * (0.24022651f + f * (0.05550411f + f * (0.00961813f + f * (0.00133336f + f * 0.00015404f)))));
  return p * reinterpret_cast<F>((to_int(whole) + 127) << 23);
}
LANES F exp(F x) {
  return exp2(x * 1.44269504f);
}

/// Logarithm to base 2 of x > 0, to 1e-7: series of the inverse hyperbolic tangent about the middle of an octave.
LANES F log2(F x) {
  const I bits = reinterpret_cast<I>(x);
  I exponent = (bits >> 23) - 127;
  F m = reinterpret_cast<F>((bits & 0x7fffff) | 0x3f800000);
  const I high = m > 1.41421356f;
  m = high ? m * 0.5f : m;
  exponent = high ? exponent + 1 : exponent;
  const F t = (m - 1.0f) / (m + 1.0f), t2 = t * t;
  return to_float(exponent) + t * (2.88539008f + t2 * (0.96179669f + t2 * (0.57707802f + t2 * 0.41219858f)));
}
/// x^e for x in 0..1, e >= 1.
LANES F pow(F x, F e) {
  return x > 1e-30f ? exp2(e * log2(max(x, 1e-30f))) : all(0.0f);
}

/// Sine and cosine of a turn 0..1, to 1e-3: where samples lie, not how bright they are.
LANES F sine_of_turn(F turn) {
  const F x = 2.0f * fract(turn + 0.5f) - 1.0f;  // -1..1: half a turn each way
  const F y = 4.0f * x * (1.0f - abs(x));
  return y * (0.775f + 0.225f * abs(y));
}

LANES F gather(const float* from, I at) {
#if defined(__AVX2__)
  return reinterpret_cast<F>(_mm256_i32gather_ps(from, reinterpret_cast<__m256i>(at), 4));
#else
  F r;
  for (int i = 0; i < kLanes; ++i) r[i] = from[at[i]];
  return r;
#endif
}
LANES I gather(const std::int32_t* from, I at) {
#if defined(__AVX2__)
  return reinterpret_cast<I>(_mm256_i32gather_epi32(from, reinterpret_cast<__m256i>(at), 4));
#else
  I r;
  for (int i = 0; i < kLanes; ++i) r[i] = from[at[i]];
  return r;
#endif
}

/// Eight records of eight numbers; afterwards number k of all of them in eight[k].
LANES void turn(F (&eight)[kLanes]) {
  F a[kLanes], b[kLanes];
  for (int i = 0; i < kLanes; i += 2) {
    a[i] = __builtin_shufflevector(eight[i], eight[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    a[i + 1] = __builtin_shufflevector(eight[i], eight[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int i = 0; i < kLanes; i += 4)
    for (int k = 0; k < 2; ++k) {
      b[i + 2 * k] = __builtin_shufflevector(a[i + k], a[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      b[i + 2 * k + 1] = __builtin_shufflevector(a[i + k], a[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int k = 0; k < 4; ++k) {
    eight[k] = __builtin_shufflevector(b[k], b[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    eight[k + 4] = __builtin_shufflevector(b[k], b[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

struct V2 {
  F x, y;
};
struct V3 {
  F x, y, z;
};
LANES V2 two(float x, float y) {
  return {all(x), all(y)};
}
LANES V3 three(float x, float y, float z) {
  return {all(x), all(y), all(z)};
}
LANES V3 three(const float* v) {
  return three(v[0], v[1], v[2]);
}
LANES V3 operator+(const V3& a, const V3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
LANES V3 operator-(const V3& a, const V3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LANES V3 operator*(const V3& a, const V3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
LANES V3 operator*(const V3& a, F s) {
  return {a.x * s, a.y * s, a.z * s};
}
LANES V3 operator*(const V3& a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
LANES V3 operator+(const V3& a, F s) {
  return {a.x + s, a.y + s, a.z + s};
}
LANES F dot(const V3& a, const V3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
LANES F length(const V3& a) {
  return sqrt(dot(a, a));
}
LANES V3 normalize(const V3& a) {
  return a * (1.0f / sqrt(dot(a, a)));
}
LANES V3 mix(const V3& a, const V3& b, F s) {
  return {mix(a.x, b.x, s), mix(a.y, b.y, s), mix(a.z, b.z, s)};
}
LANES V3 max(const V3& a, float s) {
  return {max(a.x, s), max(a.y, s), max(a.z, s)};
}

}  // namespace
}  // namespace render::shade
