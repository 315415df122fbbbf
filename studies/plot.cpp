#include "studies/plot.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "models/base/error.h"
#include "traces/unfinished.h"
#include "traces/whole_file.h"

namespace quadrille::studies {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxPlotBytes = std::uint64_t{64} << 20;

/// A new folder, removed with all it holds.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code error;
    std::string pattern = (fs::temp_directory_path(error) / "quadrille-plot-XXXXXX").string();
    if (error || mkdtemp(pattern.data()) == nullptr)
      throw user_error("{}: cannot make a folder for the plot there; TMPDIR says where",
                       error ? "the folder of TMPDIR" : pattern);
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string terminal_for(const std::string& path) {
  const bool svg = fs::path(path).extension() == ".svg";
  return svg ? "set terminal svg size 960,600 font 'sans-serif,13' background '#ffffff'\n"
             : "set terminal pngcairo size 960,600 font 'sans-serif,11'\n";
}

/// Feeds gnuplot; its complaints go to a file beside the output. True when it succeeded.
bool run_gnuplot(const fs::path& folder, const std::string& commands) {
  const std::string line = fmt::format("gnuplot >'{}' 2>&1", (folder / "said").string());
  const auto previous = std::signal(SIGPIPE, SIG_IGN);  // it may give up before it has read all
  FILE* const pipe = popen(line.c_str(), "w");
  bool good = pipe != nullptr;
  if (good) {
    good = std::fwrite(commands.data(), 1, commands.size(), pipe) == commands.size();
    good = pclose(pipe) == 0 && good;
  }
  std::signal(SIGPIPE, previous);
  return good;
}

}  // namespace

void require_gnuplot(const std::string& flag) {
  std::string folders = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  for (std::size_t from = 0; from <= folders.size();) {
    const std::size_t to = std::min(folders.find(':', from), folders.size());
    if (access((fs::path(folders.substr(from, to - from)) / "gnuplot").c_str(), X_OK) == 0) {
      (void)ScratchFolder();
      return;
    }
    from = to + 1;
  }
  throw user_error("{}: gnuplot draws the plots and is not installed (Debian's package is gnuplot-nox)",
                   flag);
}

void draw_plot(const std::string& path, const std::string& commands) {
  const ScratchFolder folder;
  const fs::path drawn = folder.path() / "plot";
  const traces::Unfinished listed_folder(folder.path().string()), listed_plot(drawn.string()),
      listed_words((folder.path() / "said").string());
  const std::string all = terminal_for(path) +
                          fmt::format("set output '{}'\nset encoding utf8\n", drawn.string()) + commands +
                          "\nunset output\n";
  if (!run_gnuplot(folder.path(), all) || !fs::exists(drawn) || fs::file_size(drawn) == 0) {
    std::string said;
    for (const std::byte b : traces::read_whole_file((folder.path() / "said").string(), kMaxPlotBytes))
      said += static_cast<char>(b) == '\n' ? ' ' : static_cast<char>(b);
    throw user_error("{}: gnuplot failed: {}", path, said);
  }
  traces::write_whole_file(path, traces::read_whole_file(drawn.string(), kMaxPlotBytes));
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '`') out += "\\\\\\";
    else if (c == '_' || c == '^' || c == '@' || c == '&' || c == '~' || c == '{' || c == '}') out += "\\\\";
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

}  // namespace quadrille::studies
