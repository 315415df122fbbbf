/// Long runs of coverage against the exact oracle, for what CI has no time for: meshes of every kind with
/// shared edges and vertices, in both ways of traversal.
///   coverage_check --triangles 1000000 --seed 1 --jobs 2
/// Prints a line a kind of mesh and the first failure of each; exits with 1 if there is any. The figures
/// depend on the seed and the number of triangles alone.
#include "tests/models/raster/coverage_trial.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <thread>
#include <vector>

using namespace quadrille::models;

namespace {

using Tallies = std::array<CoverageTally, kMeshKindNames.size()>;

std::int64_t triangles_of(const Tallies& tallies) {
  std::int64_t sum = 0;
  for (const CoverageTally& tally : tallies) sum += tally.triangles;
  return sum;
}

void try_numbers(std::uint32_t seed, std::uint32_t first, std::uint32_t end, Tallies& tallies) {
  for (std::uint32_t number = first; number < end; ++number) {
    MeshKind kind{};
    CoverageTally tally = try_mesh_number(seed, number, kind);
    if (tally.failed > 0) tally.first_failure = fmt::format("mesh {}: {}", number, tally.first_failure);
    tallies[static_cast<std::size_t>(kind)].add(tally);
  }
}

/// Rounds of meshes, each shared by the jobs, until there are enough triangles.
Tallies try_triangles(std::uint32_t seed, std::int64_t triangles, int jobs) {
  constexpr std::uint32_t kRound = 256;  // meshes
  Tallies all;
  for (std::uint32_t first = 0; triangles_of(all) < triangles; first += kRound) {
    std::vector<Tallies> parts(static_cast<std::size_t>(jobs));
    std::vector<std::jthread> threads;
    for (std::uint32_t job = 0; job < parts.size(); ++job) {
      const auto bound = [&](std::uint32_t j) {
        return first + kRound * j / static_cast<std::uint32_t>(parts.size());
      };
      threads.emplace_back(try_numbers, seed, bound(job), bound(job + 1), std::ref(parts[job]));
    }
    threads.clear();  // waits for all
    for (const Tallies& part : parts)
      for (std::size_t kind = 0; kind < part.size(); ++kind) all[kind].add(part[kind]);
  }
  return all;
}

void print_line(const char* name, const CoverageTally& tally) {
  fmt::print("{:12} {:7} {:10} {:10} {:10} {:12} {:9} {:7} {:7}\n", name, tally.meshes, tally.triangles,
             tally.kept, tally.covering, tally.covered, tally.ties, tally.folded, tally.failed);
}

}  // namespace

int main(int argc, char** argv) {
  std::int64_t triangles = 1'000'000;
  std::uint32_t seed = 1, mesh = 0;
  int jobs = 1;
  CLI::App app{"Holds coverage against an oracle in exact rational arithmetic, exactly once in every mesh."};
  app.add_option("--triangles", triangles, "At least so many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", seed, "Of the random meshes")->capture_default_str();
  app.add_option("--jobs", jobs, "Threads")->check(CLI::Range(1, 256))->capture_default_str();
  const CLI::Option* one =
      app.add_option("--mesh", mesh, "Only the mesh of this number, as failures name it");
  CLI11_PARSE(app, argc, argv);
  Tallies tallies;
  if (*one) try_numbers(seed, mesh, mesh + 1, tallies);
  else tallies = try_triangles(seed, triangles, jobs);
  fmt::print("{:12} {:>7} {:>10} {:>10} {:>10} {:>12} {:>9} {:>7} {:>7}\n", "mesh", "meshes", "triangles",
             "in window", "covering", "samples", "on edges", "folded", "failed");
  CoverageTally all;
  for (std::size_t kind = 0; kind < tallies.size(); ++kind) {
    print_line(kMeshKindNames[kind], tallies[kind]);
    all.add(tallies[kind]);
  }
  print_line("all", all);
  for (const CoverageTally& tally : tallies)
    if (tally.failed > 0) fmt::print("  {}\n", tally.first_failure);
  return all.failed == 0 ? 0 : 1;
}
