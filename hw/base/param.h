/// Parameters of units. One line declares name, default, unit, range and reason; the loader, `--set` and
/// `quadrille describe` walk the group.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "models/base/error.h"
#include "models/base/policy.h"

namespace quadrille::hw {

template <class T>
struct ParamRange {
  T min = std::numeric_limits<T>::lowest();
  T max = std::numeric_limits<T>::max();
};

/// What more of a parameter does to the cycles of a frame: `quadrille experiment parameters` holds each to
/// it.
enum class Effect : std::uint8_t {
  kFaster,    ///< more of it is never slower
  kSlower,    ///< more of it is never faster
  kTradeOff,  ///< either, by the frame
  kPicture,   ///< another picture, and thereby another frame
  kNeutral    ///< nothing: it bounds what frames do not reach
};
[[nodiscard]] std::string_view effect_name(Effect effect);

/// A parameter seen without its type: what the loader and the documentation need.
class ParamBase {
 public:
  ParamBase(std::string_view name, std::string_view unit, std::string_view reason, Effect effect)
      : name_(name), unit_(unit), reason_(reason), effect_(effect) {}
  virtual ~ParamBase() = default;
  ParamBase(const ParamBase&) = delete;
  ParamBase& operator=(const ParamBase&) = delete;

  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::string_view unit() const { return unit_; }
  [[nodiscard]] std::string_view reason() const { return reason_; }
  /// What more of a number does, or what `true` does.
  [[nodiscard]] Effect effect() const { return effect_; }
  [[nodiscard]] virtual std::string value_text() const = 0;
  [[nodiscard]] virtual std::string default_text() const = 0;
  [[nodiscard]] virtual std::string legal_text() const = 0;
  /// All legal values of a word or a switch; empty for a number.
  [[nodiscard]] virtual std::vector<std::string_view> words() const { return {}; }
  /// Is the value one of a list of words?
  [[nodiscard]] virtual bool is_word() const { return false; }
  /// What is to say of one of its words; empty for what the parameter's own reason covers.
  [[nodiscard]] virtual std::string_view reason_of(std::string_view /*word*/) const { return {}; }
  /// Value and default as TOML and JSON write them: words in quotes.
  [[nodiscard]] virtual std::string literal() const { return value_text(); }
  [[nodiscard]] virtual std::string default_literal() const { return default_text(); }
  /// Reads a value. Throws `UserError` (without file or key, which the caller adds) when it is not a legal
  /// value.
  virtual void parse(std::string_view text) = 0;

 private:
  std::string_view name_, unit_, reason_;
  Effect effect_;
};

/// The parameters of one unit. Not copyable: a unit keeps a reference to the group that the configuration
/// owns.
class ParamGroup {
 public:
  ParamGroup() = default;
  ParamGroup(const ParamGroup&) = delete;
  ParamGroup& operator=(const ParamGroup&) = delete;
  [[nodiscard]] const std::vector<ParamBase*>& params() const { return params_; }
  [[nodiscard]] ParamBase* find(std::string_view name) const;
  void add(ParamBase& p) { params_.push_back(&p); }

 private:
  std::vector<ParamBase*> params_;
};

template <class T>
class Param final : public ParamBase {
  static_assert(std::is_same_v<T, int> || std::is_same_v<T, std::int64_t> || std::is_same_v<T, double> ||
                std::is_same_v<T, bool>);

 public:
  Param(ParamGroup& group, std::string_view name, T value, std::string_view unit, ParamRange<T> range,
        std::string_view reason, Effect effect = Effect::kFaster)
      : ParamBase(name, unit, reason, effect), value_(value), default_(value), range_(range) {
    group.add(*this);
  }
  Param(ParamGroup& group, std::string_view name, T value, std::string_view unit, std::string_view reason,
        Effect effect = Effect::kFaster) requires std::is_same_v<T, bool>
      : ParamBase(name, unit, reason, effect), value_(value), default_(value) {
    group.add(*this);
  }
  operator T() const {  // NOLINT(google-explicit-constructor): a parameter reads as its value
    return value_;
  }
  [[nodiscard]] T value() const { return value_; }
  [[nodiscard]] const ParamRange<T>& range() const { return range_; }
  void set(T value);
  [[nodiscard]] std::string value_text() const override { return fmt::format("{}", value_); }
  [[nodiscard]] std::string default_text() const override { return fmt::format("{}", default_); }
  [[nodiscard]] std::string legal_text() const override;
  [[nodiscard]] std::vector<std::string_view> words() const override;
  void parse(std::string_view text) override;

