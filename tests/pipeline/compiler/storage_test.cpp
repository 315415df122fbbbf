/// Storage buffers through the compiler: layouts, atomic operations, lengths, what may not be moved, and
/// programs whose outputs follow atomic operations.
#include "models/base/error.h"
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

using namespace quadrille;
using namespace quadrille::pipeline;
using models::Op;

namespace {

/// Every varying is read, so that `run_fragment` knows which is which.
const std::string kReadsAll = "if (i.w == -123456789) { color = a + b + vec4(i); return; }\n";

/// Runs a fragment shader on eight points with one buffer of words at set 0, binding 0.
struct BufferRun {
  BufferRun(const std::string& declarations, const std::string& body, std::vector<std::uint32_t> words = {})
      : program(compile_fragment(fragment_source(kReadsAll + body, declarations))) {
    words.resize(64);
    view.address = memory.allocate(256);
    view.bytes = 256;
    view.buffer = storage_memory.watch("words", view.address, 256);
    std::memcpy(memory.write(view.address, 256).data(), words.data(), 256);
  }
  RunOutput run(const RunInput& input = {}) {
    models::WarpStorage storage;
    storage.memory = &storage_memory;
    storage.buffers = &view;
    storage.live = 0x11111111u;
    for (std::size_t i = 0; i < models::kWarpLanes; ++i)
      storage.invocations[i] = models::invocation_of_fragment(0, 0, static_cast<std::uint32_t>(i / 4),
                                                              static_cast<std::uint16_t>(i % 4), 0);
    return run_fragment(program, input, &storage);
  }
  [[nodiscard]] std::uint32_t word(std::uint32_t i) const {
    return memory.load<std::uint32_t>(view.address + 4 * i);
  }
  [[nodiscard]] float number(std::uint32_t i) const { return memory.load<float>(view.address + 4 * i); }
  models::Program program;
  models::DeviceMemory memory;
  models::StorageMemory storage_memory{memory};
  models::StorageView view;
};

RunInput numbered() {
  RunInput input;
  for (std::size_t k = 0; k < input.points.size(); ++k) {
    input.points[k].i = {static_cast<std::int32_t>(k), 2, 3, 4};
    input.points[k].a = {static_cast<float>(k), 0.5f, 0.25f, 1};
  }
  return input;
}

bool follows(const std::string& body) {
  return compile_fragment(
             fragment_source(body, "layout(std430, set = 0, binding = 0) buffer B { uint n; uint w[]; };"))
      .outputs_follow_atomics;
}

std::vector<Op> accesses(const models::Program& program) {
  std::vector<Op> ops;
  for (const models::Instruction& i : program.code)
    if (models::issue_class(i.op) == models::IssueClass::kStorage) ops.push_back(i.op);
  return ops;
}

}  // namespace

TEST_CASE("storage compile: members, vectors, matrices and arrays lie where std430 says") {
  BufferRun r(R"(struct Part { vec3 v; float f; mat2 m; };
layout(std430, set = 0, binding = 0) buffer B { uint head; Part parts[]; } s;)",
              "if (i.x == 3) { s.head = 7u; s.parts[1].v = vec3(1, 2, 3); s.parts[1].f = 4.0; "
              "s.parts[1].m = mat2(5, 6, 7, 8); } color = a;");
  (void)r.run(numbered());
  CHECK(r.word(0) == 7);
  for (std::uint32_t k = 0; k < 8; ++k) CHECK(r.number(4 + 8 + k) == static_cast<float>(k + 1));
}

TEST_CASE("storage compile: loads by a computed index read that element") {
  std::vector<std::uint32_t> words;
  for (std::uint32_t i = 0; i < 64; ++i) words.push_back(10 * i);
  BufferRun r("layout(std430, set = 0, binding = 0) readonly buffer B { uvec2 pairs[]; };",
              "color = vec4(vec2(pairs[i.x + 1]), pairs.length(), 0);", words);
  const RunOutput out = r.run(numbered());
  for (int k = 0; k < 8; ++k) {
    const auto first = static_cast<float>(10 * (2 * k + 2));
    CHECK(out.point(k) == Vec4{first, first + 10, 32, 0});
  }
  CHECK_FALSE(models::writes_buffers(r.program));
}

