/// The laws are worth something only if they break: each case loses something on a wire on purpose and finds
/// the law that notices.
#include "tests/pipeline/broken_laws.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace quadrille;
using namespace quadrille::pipeline;

using test::broken_laws;
using test::link;

TEST_CASE("conservation: an intact machine breaks no law") {
  CHECK(broken_laws([](const Machine&) {}).empty());
}

TEST_CASE("conservation: a lost fragment is noticed") {
  const std::string broken = broken_laws([](const Machine& machine) {
    link<hw::CoverageToken>(machine, "fine_to_depth_0").inject_fault([n = 0](hw::CoverageToken& t) mutable {
      if (t.kind == hw::TokenKind::kWork && ++n == 5) t.coverage &= t.coverage - 1;
    });
  });
  CHECK(broken.find("fragments covered = fragments to test") != std::string::npos);
  CHECK(broken.find("fragments covered = tested early + deferred + untested") != std::string::npos);
}

TEST_CASE("conservation: fragments that miss their late test are noticed") {
  const std::string broken = broken_laws([](const Machine& machine) {
    link<hw::CoverageToken>(machine, "depth_to_packer_0").inject_fault([](hw::CoverageToken& t) {
      t.late = false;
    });
  });
  CHECK(broken.find("fragments deferred = tested late + discarded before that") != std::string::npos);
}

TEST_CASE("conservation: a fragment lost between test and packing is noticed") {
  const std::string broken = broken_laws([](const Machine& machine) {
    link<hw::CoverageToken>(machine, "depth_to_packer_1").inject_fault([n = 0](hw::CoverageToken& t) mutable {
      if (t.kind == hw::TokenKind::kWork && !t.late && ++n == 3) t.coverage &= t.coverage - 1;
    });
  });
  CHECK(broken.find("fragments passed = samples packed") != std::string::npos);
}

TEST_CASE("conservation: a lost triangle is noticed") {
  const std::string broken = broken_laws([](const Machine& machine) {
    link<hw::PrimitiveToken>(machine, "assembly_to_clipper")
        .inject_fault([n = 0](hw::PrimitiveToken& t) mutable {
          if (t.kind == hw::TokenKind::kWork && ++n == 4) t.kind = hw::TokenKind::kSync;
        });
  });
  CHECK(broken.find("triangles assembled = triangles to clip") != std::string::npos);
}

TEST_CASE("conservation: a lost tile is noticed") {
  const std::string broken = broken_laws([](const Machine& machine) {
    link<hw::TileToken>(machine, "coarse_to_fine").inject_fault([n = 0](hw::TileToken& t) mutable {
      if (t.kind == hw::TokenKind::kWork && ++n == 4) t = {hw::TokenKind::kSync, false, 0, 0, t.part, 0};
    });
  });
  CHECK(broken.find("tiles kept = tiles rasterised") != std::string::npos);
}

TEST_CASE("conservation: lost bytes are noticed, read and written") {
  const auto shorten = [](const char* name, hw::MemoryRequest::Kind kind) {
    return broken_laws([name, kind](const Machine& machine) {
      link<hw::MemoryRequest>(machine, name).inject_fault([kind, n = 0](hw::MemoryRequest& r) mutable {
        if (r.kind == kind && ++n == 1) r.sectors = static_cast<std::uint8_t>(r.sectors & (r.sectors - 1));
      });
    });
  };
  CHECK_THAT(shorten("scan_out_to_l2_0", hw::MemoryRequest::Kind::kRead),
             Catch::Contains("bytes asked by clients = bytes answered by L2"));
  CHECK_THAT(
      shorten("rop_0_to_l2_0", hw::MemoryRequest::Kind::kWrite),
      Catch::Contains("bytes written by clients = bytes taken by L2") &&
          Catch::Contains("bytes of depths and colours as they are stored = bytes of them taken by L2"));
  // A first-level cache waits for the sector that nobody brings.
  CHECK_THAT(shorten("vertex_fetch_to_l2_0", hw::MemoryRequest::Kind::kRead),
             Catch::Contains("the machine cannot progress"));
}
