/// Starts the program as its users do, and gives its tests a folder of their own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace quadrille::tests {

struct ProgramRun {
  int exit_code = -1;  ///< -1: it was ended by a signal
  int signal = 0;      ///< that one
  std::string out, err;
};

/// Runs `program` with these arguments, in `folder`, its outputs in files. `prepare` is called in its process
/// before it starts, to close streams or set limits.
[[nodiscard]] ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder,
                                     const std::function<void()>& prepare = {});

/// A new empty folder, removed with all it holds.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }
  [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(path_ / name); }
  void write(const std::string& name, const std::string& text) const;
  [[nodiscard]] std::string read(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

}  // namespace quadrille::tests