 private:
  T value_, default_;
  ParamRange<T> range_;
};

/// A parameter that is one word of a fixed list: which kind. `E` is an enumeration whose values count
/// from 0 in the order of the words.
template <class E>
class Choice final : public ParamBase {
  static_assert(std::is_enum_v<E>);

 public:
  Choice(ParamGroup& group, std::string_view name, E value, std::initializer_list<std::string_view> words,
         std::string_view reason, Effect effect = Effect::kTradeOff)
      : ParamBase(name, "", reason, effect), value_(value), default_(value), words_(words) {
    group.add(*this);
  }
  operator E() const {  // NOLINT(google-explicit-constructor): a parameter reads as its value
    return value_;
  }
  [[nodiscard]] E value() const { return value_; }
  void set(E value) { value_ = value; }
  [[nodiscard]] std::string value_text() const override { return std::string(word(value_)); }
  [[nodiscard]] std::string default_text() const override { return std::string(word(default_)); }
  [[nodiscard]] std::string legal_text() const override { return fmt::format("{}", fmt::join(words_, ", ")); }
  [[nodiscard]] std::vector<std::string_view> words() const override { return words_; }
  [[nodiscard]] bool is_word() const override { return true; }
  [[nodiscard]] std::string literal() const override { return fmt::format("\"{}\"", value_text()); }
  [[nodiscard]] std::string default_literal() const override { return fmt::format("\"{}\"", default_text()); }
  void parse(std::string_view text) override {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (words_[i] != text) continue;
      value_ = static_cast<E>(i);
      return;
    }
    throw user_error("'{}' is not one of its words; legal: {}", text, legal_text());
  }

 private:
  [[nodiscard]] std::string_view word(E value) const { return words_[static_cast<std::size_t>(value)]; }
  E value_, default_;
  std::vector<std::string_view> words_;
};

/// A parameter that is the name of a policy (models/base/policy.h). Policies that are added to the list later
/// are legal values too.
template <class P>
class PolicyParam final : public ParamBase {
 public:
  PolicyParam(ParamGroup& group, std::string_view name, const PolicyList<P>& list, const P& value,
              std::string_view reason)
      : ParamBase(name, "", reason, Effect::kTradeOff), list_(list), value_(&value), default_(&value) {
    group.add(*this);
  }
  [[nodiscard]] const P& value() const { return *value_; }
  void set(const P& value) { value_ = &value; }
  [[nodiscard]] std::string value_text() const override { return std::string(value_->name); }
  [[nodiscard]] std::string default_text() const override { return std::string(default_->name); }
  [[nodiscard]] std::string legal_text() const override {
    return fmt::format("{}", fmt::join(words(), ", "));
  }
  [[nodiscard]] std::vector<std::string_view> words() const override {
    std::vector<std::string_view> names;
    for (const P* policy : list_.all()) names.push_back(policy->name);
    return names;
  }
  [[nodiscard]] std::string_view reason_of(std::string_view word) const override {
    const P* const policy = list_.find(word);
    return policy == nullptr ? std::string_view{} : policy->reason;
  }
  [[nodiscard]] bool is_word() const override { return true; }
  [[nodiscard]] std::string literal() const override { return fmt::format("\"{}\"", value_text()); }
  [[nodiscard]] std::string default_literal() const override { return fmt::format("\"{}\"", default_text()); }
  void parse(std::string_view text) override {
    const P* const policy = list_.find(text);
    if (policy == nullptr) throw user_error("'{}' is not one of its words; legal: {}", text, legal_text());
    value_ = policy;
  }

 private:
  const PolicyList<P>& list_;
  const P* value_;
  const P* default_;
};

extern template class Param<int>;
extern template class Param<std::int64_t>;
extern template class Param<double>;
extern template class Param<bool>;

}  // namespace quadrille::hw
