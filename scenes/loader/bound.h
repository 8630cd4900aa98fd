// Keys bound to fields: `bound<&Shot::speed>({"speed", Type::number, ...})` is all a key needs whose value goes as it is into a
// field. `Reader::fill` reads them; schema, reference and refusal come from the same line.
#pragma once

#include <type_traits>

#include "scenes/loader/reader.h"

namespace scenes {

namespace detail {

/// Its address stands for the type.
template <class T>
inline constexpr char kOwner = 0;

template <class M>
struct MemberOf;
template <class C, class T>
struct MemberOf<T C::*> {
  using Class = C;
};

template <auto first, auto... rest, class Object>
auto& at(Object& object) {
  if constexpr (sizeof...(rest) == 0)
    return object.*first;
  else
    return at<rest...>(object.*first);
}

}  // namespace detail

/// The key, bound to a field: a member of a struct, or a member of a member.
template <auto first, auto... rest>
constexpr Key bound(Key key) {
  using Object = typename detail::MemberOf<decltype(first)>::Class;
  key.owner = &detail::kOwner<Object>;
  key.fill = [](Reader& r, std::string_view name, void* object) {
    r.read(name, detail::at<first, rest...>(*static_cast<Object*>(object)));
  };
  return key;
}

template <class T>
void Reader::fill(T& object) {
  for (const Key& key : section_->keys)
    if (key.owner == &detail::kOwner<T>) key.fill(*this, key.name, &object);
}

template <class T>
void Reader::read(std::string_view key, T& out) {
  const Key* line = nullptr;
  if (!get(key, line)) return;
  const bool word = line->type == Type::choice;
  if constexpr (std::is_same_v<T, bool>)
    out = word ? choice(key) == 1 : boolean(key);
  else if constexpr (std::is_same_v<T, int>)
    out = integer(key);
  else if constexpr (std::is_same_v<T, double>)
    out = number(key);
  else if constexpr (std::is_same_v<T, std::string>)
    out = word ? split_choices(line->choices)[static_cast<std::size_t>(choice(key))] : text(key);
  else if constexpr (std::is_enum_v<T>)
    out = static_cast<T>(choice(key));
  else if constexpr (std::is_same_v<T, engine::Vec3>)
    out = vector(key);
  else if constexpr (std::is_same_v<T, engine::Mat3>)
    out = inertia(key);
  else if constexpr (std::is_same_v<T, engine::Schedule>)
    out = schedule(key);
  else if constexpr (std::is_same_v<T, std::vector<double>>)
    out = numbers(key);
  else if constexpr (std::is_same_v<T, std::vector<std::string>>)
    out = texts(key);
  else
    read(key, out.emplace());
}

}  // namespace scenes
