/// The committed corpus through every target, in the normal build: seeds, and every input that once crashed,
/// hung or took too much.
#include "tests/fuzz/targets.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "models/base/error.h"
#include "traces/whole_file.h"

using namespace quadrille;

namespace {

/// Runs every file of the target's folder; a crash ends the process and so the test.
void replay(std::string_view name) {
  const std::filesystem::path folder =
      std::filesystem::path(QUADRILLE_SOURCE_DIR) / "tests/fuzz/corpus" / name;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string path = entry.path().string();
    CAPTURE(path);
    const auto start = std::chrono::steady_clock::now();
    fuzz::target(name).run(traces::read_whole_file(path, 1 << 24));
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
    ++files;
  }
  CHECK(files >= 5);
}

}  // namespace

TEST_CASE("the corpus of scenes loads or is refused in one line") { replay("scene"); }
TEST_CASE("the corpus of traces is read or refused in one line") { replay("trace"); }
TEST_CASE("the corpus of captures is imported or refused in one line") { replay("capture"); }
TEST_CASE("the corpus of machine files is applied or refused in one line") { replay("machine"); }
TEST_CASE("the corpus of SPIR-V modules compiles or is refused in one line") { replay("spirv"); }
TEST_CASE("the corpus of images is decoded or refused in one line") { replay("image"); }
