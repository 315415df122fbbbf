/// Storage instructions of a warp: who reads and writes, what they ask for, and the lines that these become.
#include "models/shader/storage_lines.h"
#include "tests/models/shader/warp_fixture.h"

#include <catch2/catch.hpp>

using namespace quadrille::models;
using namespace quadrille::models::test;

namespace {

struct StorageFixture : WarpFixture {
  StorageFixture() {
    view.address = memory.allocate(1024);
    view.bytes = 1024;
    view.buffer = storage_memory.watch("words", view.address, view.bytes);
    for (std::uint32_t i = 0; i < 256; ++i) memory.store(view.address + 4 * i, 1000 + i);
    storage.memory = &storage_memory;
    storage.buffers = &view;
    storage.live = ~0u;
    for (std::uint32_t i = 0; i < kWarpLanes; ++i)
      storage.invocations[i] = invocation_of_fragment(0, 0, 0, static_cast<std::uint16_t>(i), 0);
    warp.storage = &storage;
  }
  [[nodiscard]] std::uint32_t word(std::uint32_t i) const {
    return memory.load<std::uint32_t>(view.address + 4 * i);
  }
  DeviceMemory memory;
  StorageMemory storage_memory{memory};
  StorageView view;
  WarpStorage storage;
};

/// `r0` holds the lane's primitive (lane / 4), `r1` four times that.
Program program(const std::string& body, const std::string& flags = {}) {
  return assemble(".stage fragment\n" + flags +
                      ".buffer set=0 binding=0\n input r0, primitive_id\n shl r1, r0, 2\n" + body + " end\n",
                  "test");
}

std::vector<StorageLine> lines_of(const StorageRequest& request, const StorageView& view) {
  std::vector<StorageLine> lines;
  add_lines(request, view, lines);
  return lines;
}

StorageRequest request_of(Op op, std::uint32_t stride, std::uint32_t first = 0, LaneMask active = ~0u) {
  StorageRequest request;
  request.op = op;
  request.active = active;
  for (std::uint32_t i = 0; i < kWarpLanes; ++i) request.offset[i] = first + stride * i;
  return request;
}

}  // namespace

TEST_CASE("storage instructions: a warp waits for what it loads, and each lane has its word") {
  StorageFixture f;
  const Program p = program(" ldbuf r2, b0, r1\n iadd r2, r2, 1\n output out0, r2\n");
  f.run(p);
  CHECK(f.clauses == 2);
  for (std::size_t i = 0; i < kWarpLanes; ++i) CHECK(f.outputs[0][i] == 1001 + i / 4);
}

TEST_CASE("storage instructions: helpers and discarded lanes load but do not write") {
  StorageFixture f;
  f.storage.live = 0x0000ffffu;
  f.run(
      program(" ieq r3, r0, 1\n killif r3\n ldbuf r2, b0, r1\n iadd r4, r1, 512\n stbuf b0, r4, r2\n"
              " atomadd r5, b0, 1020, 1\n",
              ".flags discard\n"));
  // Quads 4 to 7 are helpers, quad 1 was discarded.
  CHECK(f.word(128) == 1000);
  CHECK(f.word(129) == 1129);
  CHECK(f.word(130) == 1002);
  CHECK(f.word(131) == 1003);
  CHECK(f.word(132) == 1132);
  CHECK(f.word(255) == 1255 + 12);
}

TEST_CASE("storage instructions: a listing with buffers is read back") {
  const Program p =
      program(" bufsize r2, b0\n atomcas r3, b0, r1, r2, 5\n stbuf b0, 8, r3\n", ".flags atomic-outputs\n");
  CHECK(assemble(disassemble(p), "test") == p);
  CHECK(writes_buffers(p));
  CHECK_FALSE(writes_buffers(program(" ldbuf r2, b0, r1\n")));
}

TEST_CASE("storage instructions: a buffer that the program does not declare is refused") {
  CHECK_THROWS_WITH(assemble(".stage vertex\n ldbuf r0, b1, 0\n end\n", "test"),
                    Catch::Contains("buffer 1 does not exist; the program has 0"));
}

TEST_CASE("storage instructions: the size of a buffer is that of its view") {
  StorageFixture f;
  f.run(program(" bufsize r2, b0\n output out0, r2\n"));
  CHECK(f.outputs[0][31] == 1024);
}

TEST_CASE("storage lines: neighbouring words share a line, strides of a line do not") {
  const StorageView view{1 << 20, 1 << 16, 0};
  const std::vector<StorageLine> dense = lines_of(request_of(Op::kLoadBuffer, 4), view);
  REQUIRE(dense.size() == 1);
  CHECK((dense[0].sectors == 0xf && dense[0].whole == 0xf));
  CHECK(lines_of(request_of(Op::kLoadBuffer, 128), view).size() == 32);
  CHECK(lines_of(request_of(Op::kLoadBuffer, 0), view).size() == 1);
  const std::vector<StorageLine> shifted = lines_of(request_of(Op::kStoreBuffer, 4, 16), view);
  REQUIRE(shifted.size() == 2);
  CHECK((shifted[0].sectors == 0xf && shifted[0].whole == 0xe));
  CHECK((shifted[1].sectors == 0x1 && shifted[1].whole == 0x0));
}

TEST_CASE("storage lines: updates of one word follow each other, those of different words go together") {
  const StorageView view{1 << 20, 1 << 16, 0};
  CHECK(lines_of(request_of(Op::kAtomicAdd, 0), view).size() == 32);
  CHECK(lines_of(request_of(Op::kAtomicAdd, 4), view).size() == 1);
  CHECK(lines_of(request_of(Op::kAtomicAdd, 0, 0, 0xf0), view).size() == 4);
}

TEST_CASE("storage lines: what lies outside of the view moves nothing") {
  const StorageView view{1 << 20, 64, 0};
  const std::vector<StorageLine> lines = lines_of(request_of(Op::kLoadBuffer, 4), view);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].sectors == 0x3);
}
