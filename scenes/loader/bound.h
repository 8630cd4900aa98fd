// Keys bound to fields: `bound<&Shot::speed>({"speed", Type::number, ...})` is all a key needs whose value goes as it is into a
// field. `Reader::fill` reads them; schema, reference and refusal come from the same line. Where a section makes something else of
// its values, they are fields of a struct in the section's file.
#pragma once

#include <array>
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

/// The key of a value that two fields take alike.
template <auto first, auto second>
constexpr Key bound_to_both(Key key) {
  using Object = typename detail::MemberOf<decltype(first)>::Class;
  key.owner = &detail::kOwner<Object>;
  key.fill = [](Reader& r, std::string_view name, void* object) {
    Object& out = *static_cast<Object*>(object);
    if (r.read(name, out.*first)) out.*second = out.*first;
  };
  return key;
}

/// The key of a range whose ends are two fields.
template <auto lower, auto upper>
constexpr Key bound_to_ends(Key key) {
  using Object = typename detail::MemberOf<decltype(lower)>::Class;
  key.owner = &detail::kOwner<Object>;
  key.fill = [](Reader& r, std::string_view name, void* object) {
    Object& out = *static_cast<Object*>(object);
    if (std::array<double, 2> ends{}; r.read(name, ends)) out.*lower = ends[0], out.*upper = ends[1];
  };
  return key;
}

/// The key of a choice of two words: true for the first.
template <auto field>
constexpr Key bound_to_first_word(Key key) {
  using Object = typename detail::MemberOf<decltype(field)>::Class;
  key.owner = &detail::kOwner<Object>;
  key.fill = [](Reader& r, std::string_view name, void* object) { static_cast<Object*>(object)->*field = r.choice(name) == 0; };
  return key;
}

template <class T>
void Reader::fill(T& object) {
  for (const Key& key : section_->keys)
    if (key.owner == &detail::kOwner<T>) key.fill(*this, key.name, &object);
}

template <class T>
bool Reader::read(std::string_view key, T& out) {
  const Key* line = nullptr;
  if (!get(key, line)) return false;
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
  else if constexpr (std::is_same_v<T, std::array<double, 2>>)
    out = range(key);
  else if constexpr (std::is_same_v<T, std::array<float, 3>>)
    out = colour(key);
  else
    read(key, out.emplace());  // std::optional
  return true;
}

}  // namespace scenes
