#include "hw/base/param.h"

#include <charconv>
#include <cmath>

namespace quadrille::hw {

std::string_view effect_name(Effect effect) {
  switch (effect) {
    case Effect::kFaster: return "faster";
    case Effect::kSlower: return "slower";
    case Effect::kTradeOff: return "trade-off";
    case Effect::kPicture: return "picture";
    case Effect::kNeutral: return "neutral";
  }
  return "";
}

ParamBase* ParamGroup::find(std::string_view name) const {
  for (ParamBase* p : params_)
    if (p->name() == name) return p;
  return nullptr;
}

template <class T>
std::string Param<T>::legal_text() const {
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  else return fmt::format("{} to {}", range_.min, range_.max);
}

template <class T>
std::vector<std::string_view> Param<T>::words() const {
  if constexpr (std::is_same_v<T, bool>) return {"false", "true"};
  else return {};
}

template <class T>
void Param<T>::set(T value) {
  if constexpr (!std::is_same_v<T, bool>) {
    if (!(value >= range_.min && value <= range_.max))
      throw user_error("{} is out of range; legal: {}", value, legal_text());
  }
  value_ = value;
}

template <class T>
void Param<T>::parse(std::string_view text) {
  if constexpr (std::is_same_v<T, bool>) {
    if (text != "true" && text != "false") throw user_error("'{}' is not true or false", text);
    set(text == "true");
  } else {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
      throw user_error("'{}' is not {}; legal: {}", text,
                       std::is_same_v<T, double> ? "a number" : "a whole number", legal_text());
    }
    set(value);
  }
}

template class Param<int>;
template class Param<std::int64_t>;
template class Param<double>;
template class Param<bool>;

}  // namespace quadrille::hw
