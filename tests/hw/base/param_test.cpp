/// Parameters: what they read, what they refuse and with which words, and what they say of themselves.
#include "hw/base/param.h"

#include <catch2/catch.hpp>

#include <functional>
#include <limits>

using namespace quadrille;
using namespace quadrille::hw;

namespace {

enum class Colour : std::uint8_t { kRed, kGreen };

struct Thing {
  virtual ~Thing() = default;
};
using ThingPolicy = Policy<Thing>;
constexpr ThingPolicy kFirst{"first", "it came first", nullptr}, kSecond{"second", "it came second", nullptr},
    kThird{"third", "it was added later", nullptr};

PolicyList<ThingPolicy>& things() {
  static PolicyList<ThingPolicy> all{&kFirst, &kSecond};
  return all;
}

struct Group : ParamGroup {
  Param<int> lines{*this, "lines", 8, "line", {1, 64}, "How many."};
  Param<std::int64_t> bytes{*this,      "bytes",         1, "byte", {0, std::int64_t{1} << 40},
                            "How big.", Effect::kNeutral};
  Param<double> clock{*this, "clock", 2.5, "MHz", {0.5, 10}, "How fast.", Effect::kTradeOff};
  Param<bool> hash{*this, "hash", true, "", "Whether.", Effect::kPicture};
  Choice<Colour> colour{*this, "colour", Colour::kGreen, {"red", "green"}, "Which."};
  PolicyParam<ThingPolicy> thing{*this, "thing", things(), kSecond, "In which way."};
};

std::string refusal(ParamBase& param, std::string_view text) {
  try {
    param.parse(text);
  } catch (const UserError& error) { return error.what(); }
  return "none";
}

}  // namespace

TEST_CASE("param: a group lists its parameters in the order of declaration and finds them by name") {
  Group group;
  std::string names;
  for (const ParamBase* p : group.params()) names += std::string(p->name()) + " ";
  CHECK(names == "lines bytes clock hash colour thing ");
  CHECK(group.find("clock") == &group.clock);
  CHECK(group.find("cloc") == nullptr);
}

TEST_CASE("param: a value that is read is the value, and the default stays") {
  Group group;
  group.find("lines")->parse("64");
  group.find("bytes")->parse("1099511627776");
  group.find("clock")->parse("0.5");
  group.find("hash")->parse("false");
  group.find("colour")->parse("red");
  group.find("thing")->parse("first");
  CHECK(group.lines == 64);
  CHECK(group.bytes == std::int64_t{1} << 40);
  CHECK(group.clock == 0.5);
  CHECK_FALSE(group.hash);
  CHECK(group.colour == Colour::kRed);
  CHECK(&group.thing.value() == &kFirst);
  std::string values, defaults;
  for (const ParamBase* p : group.params()) {
    values += p->literal() + " ";
    defaults += p->default_literal() + " ";
  }
  CHECK(values == "64 1099511627776 0.5 false \"red\" \"first\" ");
  CHECK(defaults == "8 1 2.5 true \"green\" \"second\" ");
}

TEST_CASE("param: what a parameter writes it reads back") {
  Group group, copy;
  group.lines.set(17);
  group.clock.set(10.0 / 3);
  group.colour.set(Colour::kRed);
  group.thing.set(kFirst);
  for (std::size_t i = 0; i < group.params().size(); ++i)
    copy.params()[i]->parse(group.params()[i]->value_text());
  CHECK(copy.lines == 17);
  CHECK(copy.clock == 10.0 / 3);
  CHECK(copy.colour == Colour::kRed);
  CHECK(&copy.thing.value() == &kFirst);
}

TEST_CASE("param: the ends of a range are legal and what lies beyond them is refused") {
  Group group;
  CHECK(refusal(group.lines, "1") == "none");
  CHECK(refusal(group.lines, "64") == "none");
  CHECK(refusal(group.lines, "0") == "0 is out of range; legal: 1 to 64");
  CHECK(refusal(group.lines, "65") == "65 is out of range; legal: 1 to 64");
  CHECK(refusal(group.clock, "10.5") == "10.5 is out of range; legal: 0.5 to 10");
  CHECK(refusal(group.clock, "nan").find("out of range") != std::string::npos);
  CHECK(group.lines == 64);
}

TEST_CASE("param: text that is no value of the type is refused, and changes nothing") {
  Group group;
  for (const char* text : {"", " 3", "3 ", "0x10", "3.0", "many", "99999999999999999999"}) {
    INFO("'" << text << "'");
    CHECK(refusal(group.lines, text).find("is not a whole number; legal: 1 to 64") != std::string::npos);
  }
  CHECK(refusal(group.clock, "fast") == "'fast' is not a number; legal: 0.5 to 10");
  CHECK(refusal(group.hash, "1") == "'1' is not true or false");
  CHECK(refusal(group.colour, "Red") == "'Red' is not one of its words; legal: red, green");
  CHECK(group.lines == 8);
  CHECK(group.clock == 2.5);
  CHECK(group.hash);
  CHECK(group.colour == Colour::kGreen);
}

TEST_CASE("param: words are listed for switches, choices and policies, and not for numbers") {
  Group group;
  CHECK(group.lines.words().empty());
  CHECK(group.hash.words() == std::vector<std::string_view>{"false", "true"});
  CHECK(group.colour.words() == std::vector<std::string_view>{"red", "green"});
  CHECK(group.thing.words() == std::vector<std::string_view>{"first", "second"});
  CHECK_FALSE(group.hash.is_word());
  CHECK(group.colour.is_word());
  CHECK(group.thing.is_word());
}

TEST_CASE("param: a policy that is added to its list is a legal value, with a reason of its own") {
  Group group;
  CHECK(refusal(group.thing, "third") == "'third' is not one of its words; legal: first, second");
  things().add(kThird);
  CHECK(refusal(group.thing, "third") == "none");
  CHECK(&group.thing.value() == &kThird);
  CHECK(group.thing.legal_text() == "first, second, third");
  CHECK(group.thing.reason_of("third") == "it was added later");
  CHECK(group.thing.reason_of("fourth").empty());
  CHECK(group.thing.default_text() == "second");
}

TEST_CASE("param: each effect has a name of its own") {
  std::vector<std::string_view> names;
  for (const Effect effect :
       {Effect::kFaster, Effect::kSlower, Effect::kTradeOff, Effect::kPicture, Effect::kNeutral})
    names.push_back(effect_name(effect));
  CHECK(names == std::vector<std::string_view>{"faster", "slower", "trade-off", "picture", "neutral"});
}
