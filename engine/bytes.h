// Values as bytes and back, every field by its bits: what State is compared, hashed and saved by. A struct takes part that has
// `template <class S> static auto fields(S& s) { return std::tie(s.a, s.b); }`.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "engine/math/types.h"

namespace engine {

using Bytes = std::vector<std::uint8_t>;

template <class T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class T>
concept FixedMatrix = requires {
  requires T::SizeAtCompileTime >
  0;
};
template <class T>
concept HasFields = requires(T& t) {
  T::fields(t);
};

class ByteWriter {
 public:
  template <PlainValue T>
  void put(const T& value) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof value);
  }
  template <FixedMatrix T>
  void put(const T& value) {
    for (Eigen::Index i = 0; i < value.size(); ++i) put(value.data()[i]);
  }
  void put(const Quat& q) { put(q.coeffs()); }
  void put(const Pose& X) { put(X.p), put(X.q); }
  void put(const Twist& V) { put(V.v), put(V.w); }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) put(value);
  }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& values) {
    for (const T& value : values) put(value);
  }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    for (const char c : text) put(c);
  }
  template <HasFields T>
  void put(const T& value) {
    std::apply([this](const auto&... field) { (this->put(field), ...); }, T::fields(value));
  }

  Bytes bytes;
};

/// Reads what ByteWriter wrote. Past the end, and from what is damaged, every value is left as it was and `good` turns false.
class ByteReader {
 public:
  explicit ByteReader(const Bytes& bytes) : bytes_(bytes) {}

  template <PlainValue T>
  void get(T& value) {
    good = good && bytes_.size() - at_ >= sizeof value;
    if (!good) return;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
  }
  /// 0 or 1: any other byte is damage and no value at all.
  void get(bool& value) {
    std::uint8_t byte = 0;
    get(byte);
    good = good && byte <= 1;
    if (good) value = byte == 1;
  }
  template <FixedMatrix T>
  void get(T& value) {
    for (Eigen::Index i = 0; i < value.size(); ++i) get(value.data()[i]);
  }
  void get(Quat& q) { get(q.coeffs()); }
  void get(Pose& X) { get(X.p), get(X.q); }
  void get(Twist& V) { get(V.v), get(V.w); }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(size());
    for (T& value : values) get(value);
  }
  template <class T, std::size_t n>
  void get(std::array<T, n>& values) {
    for (T& value : values) get(value);
  }
  void get(std::string& text) {
    text.resize(size());
    for (char& c : text) get(c);
  }
  template <HasFields T>
  void get(T& value) {
    std::apply([this](auto&... field) { (this->get(field), ...); }, T::fields(value));
  }

  /// Of a list: no more than there are bytes left, so that what is damaged asks for no memory.
  std::size_t size() {
    std::uint64_t count = 0;
    get(count);
    good = good && count <= bytes_.size() - at_;
    return good ? static_cast<std::size_t>(count) : 0;
  }
  bool at_end() const { return good && at_ == bytes_.size(); }

  bool good = true;

 private:
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

}  // namespace engine
