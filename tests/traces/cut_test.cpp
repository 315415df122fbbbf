#include "traces/cut.h"

#include <catch2/catch.hpp>

#include "models/base/error.h"
#include "tests/traces/sample_stream.h"
#include "traces/trace_file.h"

using namespace quadrille;
using namespace quadrille::traces;

TEST_CASE("cut: a range of draws stays, with all that is bound") {
  const CommandStream whole = small_stream();
  CommandStream part = whole;
  keep_draws(part, 0, 1);
  CHECK(part == whole);
  keep_draws(part, 1, 1);
  CHECK(stream_totals(part).draws == 1);
  CHECK(part.commands.size() == whole.commands.size() - 1);
  CHECK_NOTHROW(validate(part));
  CHECK_THROWS_WITH(keep_draws(part, 0, 1), "draws 0..1 of a frame of 1; legal are 0..0 to 0..0");
  CHECK_THROWS_AS(keep_draws(part, 1, 0), UserError);
}

TEST_CASE("cut: a frame ends behind a pass") {
  const CommandStream whole = small_stream();
  CommandStream part = whole;
  part.commands.insert(part.commands.end(), whole.commands.begin(), whole.commands.end());
  REQUIRE(stream_totals(part).passes == 2);
  CommandStream both = part;
  end_with_pass(both, 2);
  CHECK(both == part);
  end_with_pass(part, 1);
  CHECK(stream_totals(part).passes == 1);
  CHECK(std::holds_alternative<EndPass>(part.commands.back()));
  CHECK_THROWS_WITH(end_with_pass(part, 2), "pass 2 of a frame of 1; legal are 1 to 1");
  CHECK_THROWS_AS(end_with_pass(part, 0), UserError);
}
