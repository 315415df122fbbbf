#include "studies/explore/designs_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "models/base/error.h"
#include "studies/child_run.h"

namespace quadrille::studies::explore {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModuleName = "libquadrille_designs.so";

/// Beside the program, in ../lib, or where it was built.
std::vector<fs::path> module_places() {
  std::vector<fs::path> places;
  std::error_code error;
  const fs::path exe = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    places.push_back(exe.parent_path() / kModuleName);
    places.push_back(exe.parent_path().parent_path() / "lib" / kModuleName);
  }
  places.emplace_back(QUADRILLE_DESIGNS_MODULE);
  return places;
}

}  // namespace

void* address_in_designs_library(const char* name) {
  std::string reasons;
  for (const fs::path& place : module_places()) {
    if (!fs::exists(place)) continue;
    if (void* library = dlopen(place.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
      if (void* function = dlsym(library, name)) return function;
      throw user_error("{}: lacks {}; it belongs to another build", kModuleName, name);
    }
    reasons += fmt::format(" {}", dlerror());
  }
  throw user_error("{}: not found beside the program, in ../lib or in the build folder{}", kModuleName,
                   reasons);
}

std::vector<double> in_designs_library(const std::string& about,
                                       const std::function<std::vector<double>(QuadrilleMessage*)>& ask) {
  const auto work = [&ask] {
    QuadrilleMessage message{};
    const std::vector<double> values = ask(&message);
    if (message.text[0] != '\0') throw user_error("{}", static_cast<const char*>(message.text));
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  };
  const std::string bytes = output_of(run_in_child(work), about);
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace quadrille::studies::explore
