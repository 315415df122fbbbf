#include "traces/trace_file.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "models/base/error.h"
#include "tests/traces/sample_stream.h"

using namespace quadrille;
using namespace quadrille::traces;

namespace {

struct TempFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("quadrille_traces_" + std::to_string(getpid()));
  TempFolder() { std::filesystem::create_directories(path); }
  ~TempFolder() { std::filesystem::remove_all(path); }
};

std::string refusal(std::span<const std::byte> bytes) {
  try {
    (void)decode_trace(bytes, "t.qtrace");
  } catch (const UserError& error) { return error.what(); }
  return {};
}

}  // namespace

TEST_CASE("trace file: random streams come back equal") {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const CommandStream stream = random_stream(seed);
    REQUIRE(decode_trace(encode_trace(stream), "t") == stream);
  }
}

TEST_CASE("trace file: every change of one byte is refused with the file's name") {
  const std::vector<std::byte> good = encode_trace(small_stream());
  REQUIRE(refusal(good).empty());
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::vector<std::byte> bad = good;
      bad[at] ^= static_cast<std::byte>(flip);
      CAPTURE(at, flip);
      REQUIRE(refusal(bad).starts_with("t.qtrace: "));
    }
  }
}

TEST_CASE("trace file: every truncation and every appended byte is refused") {
  std::vector<std::byte> bytes = encode_trace(small_stream());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    REQUIRE_FALSE(refusal(std::span(bytes).first(size)).empty());
  bytes.push_back(std::byte{0});
  REQUIRE(refusal(bytes) == "t.qtrace: 1 bytes follow the last chunk");
}

TEST_CASE(
    "trace file: a chunk that announces more than the file holds, or than a trace may take, is refused "
    "before allocation") {
  std::vector<std::byte> bytes = encode_trace(small_stream());
  const std::uint64_t huge = std::uint64_t{1} << 60;
  std::memcpy(bytes.data() + 16 + 8, &huge, 8);  // stored size of the first chunk
  REQUIRE(refusal(bytes).find("chunk NAME") != std::string::npos);
  bytes = encode_trace(small_stream());
  std::memcpy(bytes.data() + 16 + 16, &huge, 8);  // decoded size
  REQUIRE(refusal(bytes).find("a trace may take") != std::string::npos);
}

TEST_CASE("trace file: another version is named") {
  std::vector<std::byte> bytes = encode_trace(small_stream());
  bytes[8] = std::byte{9};
  REQUIRE(refusal(bytes) == "t.qtrace: trace version 9; this program reads versions 1 to 2");
}

TEST_CASE("trace file: write and read through the file system, nothing else stays in the folder") {
  const TempFolder folder;
  const std::string path = (folder.path / "a.qtrace").string();
  const CommandStream stream = random_stream(7);
  write_trace(small_stream(), path);
  write_trace(stream, path);
  REQUIRE(read_trace(path) == stream);
  REQUIRE(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("trace file: a missing file, a folder and an unwritable place are the user's errors") {
  const TempFolder folder;
  REQUIRE_THROWS_AS(read_trace((folder.path / "none.qtrace").string()), UserError);
  REQUIRE_THROWS_AS(read_trace(folder.path.string()), UserError);
  REQUIRE_THROWS_AS(write_trace(small_stream(), (folder.path / "no" / "t.qtrace").string()), UserError);
}

TEST_CASE("trace file: what decodes but is not valid is refused with the file's name") {
  CommandStream stream = small_stream();
  stream.pipelines[0].vertex_shader = 5;
  REQUIRE(refusal(encode_trace(stream)).starts_with("t.qtrace: pipeline 0"));
}
