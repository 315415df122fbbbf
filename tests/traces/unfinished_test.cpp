/// What is listed as unfinished is gone after every signal that ends a process and can be caught.
#include "traces/unfinished.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace quadrille::traces;
namespace fs = std::filesystem;

namespace {

struct Folder {
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "quadrille-unfinished-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no folder");
    path = pattern;
  }
  ~Folder() { fs::remove_all(path); }
  fs::path path;
};

void make(const fs::path& file) { std::ofstream(file) << "a part"; }

/// The status of a process that does this, with the handlers in place and those of the test's own taken away.
int status_of(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGTERM, SIGINT}) signal(number, SIG_DFL);
    remove_unfinished_at_signals();
    work();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

}  // namespace

TEST_CASE("unfinished: a signal that ends the process removes what is listed, and still ends it") {
  for (const int number :
       {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGPIPE, SIGXFSZ, SIGXCPU, SIGABRT, SIGALRM, SIGUSR1, SIGSEGV}) {
    CAPTURE(number);
    const Folder folder;
    const int status = status_of([&] {
      make(folder.path / "kept");
      make(folder.path / "a.png.part");
      const Unfinished listed((folder.path / "a.png.part").string());
      raise(number);
    });
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == number);
    CHECK(fs::exists(folder.path / "kept"));
    CHECK_FALSE(fs::exists(folder.path / "a.png.part"));
  }
}

TEST_CASE("unfinished: a folder goes after the files in it that were listed later") {
  const Folder folder;
  const fs::path inner = folder.path / "inner";
  (void)status_of([&] {
    fs::create_directory(inner);
    make(inner / "one");
    const Unfinished listed(inner.string()), one((inner / "one").string());
    raise(SIGTERM);
  });
  CHECK_FALSE(fs::exists(inner));
}

TEST_CASE("unfinished: what is no longer listed stays, and an ignored signal stays ignored") {
  const Folder folder;
  const fs::path file = folder.path / "a";
  CHECK(WTERMSIG(status_of([&] {
          make(file);
          { const Unfinished listed(file.string()); }
          raise(SIGTERM);
        })) == SIGTERM);
  CHECK(fs::exists(file));
  signal(SIGHUP, SIG_IGN);
  const int status = status_of([] { raise(SIGHUP); });
  signal(SIGHUP, SIG_DFL);
  CHECK(WIFEXITED(status));
}

TEST_CASE("unfinished: more paths than there is room for are not listed, and disturb none") {
  const Folder folder;
  (void)status_of([&] {
    std::vector<std::unique_ptr<Unfinished>> all;
    for (int i = 0; i < 20; ++i) {
      make(folder.path / std::to_string(i));
      all.push_back(std::make_unique<Unfinished>((folder.path / std::to_string(i)).string()));
    }
    raise(SIGTERM);
  });
  CHECK_FALSE(fs::exists(folder.path / "0"));
  CHECK(fs::exists(folder.path / "19"));
}
