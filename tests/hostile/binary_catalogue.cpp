/// Binary glTF with headers and chunks that do not add up, and traces that are damaged or lie.
#include <cstring>

#include <fmt/format.h>

#include "scenes/scene.h"
#include "tests/fuzz/trace_chunks.h"
#include "tests/hostile/hostile_case.h"
#include "tests/scenes/gltf_text.h"
#include "traces/trace_file.h"

namespace quadrille::hostile {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBin = 0x004e4942;

std::string raw(const Words& words) {
  return {reinterpret_cast<const char*>(words.data()), words.size() * 4};
}

std::string padded_json() {
  std::string text = scenes::triangle_gltf();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

/// A binary file of the triangle with these header words.
std::string binary(std::uint32_t version, std::uint32_t total, std::uint32_t json_length, std::uint32_t type,
                   const std::string& behind = "") {
  return raw({kMagic, version, total, json_length, type}) + padded_json() + behind;
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Case trace_case(const std::string& what, const std::string& bytes, Expect expect = Expect::kRefused,
                const std::string& fidelity = "exact") {
  return {what,
          {"render", "t.qtrace", "--fidelity", fidelity, "--out", "x.png", "--stats", "x.json", "-q"},
          "t.qtrace",
          [=](const fs::path& folder) { write_file(folder / "t.qtrace", bytes); },
          expect};
}

std::vector<std::byte> triangle_trace() {
  scenes::SceneOptions options;
  options.width = options.height = 16;
  return traces::encode_trace(scenes::load_scene("builtin:triangle", options));
}

}  // namespace

Group binary_scene_cases() {
  Group group{"GLB", "headers and chunks that do not add up", {}};
  const auto json = static_cast<std::uint32_t>(padded_json().size()), total = 20 + json;
  const auto add = [&](const std::string& what, const std::string& bytes, Expect expect = Expect::kRefused) {
    group.cases.push_back(scene_case(what, bytes, "t.glb", expect));
  };
  add("the triangle itself", binary(2, total, json, kJson), Expect::kRendered);
  add("text under the name of a binary file", scenes::triangle_gltf());
  add("empty", "");
  for (const std::uint32_t version : {0U, 1U, 3U, 0xffffffffU})
    add(fmt::format("version {}", version), binary(version, total, json, kJson), Expect::kEither);
  for (const std::uint32_t length : {0U, 12U, 20U, total - 4, total + 4, 0x7fffffffU, 0xffffffffU})
    add(fmt::format("length {}", length), binary(2, length, json, kJson), Expect::kEither);
  for (const std::uint32_t length :
       {0U, 1U, 4U, json - 1, json + 1, json + 8, 0x7fffffffU, 0x80000000U, 0xfffffffcU, 0xffffffffU})
    add(fmt::format("JSON length {}", length), binary(2, total, length, kJson), Expect::kEither);
  for (const std::uint32_t type : {0U, kBin, 0xffffffffU})
    add(fmt::format("JSON chunk of type {:#x}", type), binary(2, total, json, type));
  for (const std::uint32_t length : {0U, 4U, 8U, 0x7fffffffU, 0xffffffffU})
    add(fmt::format("BIN length {}", length), binary(2, total + 12, json, kJson, raw({length, kBin, 0})),
        Expect::kEither);
  add("two BIN chunks", binary(2, total + 24, json, kJson, raw({4, kBin, 0, 4, kBin, 0})), Expect::kEither);
  add("an unknown chunk", binary(2, total + 12, json, kJson, raw({4, 0x12345678, 0})), Expect::kEither);
  const std::string good = binary(2, total + 12, json, kJson, raw({4, kBin, 0}));
  for (std::size_t size = 1; size < good.size(); size += size < 24 ? 1 : 41)
    add(fmt::format("cut at byte {}", size), good.substr(0, size));
  for (std::size_t i = 0; i < 24; ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(~bad[i]);
    add(fmt::format("byte {} inverted", i), bad, Expect::kEither);
  }
  return group;
}

Group trace_cases() {
  Group group{
      "traces", "cut, changed, and with checksums that hold around counts and numbers that do not", {}};
  const auto file = triangle_trace();
  const std::string good = text_of(file);
  group.cases.push_back(trace_case("the triangle itself", good, Expect::kRendered));
  for (std::size_t size = 0; size < good.size(); size += size < 64 ? 7 : 61)
    group.cases.push_back(trace_case(fmt::format("cut at byte {}", size), good.substr(0, size)));
  for (std::size_t i = 0; i < good.size(); i += i < 64 ? 5 : 53) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    group.cases.push_back(trace_case(fmt::format("byte {} changed", i), bad));
  }
  group.cases.push_back(trace_case("bytes behind it", good + "more"));
  const auto chunks = *fuzz::take_trace_apart(file);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const std::string name(chunks[c].tag.data(), 4);
    for (const std::uint32_t value : {0U, 0x00ffffffU, 0x7fffffffU, 0xffffffffU}) {
      for (std::size_t at = 0; at + 4 <= chunks[c].payload.size(); at += at < 16 ? 4 : 36) {
        auto bad = chunks;
        std::memcpy(bad[c].payload.data() + at, &value, 4);
        group.cases.push_back(trace_case(fmt::format("{} word {} is {:#x}", name, at / 4, value),
                                         text_of(fuzz::put_trace_together(bad)), Expect::kEither,
                                         "functional"));
        if (at > 300) break;
      }
    }
    auto fewer = chunks;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(c));
    group.cases.push_back(trace_case("without " + name, text_of(fuzz::put_trace_together(fewer))));
    auto empty = chunks;
    empty[c].payload.clear();
    group.cases.push_back(trace_case(name + " without content", text_of(fuzz::put_trace_together(empty))));
  }
  group.cases.push_back({"info on a damaged trace",
                         {"trace", "info", "t.qtrace"},
                         "t.qtrace",
                         [=](const fs::path& f) { write_file(f / "t.qtrace", good.substr(0, 99)); },
                         Expect::kRefused});
  group.cases.push_back({"a folder",
                         {"trace", "info", "t.qtrace"},
                         "t.qtrace",
                         [](const fs::path& f) { fs::create_directory(f / "t.qtrace"); },
                         Expect::kRefused});
  group.cases.push_back(
      {"three sparse gigabytes",
       {"trace", "info", "t.qtrace"},
       "t.qtrace",
       [](const fs::path& f) { write_file(f / "t.qtrace", ""), fs::resize_file(f / "t.qtrace", 3ULL << 30); },
       Expect::kRefused});
  group.cases.push_back(
      {"a sparse gigabyte",
       {"trace", "info", "t.qtrace"},
       "t.qtrace",
       [](const fs::path& f) { write_file(f / "t.qtrace", ""), fs::resize_file(f / "t.qtrace", 1ULL << 30); },
       Expect::kRefused});
  return group;
}

}  // namespace quadrille::hostile