TEST_CASE("storage compile: a row-major matrix is written as it is read") {
  BufferRun r("layout(std430, set = 0, binding = 0) buffer B { layout(row_major) mat3x2 m; vec2 read; };",
              "if (i.x == 1) { mat3x2 n = mat3x2(1, 2, 3, 4, 5, 6); m = n; read = n * vec3(1, 10, 100); } "
              "color = a;");
  (void)r.run(numbered());
  CHECK(r.number(0) == 1);
  CHECK(r.number(1) == 3);
  CHECK(r.number(2) == 5);
  CHECK(r.number(4) == 2);
  CHECK(r.number(8) == 531);
  CHECK(r.number(9) == 642);
}

TEST_CASE("storage compile: every atomic operation of GLSL updates its word") {
  BufferRun r("layout(std430, set = 0, binding = 0) buffer B { uint u[16]; int s[16]; };", R"(
uint k = uint(i.x);
atomicAdd(u[0], k); atomicMin(u[1], 5u - min(k, 3u)); atomicMax(u[2], k); atomicAnd(u[3], ~(1u << k));
atomicOr(u[4], 1u << k); atomicXor(u[5], 1u << k); atomicExchange(u[6], 9u); atomicCompSwap(u[7], 3u, 4u);
atomicMin(s[0], 2 - int(k)); atomicMax(s[1], -int(k) - 1); atomicAdd(s[2], -1);
color = a;)",
              {0, 100, 0, ~0u, 0, 1, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, ~0u << 8});
  (void)r.run(numbered());
  CHECK(r.word(0) == 28);
  CHECK(r.word(1) == 2);
  CHECK(r.word(2) == 7);
  CHECK(r.word(3) == 0xffffff00u);
  CHECK(r.word(4) == 0xff);
  CHECK(r.word(5) == 0xfe);
  CHECK(r.word(6) == 9);
  CHECK(r.word(7) == 4);
  CHECK(r.word(16) == static_cast<std::uint32_t>(-5));
  CHECK(r.word(17) == static_cast<std::uint32_t>(-1));
  CHECK(r.word(18) == static_cast<std::uint32_t>(-8));
}

TEST_CASE("storage compile: accesses that may meet keep their order") {
  const models::Program p = compile_fragment(
      fragment_source("w[1] = 5u; uint x = w[i.x]; w[2] = x; uint y = w[i.x]; color = vec4(x, y, 0, 0);",
                      "layout(std430, set = 0, binding = 0) buffer B { uint w[]; };"));
  CHECK(accesses(p) == std::vector{Op::kStoreBuffer, Op::kLoadBuffer, Op::kStoreBuffer, Op::kLoadBuffer});
}

TEST_CASE("storage compile: a store in a branch is done by the lanes that take it") {
  BufferRun r("layout(std430, set = 0, binding = 0) buffer B { uint w[]; };",
              "if ((i.x & 1) == 0) w[i.x] = 1u; else atomicAdd(w[20], 1u); color = a;");
  (void)r.run(numbered());
  for (std::uint32_t k = 0; k < 8; ++k) CHECK(r.word(k) == 1 - k % 2);
  CHECK(r.word(20) == 4);
}

TEST_CASE("storage compile: outputs that follow atomic operations are found") {
  CHECK(follows("color = vec4(atomicAdd(n, 1u));"));
  CHECK(follows("if (atomicAdd(n, 1u) > 3u) discard; color = a;"));
  CHECK(follows("color = a; if (atomicAdd(n, 1u) > 3u) color = b;"));
  CHECK(follows("uint k = atomicAdd(n, 1u); w[k] = 1u; color = vec4(w[2]);"));
  CHECK(follows(
      "color = a; for (int k = 0; k < 100; ++k) { if (atomicOr(n, 0u) != 0u) break; color += b * w[k]; }"));
  CHECK_FALSE(follows("atomicAdd(n, 1u); color = a;"));
  CHECK_FALSE(follows("uint k = atomicAdd(n, 1u); w[k] = 1u; color = a;"));
  CHECK_FALSE(follows("color = vec4(w[i.x]);"));
}

TEST_CASE("storage compile: what is not supported is refused by name") {
  const auto refusal = [](const std::string& declarations, const std::string& body) -> std::string {
    try {
      (void)compile_fragment(fragment_source(body, declarations));
      return "";
    } catch (const UserError& error) { return error.what(); }
  };
  CHECK_THAT(refusal("layout(std430, set = 0, binding = 0) buffer B { uint w[]; } two[2];",
                     "two[i.x].w[0] = 1u; color = a;"),
             Catch::Contains("array of buffers"));
}
