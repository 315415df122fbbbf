/// Ways to damage a valid stream, each with the refusal that it must meet.
#pragma once

#include <catch2/catch.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "models/base/error.h"
#include "tests/traces/sample_stream.h"

namespace quadrille::traces {

struct Defect {
  const char* message;  ///< a part of it
  std::function<void(CommandStream&)> make;
};

template <class T>
T& command(CommandStream& s, std::size_t at) {
  return std::get<T>(s.commands[at]);
}

inline std::string refusal(const CommandStream& stream) {
  try {
    validate(stream);
  } catch (const UserError& error) { return error.what(); }
  return "accepted";
}

inline void expect(const std::vector<Defect>& defects) {
  for (const Defect& defect : defects) {
    CommandStream stream = small_stream();
    defect.make(stream);
    CAPTURE(defect.message);
    REQUIRE_THAT(refusal(stream), Catch::Contains(defect.message));
  }
}

}  // namespace quadrille::traces
