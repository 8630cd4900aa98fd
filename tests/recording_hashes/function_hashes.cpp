// Hashes of the functions whose bits a recording rests on, each over a million arguments: on another processor quicker to compare
// than recordings, and the first thing to look at where those differ.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>

#include "engine/math/functions.h"

namespace {

constexpr int kArguments = 1'000'000;

class Arguments {
 public:
  /// The generator's bits are defined, those of the library's distributions are not.
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 random_{20261125};
};

template <class Function>
void print_hash(const char* name, const Function& of) {
  Arguments arguments;
  std::uint64_t hash = 1469598103934665603ull;
  for (int i = 0; i < kArguments; ++i) {
    const double value = of(arguments);
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * 1099511628211ull;
  }
  std::printf("%-12s %016llx\n", name, static_cast<unsigned long long>(hash));
}

}  // namespace

int main() {
  namespace math = engine::math;
  print_hash("sin", [](Arguments& a) { return math::sin(a.between(-100, 100)); });
  print_hash("cos", [](Arguments& a) { return math::cos(a.between(-100, 100)); });
  print_hash("tan", [](Arguments& a) { return math::tan(a.between(-100, 100)); });
  print_hash("acos", [](Arguments& a) { return math::acos(a.between(-1, 1)); });
  print_hash("atan", [](Arguments& a) { return math::atan(a.between(-1000, 1000)); });
  print_hash("atan2", [](Arguments& a) {
    const double y = a.between(-10, 10);
    return math::atan2(y, a.between(-10, 10));
  });
  print_hash("two_atan2", [](Arguments& a) {
    const double one = a.between(-10, 10), other = a.between(-10, 10);
    return math::two_atan2({one, other}, {a.between(-10, 10), a.between(-1, 1)}).sum();
  });
  print_hash("exp", [](Arguments& a) { return math::exp(a.between(-100, 100)); });
  print_hash("pow", [](Arguments& a) {
    const double base = a.between(0, 100);
    return math::pow(base, a.between(-20, 20));
  });
  print_hash("tanh", [](Arguments& a) { return math::tanh(a.between(-20, 20)); });
  print_hash("tgamma", [](Arguments& a) { return math::tgamma(a.between(0.1, 50)); });
  print_hash("lgamma", [](Arguments& a) { return math::lgamma(a.between(0.1, 1000)); });
  print_hash("hypot", [](Arguments& a) {
    const double x = a.between(-1000, 1000);
    return math::hypot(x, a.between(-1000, 1000));
  });
  print_hash("two_powers", [](Arguments& a) {
    const double one = a.between(0, 1), other = a.between(0, 1);
    return math::two_powers(one, other, a.between(0.5, 40)).sum();
  });
  return 0;
}
