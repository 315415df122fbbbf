/// Captures of gfxreconstruct that are cut, changed, or whose blocks claim what is not there.
#include <fmt/format.h>

#include <cstring>

#include "tests/hostile/hostile_case.h"
#include "tests/traces/capture/small_capture.h"
#include "traces/whole_file.h"

namespace quadrille::hostile {
namespace {

using capture::Packing;
using capture::small_capture;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Case capture_case(const std::string& what, const std::string& bytes, Expect expect = Expect::kEither) {
  return {what,
          {"render", "t.gfxr", "--skip-unsupported", "--fidelity", "functional", "--out", "x.png", "-q"},
          "t.gfxr",
          [=](const fs::path& folder) { write_file(folder / "t.gfxr", bytes); },
          expect};
}

template <class T>
std::string with(std::string bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
  return bytes;
}

/// Where each block begins: behind the header and its options.
std::vector<std::size_t> blocks_of(const std::string& file) {
  std::uint32_t options = 0;
  std::memcpy(&options, file.data() + 12, sizeof(options));
  std::vector<std::size_t> places;
  for (std::size_t at = 16 + 8 * std::size_t{options}; at + 12 <= file.size();) {
    places.push_back(at);
    std::uint64_t size = 0;
    std::memcpy(&size, file.data() + at, sizeof(size));
    at += 12 + size;
  }
  return places;
}

void add_changed(Group& group, const std::string& name, const std::string& good, std::size_t step) {
  group.cases.push_back(capture_case(name + " itself", good, Expect::kRendered));
  for (std::size_t size = 0; size < good.size(); size += size < 64 ? 9 : step)
    group.cases.push_back(
        capture_case(fmt::format("{} cut at byte {}", name, size), good.substr(0, size), Expect::kRefused));
  for (std::size_t i = 0; i < good.size(); i += i < 64 ? 5 : step)
    group.cases.push_back(capture_case(fmt::format("{}, byte {} changed", name, i),
                                       with(good, i, static_cast<char>(good[i] ^ 0x55))));
}

void add_blocks(Group& group, const std::string& good) {
  const std::vector<std::size_t> blocks = blocks_of(good);
  for (std::size_t b = 0; b < blocks.size(); b += 1 + blocks.size() / 24) {
    for (const std::uint64_t size :
         {std::uint64_t{0}, std::uint64_t{5}, std::uint64_t{1} << 40, ~std::uint64_t{0}})
      group.cases.push_back(
          capture_case(fmt::format("block {} of {} bytes", b, size), with(good, blocks[b], size)));
    for (const std::uint32_t type : {0U, 3U, 0x80000003U, 0x80000004U, 0xffffffffU})
      group.cases.push_back(
          capture_case(fmt::format("block {} of type {:#x}", b, type), with(good, blocks[b] + 8, type)));
    // The number of a call, and counts and handles among its parameters.
    for (const std::size_t word : {0U, 12U, 16U, 20U, 28U, 36U, 44U, 60U})
      if (blocks[b] + 12 + word + 4 <= good.size())
        for (const std::uint32_t value : {0U, 0x7fffffffU, 0xffffffffU})
          group.cases.push_back(capture_case(fmt::format("block {} with {:#x} at {}", b, value, word),
                                             with(good, blocks[b] + 12 + word, value)));
  }
}

}  // namespace

Group capture_cases() {
  Group group{"captures", "cut, changed, and with blocks, counts, handles and sizes that do not hold", {}};
  const std::string plain = text_of(small_capture());
  add_changed(group, "a plain capture", plain, 211);
  add_changed(group, "a capture in LZ4", text_of(small_capture({.packing = Packing::kLz4})), 307);
  add_changed(group, "a capture in Zstandard", text_of(small_capture({.packing = Packing::kZstd})), 307);
  add_blocks(group, plain);
  add_changed(group, "a program's capture",
              text_of(traces::read_whole_file(
                  QUADRILLE_SOURCE_DIR "/tests/traces/capture/own/spinning_cube.gfxr", 1 << 24)),
              7919);
  for (const char* action : {"info", "import"}) {
    std::vector<std::string> arguments{"trace", action, "t.gfxr"};
    if (arguments[1] == "import") arguments.insert(arguments.end(), {"-o", "x.qtrace"});
    group.cases.push_back(
        {fmt::format("{} of half a capture", action), arguments, "t.gfxr",
         [=](const fs::path& f) { write_file(f / "t.gfxr", plain.substr(0, plain.size() / 2)); },
         Expect::kEither});
    group.cases.push_back({fmt::format("{} of a folder", action), arguments, "t.gfxr",
                           [](const fs::path& f) { fs::create_directory(f / "t.gfxr"); }, Expect::kRefused});
  }
  group.cases.push_back(
      {"three sparse gigabytes",
       {"trace", "info", "t.gfxr"},
       "t.gfxr",
       [](const fs::path& f) { write_file(f / "t.gfxr", ""), fs::resize_file(f / "t.gfxr", 3ULL << 30); },
       Expect::kRefused});
  return group;
}

}  // namespace quadrille::hostile
