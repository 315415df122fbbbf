#include "studies/child_run.h"

#include <poll.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "models/base/error.h"
#include "traces/unfinished.h"

namespace quadrille::studies {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("a child hands back everything that its work returned") {
  const std::string large(3'000'000, 'x');
  const ChildRun run = run_in_child([&] { return large + '\0' + "end"; });
  CHECK(run.end == ChildEnd::kDone);
  CHECK(run.output == large + '\0' + "end");
  CHECK(run.peak_rss_mib > 1);
}

TEST_CASE("each way in which a child can end is told apart") {
  const ChildRun refused =
      run_in_child([]() -> std::string { throw user_error("file: no such {}", "thing"); });
  CHECK(refused.end == ChildEnd::kRefused);
  CHECK(refused.output == "file: no such thing");
  CHECK(run_in_child([]() -> std::string { throw std::logic_error("ours"); }).end == ChildEnd::kFailed);
  const ChildRun killed = run_in_child([]() -> std::string {
    raise(SIGKILL);
    return "";
  });
  CHECK(killed.end == ChildEnd::kCrashed);
  CHECK_THAT(killed.output, Contains("signal 9"));
  const ChildRun left = run_in_child([]() -> std::string { _exit(7); });
  CHECK(left.end == ChildEnd::kCrashed);
  CHECK_THAT(left.output, Contains("exit code 7"));
}

TEST_CASE("what a child came to is its output, a user's mistake, or our fault, and keeps its lines") {
  CHECK(output_of(run_in_child([] { return std::string("all"); }), "frame 3") == "all");
  CHECK_THROWS_WITH(
      output_of(run_in_child([]() -> std::string { throw UserError("stuck:\n  a waits for b"); }), "frame 3"),
      "frame 3: stuck:\n  a waits for b");
  CHECK_THROWS_AS(output_of(run_in_child([]() -> std::string { throw std::logic_error("ours"); }), "frame 3"),
                  std::runtime_error);
}

TEST_CASE("children are ended when what takes their results fails") {
  const std::vector<ChildWork> works{{[] { return std::string("first"); }, {}},
                                     {[]() -> std::string {
                                        while (true) pause();
                                      },
                                      {}}};
  CHECK_THROWS_WITH(
      run_in_children(works, 2, [](std::size_t, const ChildRun&) { throw std::runtime_error("no use"); }),
      "no use");
}

TEST_CASE("a child that is ended for its parent's failure removes what it was writing") {
  std::string pattern = "/tmp/quadrille-child-XXXXXX";
  REQUIRE(mkdtemp(pattern.data()) != nullptr);
  const std::filesystem::path folder = pattern, part = folder / "a.part", other = folder / "b";
  const auto writes = [&]() -> std::string {
    std::ofstream(part) << "half";
    const traces::Unfinished listed(part.string());
    std::ofstream(other) << "listed";
    while (true) pause();
  };
  const auto fails = [&] {
    while (!std::filesystem::exists(other)) usleep(1000);
    return std::string("done");
  };
  const std::vector<ChildWork> works{{writes, {}}, {fails, {}}};
  CHECK_THROWS_WITH(
      run_in_children(works, 2, [](std::size_t, const ChildRun&) { throw std::runtime_error("no use"); }),
      "no use");
  CHECK(std::filesystem::exists(other));
  CHECK_FALSE(std::filesystem::exists(part));
  std::filesystem::remove_all(folder);
}

TEST_CASE("a child that does not end is ended at its limit") {
  const ChildRun run = run_in_child(
      []() -> std::string {
        while (true) pause();
      },
      {.seconds = 0.2});
  CHECK(run.end == ChildEnd::kTimedOut);
  CHECK(run.wall_s >= 0.2);
  CHECK(run.wall_s < 300);  // against a hang
}

TEST_CASE("a child ends with its parent, however that ends") {
  std::array<int, 2> alive{};  // its far end is open as long as the innermost process lives
  REQUIRE(pipe(alive.data()) == 0);
  const auto for_ever = []() -> std::string {
    while (true) pause();
  };
  CHECK(run_in_child([&] { return run_in_child(for_ever).output; }, {.seconds = 0.3}).end ==
        ChildEnd::kTimedOut);
  close(alive[1]);
  pollfd ended{alive[0], POLLIN, 0};
  CHECK(poll(&ended, 1, 300'000) == 1);
  close(alive[0]);
}

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define RESERVES_TERABYTES  // address space cannot be limited
#endif
#endif
#ifndef RESERVES_TERABYTES
TEST_CASE("a child that asks for more memory than it may is refused") {
  const ChildRun run =
      run_in_child([] { return std::to_string(std::vector<char>(std::size_t{1} << 30).size()); },
                   {.seconds = 600, .memory_bytes = std::uint64_t{512} << 20});
  CHECK(run.end == ChildEnd::kRefused);
  CHECK_THAT(run.output, Contains("memory"));
}
#endif

TEST_CASE("children run side by side, and each is reported once with its own end") {
  std::array<int, 2> gate{};  // the first waits for the ends of the others: no clock decides the order
  REQUIRE(pipe(gate.data()) == 0);
  const auto waits = [&] {
    char byte = 0;
    return read(gate[0], &byte, 1) == 1 ? std::string("slow") : std::string("not told");
  };
  const auto never = []() -> std::string {
    while (true) pause();
  };
  const std::vector<ChildWork> works{
      {waits, {}}, {[] { return std::string("quick"); }, {}}, {never, {.seconds = 0.2}}};
  std::vector<std::pair<std::size_t, std::string>> ends;
  run_in_children(works, 2, [&](std::size_t i, const ChildRun& run) {
    ends.emplace_back(i, run.end == ChildEnd::kDone ? run.output : child_end_name(run.end));
    if (ends.size() == 2) CHECK(write(gate[1], "x", 1) == 1);
  });
  close(gate[0]);
  close(gate[1]);
  CHECK(ends ==
        std::vector<std::pair<std::size_t, std::string>>{{1, "quick"}, {2, "timed out"}, {0, "slow"}});
}

}  // namespace
}  // namespace quadrille::studies
