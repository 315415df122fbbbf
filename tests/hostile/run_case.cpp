/// One run of the program under limits, and the judgement of what it left.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "models/base/error.h"
#include "scenes/image/image_io.h"
#include "tests/cli/program.h"
#include "tests/host_speed.h"
#include "tests/hostile/hostile_case.h"
#include "traces/trace_file.h"

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define QUADRILLE_SANITIZED
#endif
#endif

namespace quadrille::hostile {
namespace {

/// seconds of wall time until a run is killed, against a hang: the host may be slow and busy with others
constexpr double kPatience = 900;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

[[noreturn]] void become_program(const Case& c, const fs::path& folder, const fs::path& streams) {
  std::vector<char*> argv{const_cast<char*>(QUADRILLE_PROGRAM)};
  for (const std::string& argument : c.arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
#ifndef QUADRILLE_SANITIZED  // a sanitizer reserves terabytes of addresses
  const auto bytes = static_cast<rlim_t>(kMaxMib) << 20;
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#endif
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const int in = open("/dev/null", O_RDONLY), out = open((streams / "out").c_str(), O_WRONLY | O_CREAT, 0600),
            err = open((streams / "err").c_str(), O_WRONLY | O_CREAT, 0600);
  if (chdir(folder.c_str()) != 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(126);
  execv(argv[0], argv.data());
  _exit(127);
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Waits for the child, or kills it; returns its status and fills what it used.
int wait_for(pid_t child, Outcome& outcome) {
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, WNOHANG, &usage) == 0) {
    if (std::chrono::steady_clock::now() - start > std::chrono::duration<double>(kPatience))
      kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  outcome.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  outcome.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024;
  return status;
}

void judge_refusal(const Case& c, const std::string& out, Outcome& outcome) {
  const auto problem = [&](std::string text) { outcome.problems.push_back(std::move(text)); };
  if (!out.empty()) problem("a refusal that prints to standard output");
  if (std::ranges::count(outcome.error, '\n') != 1 || !outcome.error.starts_with("quadrille: "))
    problem("a refusal that is not one line");
  if (outcome.error.find(c.culprit) == std::string::npos) problem("a refusal without '" + c.culprit + "'");
  if (c.expect == Expect::kRendered) problem("refused, but legal");
}

template <class Read>
bool reads(const Read& read, const fs::path& path) {
  try {
    (void)read(path.string());
    return true;
  } catch (const UserError&) { return false; }
}

/// Every file but those that were there before: an output, whole, and only after success.
void judge_folder(const fs::path& folder, const std::vector<fs::path>& before, Outcome& outcome) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (std::ranges::find(before, path) != before.end()) continue;
    const std::string name = path.filename().string(), text = contents(path);
    const bool whole =
        (name.ends_with(".png") && text.size() > 12 && text.substr(text.size() - 8, 4) == "IEND") ||
        (name.ends_with(".json") && text.ends_with("}\n")) ||
        (name.ends_with(".exr") &&
         reads([](const std::string& file) { return scenes::load_float_image(file); }, path)) ||
        (name.ends_with(".qtrace") && reads(traces::read_trace, path));
    if (outcome.exit_code != 0 || !whole)
      outcome.problems.push_back(fmt::format("{} is left behind, {} bytes", name, text.size()));
  }
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

}  // namespace

Outcome run_case(const Case& c) {
  const tests::ScratchFolder folder, streams;
  if (c.prepare) c.prepare(folder.path());
  const std::vector<fs::path> before = files_in(folder.path());
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started");
  if (child == 0) become_program(c, folder.path(), streams.path());
  Outcome outcome;
  const int status = wait_for(child, outcome);
  outcome.error = contents(streams.path() / "err");
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.problems.push_back(fmt::format("ended by signal {}", WTERMSIG(status)));
  else if (outcome.exit_code != 0 && outcome.exit_code != 2)
    outcome.problems.push_back(fmt::format("exit code {}", outcome.exit_code));
  if (outcome.exit_code == 2) judge_refusal(c, contents(streams.path() / "out"), outcome);
  if (outcome.exit_code == 0 && c.expect == Expect::kRefused)
    outcome.problems.emplace_back("accepted, but not legal");
#ifndef QUADRILLE_SANITIZED
  if (outcome.seconds > kMaxSeconds) {  // only then is it worth asking how slow the host is
    const double slowness = tests::host_slowness();
    if (outcome.seconds > kMaxSeconds * slowness)
      outcome.problems.push_back(
          fmt::format("{:.1f} s of processor time on a host {:.1f} times slower than that of the bound",
                      outcome.seconds, slowness));
  }
  if (outcome.peak_mib > kMaxMib) outcome.problems.push_back(fmt::format("{:.0f} MiB", outcome.peak_mib));
#endif
  judge_folder(folder.path(), before, outcome);
  return outcome;
}

void write_file(const fs::path& path, std::string_view text) {
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

std::vector<std::string> render_arguments(const std::string& scene, const std::string& fidelity) {
  return {"render", scene,   "--size",  "64x64",  "--fidelity", fidelity,
          "--out",  "x.png", "--stats", "x.json", "-q"};
}

Case scene_case(const std::string& what, const std::string& text, const std::string& name, Expect expect) {
  return {what, render_arguments(name), name,
          [=](const fs::path& folder) { write_file(folder / name, text); }, expect};
}

std::vector<Group (*)()> all_groups() {
  return {scene_cases,   binary_scene_cases, large_scene_cases, image_cases,  trace_cases,  capture_cases,
          machine_cases, energy_cases,       flag_cases,        shader_cases, output_cases, outside_cases};
}

}  // namespace quadrille::hostile
