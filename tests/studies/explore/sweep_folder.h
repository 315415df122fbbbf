/// Sweep files of tests, in a folder that goes with them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "studies/explore/space.h"
#include "studies/explore/sweep.h"

namespace quadrille::studies::explore {

class SweepFolder {
 public:
  SweepFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "quadrille-sweep-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    path_ = pattern;
  }
  ~SweepFolder() { std::filesystem::remove_all(path_); }
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return file(name);
  }
  [[nodiscard]] Sweep sweep(const std::string& text) const { return read_sweep(write("sweep.toml", text)); }

 private:
  std::filesystem::path path_;
};

/// A scene that every sweep of a test can begin with.
inline constexpr const char* kTriangleScene = "[[scene]]\nfile = \"builtin:triangle\"\nsize = \"16x16\"\n";

}  // namespace quadrille::studies::explore
