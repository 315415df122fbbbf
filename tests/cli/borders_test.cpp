/// The program's borders: standard streams that are closed, full or read by nobody, files that may not grow,
/// signals while files are written.
#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <thread>

#include <nlohmann/json.hpp>

#include "tests/cli/quadrille.h"

using namespace quadrille::tests;
using nlohmann::json;

namespace {

void into(int stream, const char* path) {
  const int file = open(path, O_WRONLY);
  if (file < 0 || dup2(file, stream) < 0) _exit(126);
}

std::function<void()> closed(std::vector<int> streams) {
  return [=] {
    for (const int stream : streams) close(stream);
  };
}
std::function<void()> full(int stream) {
  return [=] { into(stream, "/dev/full"); };
}
/// A pipe whose reader is gone.
std::function<void()> broken(int stream) {
  return [=] {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0 || dup2(ends[1], stream) < 0) _exit(126);
    close(ends[0]);
    close(ends[1]);
  };
}
std::function<void()> files_of_at_most(rlim_t bytes) {
  return [=] {
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
}

/// A scene with something to say on standard error, which draws nevertheless.
void write_talkative(const ScratchFolder& folder) {
  folder.write(
      "t.gltf",
      R"({"asset":{"version":"2.0"},"extensionsUsed":["X_y"],"scenes":[{"nodes":[0]}],"nodes":[{}]})");
}

}  // namespace

TEST_CASE("a message that cannot be written ends nothing: the exit code is that of the mistake") {
  for (const auto& lost : {closed({2}), full(2), broken(2)}) {
    const ScratchFolder folder;
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"render", "missing.gltf"},
                                                  {"rende"},
                                                  {"render", "builtin:triangle", "--size", "0x0"},
                                                  {"diff", "a.png", "b.png"}}) {
      const ProgramRun run = run_quadrille(folder, wrong, lost);
      CAPTURE(wrong);
      CHECK(run.exit_code == 2);
      CHECK(run.out.empty());
    }
    write_talkative(folder);
    CHECK(
        run_quadrille(folder, {"render", "t.gltf", "--size", "16x16", "--fidelity", "functional", "-q"}, lost)
            .exit_code == 0);
  }
}

TEST_CASE("a table that cannot be written is the user's error, and the files are there") {
  for (const auto& lost : {closed({1}), full(1)}) {
    const ScratchFolder folder;
    const ProgramRun run =
        run_quadrille(folder, {"render", "builtin:triangle", "--size", "16x16", "--out", "x.png"}, lost);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Catch::StartsWith("quadrille: standard output cannot be written"));
    CHECK(folder.has("x.png"));
    for (const std::vector<std::string>& prints : {std::vector<std::string>{"--help"},
                                                   {"render", "--help"},
                                                   {"--version"},
                                                   {"describe"},
                                                   {"describe", "--json"},
                                                   {"scenes"},
                                                   {"machines"}}) {
      CAPTURE(prints);
      CHECK(run_quadrille(folder, prints, lost).exit_code == 2);
    }
    // which prints nothing
    CHECK(run_quadrille(folder, {"render", "builtin:triangle", "--size", "16x16", "-q"}, lost).exit_code ==
          0);
  }
}

TEST_CASE("who reads no further ends the program as it ends others: by SIGPIPE, without a word") {
  const ScratchFolder folder;
  for (const std::vector<std::string>& prints :
       {std::vector<std::string>{"describe"},
        {"render", "builtin:flag", "--size", "16x16", "--frames", "3", "--jobs", "2", "--fidelity",
         "functional", "--out", "f#.png"}}) {
    const ProgramRun run = run_quadrille(folder, prints, broken(1));
    CHECK(run.signal == SIGPIPE);
    CHECK(run.err.empty());
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    CHECK(entry.path().extension() == ".png");
}

TEST_CASE("a file that is opened never takes the place of a closed stream") {
  const ScratchFolder folder;
  write_talkative(folder);
  const auto draw = [&](const std::string& name, const std::function<void()>& prepare) {
    return run_quadrille(folder,
                         {"render", "t.gltf", "--size", "16x16", "-q", "--out", name + ".png", "--stats",
                          name + ".json"},
                         prepare)
        .exit_code;
  };
  CHECK(draw("open", {}) == 0);
  CHECK(draw("shut", closed({0, 1, 2})) == 0);
  CHECK(folder.read("open.png") == folder.read("shut.png"));
  CHECK(json::parse(folder.read("shut.json")).at("units") ==
        json::parse(folder.read("open.json")).at("units"));
}

TEST_CASE("a file that may not grow is refused with its name, and nothing of it is left") {
  const std::vector<std::string> draw{"render",     "builtin:courtyard", "--size", "160x120",
                                      "--fidelity", "functional",        "-q"};
  for (const std::vector<std::string>& output : {std::vector<std::string>{"--out", "x.png"},
                                                 {"--out", "x.exr"},
                                                 {"--depth", "d.png"},
                                                 {"--depth", "d.exr"},
                                                 {"--stats", "s.json"},
                                                 {"--frames", "2", "--jobs", "2", "--out", "f#.png"},
                                                 {"--frames", "2", "--stats", "s.json"}}) {
    const ScratchFolder folder;
    std::vector<std::string> arguments = draw;
    arguments.insert(arguments.end(), output.begin(), output.end());
    CAPTURE(arguments);
    require_refused(run_quadrille(folder, arguments, files_of_at_most(1000)), {"File too large"});
    CHECK(folder.empty());
  }
  const ScratchFolder folder;
  require_refused(run_quadrille(folder, {"trace", "record", "builtin:courtyard", "-o", "c.qtrace"},
                                files_of_at_most(1000)),
                  {"c.qtrace"});
  CHECK(folder.empty());
}

TEST_CASE("a signal while a picture is written leaves no part of it, from a frame's own process neither") {
  for (const int number : {SIGTERM, SIGINT}) {
    for (const bool frames : {false, true}) {
      const ScratchFolder folder;
      const int notices = inotify_init1(IN_CLOEXEC);
      REQUIRE(inotify_add_watch(notices, folder.path().c_str(), IN_CREATE) >= 0);
      const pid_t child = fork();
      if (child == 0) {
        if (chdir(folder.path().c_str()) != 0) _exit(126);
        into(1, "/dev/null");
        into(2, "/dev/null");
        if (frames)
          execl(QUADRILLE_PROGRAM, "quadrille", "render", "builtin:flag", "--size", "1024x1024", "--fidelity",
                "functional", "--frames", "2", "--jobs", "2", "--out", "f#.exr", nullptr);
        else
          execl(QUADRILLE_PROGRAM, "quadrille", "render", "builtin:flag", "--size", "1024x1024", "--fidelity",
                "functional", "--out", "f.exr", nullptr);
        _exit(127);
      }
      pollfd noticed{notices, POLLIN, 0};
      CHECK(poll(&noticed, 1, 600'000) == 1);  // the part is there
      kill(child, number);
      int status = 0;
      waitpid(child, &status, 0);
      close(notices);
      const auto parts = [&] {
        return std::ranges::any_of(std::filesystem::directory_iterator(folder.path()),
                                   [](const auto& entry) { return entry.path().extension() == ".part"; });
      };
      // Processes of frames learn of their parent's end a moment after it.
      for (int i = 0; i < 600 && parts(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
      CAPTURE(number, frames);
      CHECK_FALSE(parts());
    }
  }
}
