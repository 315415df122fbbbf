#include "cli/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <vector>

#include "models/base/error.h"

namespace quadrille::cli {
namespace {

constexpr const char* kProgram = "ffmpeg";

/// ffmpeg's path as the shell would find it; empty where there is none.
std::string film_program() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::string file = (folder.empty() ? "." : folder) + "/" + kProgram;
    if (access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) return file;
  }
  return "";
}

std::vector<std::string> arguments_for(const std::string& path, const std::string& part, double fps) {
  std::vector<std::string> all{kProgram,     "-hide_banner", "-loglevel",
                               "error",      "-y",           "-f",
                               "image2pipe", "-framerate",   fmt::format("{:.6g}", fps),
                               "-c:v",       "png",          "-i",
                               "-",          "-an",          "-map_metadata",
                               "-1",         "-fflags",      "+bitexact",
                               "-flags:v",   "+bitexact"};
  const std::vector<std::string> kind =
      path.ends_with(".gif")
          // one palette for the whole film
          ? std::vector<std::string>{"-vf",   "split[a][b];[a]palettegen[p];[b][p]paletteuse",
                                     "-loop", "0",
                                     "-f",    "gif"}
          // players want even sizes, and chroma for every second pixel
          : std::vector<std::string>{"-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                     "-pix_fmt",  "yuv420p",
                                     "-movflags", "+faststart",
                                     "-f",        "mp4"};
  all.insert(all.end(), kind.begin(), kind.end());
  all.push_back(part);
  return all;
}

[[noreturn]] void become(const std::string& program, std::vector<std::string>& arguments, int input,
                         int said) {
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  signal(SIGPIPE, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it would go on to the end of what it has, and leave that behind
  dup2(input, STDIN_FILENO);
  dup2(said, STDOUT_FILENO);
  dup2(said, STDERR_FILENO);
  execv(program.c_str(), words.data());
  _exit(127);
}

/// The last line of what was said.
std::string last_line(int file) {
  std::array<char, 4096> buffer{};
  const off_t size = lseek(file, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(buffer.size()));
  const ssize_t count = pread(file, buffer.data(), buffer.size(), from);
  std::string text(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count)));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  const std::size_t begin = text.rfind('\n');
  return begin == std::string::npos ? text : text.substr(begin + 1);
}

}  // namespace

void check_film_program() {
  if (film_program().empty())
    throw user_error(
        "--film: no ffmpeg is on the PATH to make it; install ffmpeg, or write the frames by --out "
        "frame_####.png");
}

Film::Film(const std::string& path, double fps)
    : path_(path), part_(fmt::format("{}.{}.part", path, getpid())), unfinished_(part_) {
  const std::string program = film_program();
  std::vector<std::string> arguments = arguments_for(path_, part_, fps);
  std::array<int, 2> ends{};
  said_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  if (said_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0)
    throw user_error("--film: {}", std::generic_category().message(errno));
  process_ = fork();
  if (process_ == 0) become(program, arguments, ends[0], said_);
  close(ends[0]);
  pictures_ = ends[1];
  if (process_ < 0) throw user_error("--film: {}", std::generic_category().message(errno));
}

Film::~Film() {
  if (pictures_ >= 0) close(pictures_);
  if (process_ > 0) {
    kill(process_, SIGKILL);
    (void)wait_for_end();
  }
  if (said_ >= 0) close(said_);
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

int Film::wait_for_end() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {}
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void Film::fail() {
  if (process_ > 0) (void)wait_for_end();
  const std::string said = last_line(said_);
  throw user_error("--film: {}: ffmpeg failed{}{}", path_, said.empty() ? "" : ": ", said);
}

void Film::add(std::span<const std::byte> png) {
  while (!png.empty()) {
    const ssize_t written = write(pictures_, png.data(), png.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail();
    png = png.subspan(static_cast<std::size_t>(written));
  }
}

void Film::finish() {
  close(pictures_);
  pictures_ = -1;
  const int status = wait_for_end();
  if (status != 0 || !std::filesystem::exists(part_)) fail();
  std::error_code failure;
  std::filesystem::rename(part_, path_, failure);
  if (failure) throw user_error("--film: {}: {}", path_, failure.message());
}

}  // namespace quadrille::cli
