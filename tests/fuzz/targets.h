/// What is fuzzed: each target takes any bytes the way a user's file takes, and either does its work or is
/// refused in one line.
///
/// The same functions serve two programs: libFuzzer's (one a target, the `asan` preset, scripts/fuzz) and the
/// replay of the committed corpus, which needs no Clang and runs with every other test
/// (tests/fuzz/corpus_test.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::fuzz {

using Bytes = std::span<const std::byte>;
using Buffer = std::vector<std::byte>;

/// libFuzzer's own mutation of a buffer: `size` bytes in use, room for `room`; returns the new size.
using RawMutation = std::function<std::size_t(std::byte* data, std::size_t size, std::size_t room)>;

/// A glTF file, .gltf or .glb: loaded, recorded and, now and then, drawn with the material's shaders at 8x8
/// pixels.
void run_scene(Bytes bytes);
/// A .qtrace file: decoded, validated and, where it is small, compiled and drawn.
void run_trace(Bytes bytes);
/// A machine file, and each of its lines that holds '=' as an argument of --set.
void run_machine(Bytes bytes);
/// A SPIR-V module: compiled as either stage, and decoded by the reference's interpreter.
void run_spirv(Bytes bytes);
/// A .gfxr file: its frame recorded, what is not supported left out, and drawn where it is small.
void run_capture(Bytes bytes);
/// An image file: decoded to bytes and to floats.
void run_image(Bytes bytes);

// Mutations that know the format, so that changes reach what lies behind the parser. Each falls back to `raw`
// for what it cannot take apart.
[[nodiscard]] Buffer mutate_scene(Bytes bytes, const RawMutation& raw, unsigned seed);
[[nodiscard]] Buffer mutate_trace(Bytes bytes, const RawMutation& raw, unsigned seed);
[[nodiscard]] Buffer mutate_spirv(Bytes bytes, const RawMutation& raw, unsigned seed);
[[nodiscard]] Buffer mutate_raw(Bytes bytes, const RawMutation& raw, unsigned seed);

struct Target {
  std::string_view name;
  void (*run)(Bytes);
  Buffer (*mutate)(Bytes, const RawMutation&, unsigned seed);
};
/// Every target; its corpus is tests/fuzz/corpus/<name>.
[[nodiscard]] std::span<const Target> targets();
/// The target of that name. Throws `UserError` with the names there are.
[[nodiscard]] const Target& target(std::string_view name);

}  // namespace quadrille::fuzz
