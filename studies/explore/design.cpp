#include "studies/explore/design.h"

#include <dlfcn.h>

#include <cstring>
#include <filesystem>

#include "models/base/error.h"
#include "studies/child_run.h"
#include "studies/explore/design_module.h"

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

/// A function of the module.
template <class Function>
Function* of_module(const char* name) {
  std::string reasons;
  for (const fs::path& place : module_places()) {
    if (!fs::exists(place)) continue;
    if (void* library = dlopen(place.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
      if (void* function = dlsym(library, name)) return reinterpret_cast<Function*>(function);
      throw user_error("{}: lacks {}; it belongs to another build", kModuleName, name);
    }
    reasons += fmt::format(" {}", dlerror());
  }
  throw user_error("{}: not found beside the program, in ../lib or in the build folder{}", kModuleName,
                   reasons);
}

}  // namespace

std::vector<double> design_places(const std::string& kind, std::size_t dimensions, std::size_t points,
                                  std::uint64_t seed) {
  const std::string bytes = output_of(
      run_in_child([&] {
        std::vector<double> places(dimensions * points);
        QuadrilleMessage message{};
        if (!of_module<QuadrilleDesign>("quadrille_design")(kind.c_str(), dimensions, points, seed,
                                                            places.data(), &message))
          throw user_error("{}", static_cast<const char*>(message.text));
        return std::string(reinterpret_cast<const char*>(places.data()), places.size() * sizeof(double));
      }),
      fmt::format("design {}", kind));
  std::vector<double> places(bytes.size() / sizeof(double));
  std::memcpy(places.data(), bytes.data(), places.size() * sizeof(double));
  return places;
}

Plan planned(const Sweep& sweep, const Space& space) {
  if (sweep.design == DesignKind::kGrid) return space.grid();
  const std::string kind(kDesignNames[static_cast<std::size_t>(sweep.design)]);
  return space.at(design_places(kind, sweep.dimensions.size(), sweep.points, sweep.seed));
}

}  // namespace quadrille::studies::explore
