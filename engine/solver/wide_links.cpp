#include "engine/solver/wide_links.h"

#include <cstring>

// Vectors in and out of functions that are all in line: how a call would pass them does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace engine {
namespace {

namespace plain {
#include "engine/solver/wide_links_text.h"
}

#if defined(__x86_64__) && !defined(__clang__)
// Without fused multiply-add, so that all processors find the same bits.
#pragma GCC push_options
#pragma GCC target("avx2")
namespace wide {
#include "engine/solver/wide_links_text.h"
}
#pragma GCC pop_options
const bool kWide = __builtin_cpu_supports("avx2");
#else
namespace wide = plain;
constexpr bool kWide = false;
#endif

}  // namespace

void eliminate_point(const double* H, const double* r, const double* r_parent, double* D, double* X, double* H_parent) {
  kWide ? wide::eliminate_point(H, r, r_parent, D, X, H_parent) : plain::eliminate_point(H, r, r_parent, D, X, H_parent);
}

void eliminate_damped_point(const double* H, const double* r, const double* r_parent, const double* damping, double* D, double* X,
                            double* H_parent) {
  kWide ? wide::eliminate_damped_point(H, r, r_parent, damping, D, X, H_parent)
        : plain::eliminate_damped_point(H, r, r_parent, damping, D, X, H_parent);
}

void eliminate_hinge(const double* H, const double* r, const double* r_parent, const double* axis, double damping, double* D,
                     double* X, double* H_parent) {
  kWide ? wide::eliminate_hinge(H, r, r_parent, axis, damping, D, X, H_parent)
        : plain::eliminate_hinge(H, r, r_parent, axis, damping, D, X, H_parent);
}

void turn_inertia(const double* q, const double* inertia, double* turned) {
  kWide ? wide::turn_inertia(q, inertia, turned) : plain::turn_inertia(q, inertia, turned);
}

void take_bias(const double* H, const double* bias, double* force) {
  kWide ? wide::take_bias(H, bias, force) : plain::take_bias(H, bias, force);
}

void pass_up(const double* X, const double* force, double* force_parent) {
  kWide ? wide::pass_up(X, force, force_parent) : plain::pass_up(X, force, force_parent);
}

void answer(const double* D, const double* force, const double* X, const double* a_parent, double* a) {
  kWide ? wide::answer(D, force, X, a_parent, a) : plain::answer(D, force, X, a_parent, a);
}

}  // namespace engine
