/// The program under test.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/cli/program.h"

namespace quadrille::tests {

inline ProgramRun run_quadrille(const ScratchFolder& folder, const std::vector<std::string>& arguments,
                                const std::function<void()>& prepare = {}) {
  return run_program(QUADRILLE_PROGRAM, arguments, folder.path(), prepare);
}

/// A refusal: exit code 2, nothing on standard output, and one line that holds each of these words.
inline void require_refused(const ProgramRun& run, const std::vector<std::string>& words) {
  CAPTURE(run.err);
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK(std::ranges::count(run.err, '\n') == 1);
  CHECK(run.err.starts_with("quadrille: "));
  for (const std::string& word : words) CHECK_THAT(run.err, Catch::Contains(word));
}

/// Runs in a fresh folder and requires that the refusal left it empty.
inline void refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  const ScratchFolder folder;
  CAPTURE(arguments);
  require_refused(run_quadrille(folder, arguments), words);
  CHECK(folder.empty());
}

}  // namespace quadrille::tests
